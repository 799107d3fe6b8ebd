// Layers on memory that ranks of one machine share: fragments of each rank lie there, a list a
// block, whoever is free blends a block, and the root reads what is seen, or has its picture there
// for all to draw into.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/ranks/fragments.hpp>

namespace rastrum::ranks {

struct SeenBlock;
class RootPicture;

/// Numbers of 64 bits: the table, of which is room from the beginning of a frame on, then what is
/// seen of each block, and runs of fragments (FragmentRun). The table: what each rank has found no
/// room for, how much the runs there take, the next block that nobody blends, the root's picture
/// and how many draw into it, and of each block where its list begins.
class SharedLayers {
 public:
  /// `memory`: of the table and, perhaps, of the rest.
  SharedLayers(std::span<std::uint64_t> memory, std::size_t blocks, int ranks)
      : memory_(memory), blocks_(blocks), ranks_(static_cast<std::size_t>(ranks)) {}
  [[nodiscard]] static std::size_t table_size(std::size_t blocks, int ranks) {
    return static_cast<std::size_t>(ranks) + kNumbers + blocks;
  }

  /// By one rank, between two agreements while none draws: all room is free.
  void clear_room() const { taken() = 0; }
  /// Behind the second: memory for runs, for all threads of all ranks at the same time.
  [[nodiscard]] std::byte* room(std::size_t bytes) const;
  /// Each rank makes its share of the table empty, draws, and tells what has found no room: before
  /// an agreement.
  void clear(std::size_t rank) const;
  void tell(std::size_t rank, const FragmentBytes& held) const;
  /// Behind it: the size of all, the same on all ranks.
  [[nodiscard]] std::uint64_t size() const;
  /// Lays what has found no room to the rest, and puts all of it into the lists; all ranks at the
  /// same time.
  void lay(std::size_t rank, const FragmentBytes& held) const;
  /// Behind another agreement: blocks [first, last) that nobody else blends, until first == last.
  struct Run {
    std::size_t first, last;
  };
  [[nodiscard]] Run take() const;
  [[nodiscard]] bool has(std::size_t block) const { return head(block) != 0; }
  /// Calls f(Reader) for all planes of a block, those of a rank in their order.
  template <class F>
  void each_run(std::size_t block, const F& f) const {
    for (std::uint64_t at = head(block); at != 0; at = memory_[at])
      f(Reader({reinterpret_cast<const std::byte*>(&memory_[at + 2]), memory_[at + 1]}));
  }
  /// What is seen of a block: who blends it puts it there.
  void put(const SeenBlock& block) const;
  [[nodiscard]] SeenBlock take_seen(std::size_t block) const;

  /// The root's picture, for ranks that are threads of its process: open from before an agreement
  /// until the root goes, which waits for those that are in it.
  class OpenPicture {
   public:
    OpenPicture(SharedLayers layers, RootPicture& picture);
    ~OpenPicture();
    OpenPicture(const OpenPicture&) = delete;
    OpenPicture& operator=(const OpenPicture&) = delete;

   private:
    std::uint64_t* visitors_;
  };
  /// Who draws into it, behind the agreement. There is none where the root has gone.
  class Visit {
   public:
    explicit Visit(SharedLayers layers);
    ~Visit();
    Visit(const Visit&) = delete;
    Visit& operator=(const Visit&) = delete;
    [[nodiscard]] RootPicture* picture() const { return picture_; }

   private:
    std::uint64_t* visitors_;
    RootPicture* picture_;
  };

 private:
  static constexpr std::size_t kNumbers = 4;  ///< of the table beside those of ranks and blocks
  [[nodiscard]] std::uint64_t& next() const { return memory_[ranks_]; }
  [[nodiscard]] std::uint64_t& taken() const { return memory_[ranks_ + 1]; }
  [[nodiscard]] std::uint64_t& picture() const { return memory_[ranks_ + 2]; }
  [[nodiscard]] std::uint64_t& visitors() const { return memory_[ranks_ + 3]; }
  [[nodiscard]] std::uint64_t& head(std::size_t block) const {
    return memory_[ranks_ + kNumbers + block];
  }
  [[nodiscard]] std::size_t first_run() const;
  [[nodiscard]] std::uint64_t* seen(std::size_t block) const;
  /// Whether it lies there.
  [[nodiscard]] bool has(const FragmentRun& run) const {
    return run.place() - reinterpret_cast<std::uintptr_t>(memory_.data()) < memory_.size_bytes();
  }

  std::span<std::uint64_t> memory_{};
  std::size_t blocks_ = 0, ranks_ = 0;
};

}  // namespace rastrum::ranks
