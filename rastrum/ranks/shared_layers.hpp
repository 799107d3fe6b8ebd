// SPDX-License-Identifier: BSD-3-Clause
// Layers in memory that ranks of one machine share: all ranks' fragments, in a list per block. Any
// free rank blends a block. The root reads the results, or opens its picture for all to draw into.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/ranks/fragments.hpp>

namespace rastrum::ranks {

struct SeenBlock;
class RootPicture;

/// 64-bit numbers: the table, each block's blended layers, then runs of fragments (FragmentRun).
/// The table, which has room from a frame's beginning, holds how much each rank found no room for,
/// the next block to blend, the size of the runs, the root's picture and its number of visitors,
/// and where each block's list begins.
class SharedLayers {
 public:
  /// `memory` holds the table and, if large enough, the rest.
  SharedLayers(std::span<std::uint64_t> memory, std::size_t blocks, int ranks)
      : memory_(memory), blocks_(blocks), ranks_(static_cast<std::size_t>(ranks)) {}
  [[nodiscard]] static std::size_t table_size(std::size_t blocks, int ranks) {
    return static_cast<std::size_t>(ranks) + kNumbers + blocks;
  }

  /// Frees all room. One rank calls it between two agreements, while none draws.
  void clear_room() const { taken() = 0; }
  /// After the second agreement: memory for runs, or null. Thread-safe over all ranks.
  [[nodiscard]] std::byte* room(std::size_t bytes) const;
  /// Before an agreement: each rank clears its share of the table, draws, and tells how much found
  /// no room.
  void clear(std::size_t rank) const;
  void tell(std::size_t rank, const FragmentBytes& held) const;
  /// After that agreement: the size that everything needs, the same on all ranks.
  [[nodiscard]] std::uint64_t size() const;
  /// Adds the rank's fragments that found no room, and links all of its fragments into the lists.
  /// All ranks may do so at once.
  void lay(std::size_t rank, const FragmentBytes& held) const;
  /// After another agreement: blocks [first, last) for this rank alone; first == last at the end.
  struct Run {
    std::size_t first, last;
  };
  [[nodiscard]] Run take() const;
  [[nodiscard]] bool has(std::size_t block) const { return head(block) != 0; }
  /// Calls f(Reader) for all planes of a block. Planes of one rank keep their order.
  template <class F>
  void each_run(std::size_t block, const F& f) const {
    for (std::uint64_t at = head(block); at != 0; at = memory_[at])
      f(Reader({reinterpret_cast<const std::byte*>(&memory_[at + 2]),
                static_cast<std::size_t>(memory_[at + 1])}));
  }
  /// Stores a block's blended layers; called by the rank that has taken it.
  void put(const SeenBlock& block) const;
  [[nodiscard]] SeenBlock take_seen(std::size_t block) const;

  /// Opens the root's picture to ranks that are threads of its process. Make it before an
  /// agreement. The destructor waits for ranks that are still drawing.
  class OpenPicture {
   public:
    OpenPicture(SharedLayers layers, RootPicture& picture);
    ~OpenPicture();
    OpenPicture(const OpenPicture&) = delete;
    OpenPicture& operator=(const OpenPicture&) = delete;

   private:
    std::uint64_t* visitors_;
  };
  /// A rank's permission to draw into it; make it after that agreement. picture() is null if the
  /// root has gone.
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
  static constexpr std::size_t kNumbers = 4;  ///< of the table, beside one per rank and per block
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
