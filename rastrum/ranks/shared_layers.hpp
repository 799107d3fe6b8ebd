// SPDX-License-Identifier: BSD-3-Clause
// Layers in memory that ranks of one machine share. All ranks' fragments lie there, in one list for
// each block. Any rank that is free blends a block. The root then reads the results, or opens its
// picture there for all to draw into.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/ranks/fragments.hpp>

namespace rastrum::ranks {

struct SeenBlock;
class RootPicture;

/// The memory holds numbers of 64 bits: the table, which has room from the beginning of a frame on,
/// then the blended layers of each block, then runs of fragments (FragmentRun). The table holds how
/// much each rank has found no room for, the next block that nobody blends, how much the runs take,
/// the root's picture and how many draw into it, and where each block's list begins.
class SharedLayers {
 public:
  /// `memory`: holds the table and, if large enough, the rest.
  SharedLayers(std::span<std::uint64_t> memory, std::size_t blocks, int ranks)
      : memory_(memory), blocks_(blocks), ranks_(static_cast<std::size_t>(ranks)) {}
  [[nodiscard]] static std::size_t table_size(std::size_t blocks, int ranks) {
    return static_cast<std::size_t>(ranks) + kNumbers + blocks;
  }

  /// Frees all room. One rank does this, between two agreements, while none draws.
  void clear_room() const { taken() = 0; }
  /// After the second agreement: memory for runs, or null. All threads of all ranks may call it at
  /// the same time.
  [[nodiscard]] std::byte* room(std::size_t bytes) const;
  /// Each rank clears its share of the table, draws, and tells how much has found no room, all
  /// before an agreement.
  void clear(std::size_t rank) const;
  void tell(std::size_t rank, const FragmentBytes& held) const;
  /// After it: the size needed for all, the same on all ranks.
  [[nodiscard]] std::uint64_t size() const;
  /// Adds the fragments that had found no room, and puts all of the rank's into the lists; all
  /// ranks may do so at the same time.
  void lay(std::size_t rank, const FragmentBytes& held) const;
  /// After another agreement: blocks [first, last) that nobody else blends, until first == last.
  struct Run {
    std::size_t first, last;
  };
  [[nodiscard]] Run take() const;
  [[nodiscard]] bool has(std::size_t block) const { return head(block) != 0; }
  /// Calls f(Reader) for all planes of a block. Planes of one rank come in their order.
  template <class F>
  void each_run(std::size_t block, const F& f) const {
    for (std::uint64_t at = head(block); at != 0; at = memory_[at])
      f(Reader({reinterpret_cast<const std::byte*>(&memory_[at + 2]), memory_[at + 1]}));
  }
  /// Stores the blended layers of a block; called by the rank that has taken it.
  void put(const SeenBlock& block) const;
  [[nodiscard]] SeenBlock take_seen(std::size_t block) const;

  /// Opens the root's picture to ranks that are threads of its process. Made before an agreement.
  /// The destructor waits for ranks that are still drawing into the picture.
  class OpenPicture {
   public:
    OpenPicture(SharedLayers layers, RootPicture& picture);
    ~OpenPicture();
    OpenPicture(const OpenPicture&) = delete;
    OpenPicture& operator=(const OpenPicture&) = delete;

   private:
    std::uint64_t* visitors_;
  };
  /// A rank's permission to draw into it, made after the agreement. picture() is null if the root
  /// has gone.
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
  /// Whether the run lies in this memory.
  [[nodiscard]] bool has(const FragmentRun& run) const {
    return run.place() - reinterpret_cast<std::uintptr_t>(memory_.data()) < memory_.size_bytes();
  }

  std::span<std::uint64_t> memory_{};
  std::size_t blocks_ = 0, ranks_ = 0;
};

}  // namespace rastrum::ranks
