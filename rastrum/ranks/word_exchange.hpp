// SPDX-License-Identifier: BSD-3-Clause
// The opaque phase. The owner of each pixel takes the maximum of the ranks' words of depth and
// part, and tells each rank which pixels it has won.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <rastrum/ranks/agree.hpp>
#include <rastrum/ranks/blocks.hpp>
#include <rastrum/ranks/hops.hpp>
#include <rastrum/ranks/part_list.hpp>
#include <rastrum/ranks/sparse_blocks.hpp>

namespace rastrum::ranks {

/// A word is depth above the inverted place of a part in the list of all parts, like a visibility
/// key with its id. The maximum is the nearest surface; at equal depths, that of the part which one
/// renderer draws first. A rank has one word per pixel, from its greatest key, because its ids rise
/// with its parts.
class Words {
 public:
  Words(const BlockGrid& grid, SparseBlocks words) : grid_(grid), words_(std::move(words)) {}
  /// `places`: of the rank's parts in the list of all.
  Words(const BlockGrid& grid, const SparseBlocks& keys, const OwnParts& own,
        std::span<const std::size_t> places);

  struct Won {
    std::vector<BlockMask> blocks;
    WordExchange taken{};
    std::uint64_t words = 0;         ///< of this rank
    std::vector<std::uint64_t> own;  ///< the greatest words of all ranks in this rank's blocks
    /// The same for all blocks if ranks share a surface; then `own` is empty.
    std::span<const std::uint64_t> all{};
  };
  /// Finds the greatest words of all ranks, at their owners. Won::blocks stays empty.
  [[nodiscard]] Won meet_owners(Communicator& ranks, const AtPhase& at, WordExchange wanted) const;
  /// The same; then each rank learns what it has won.
  [[nodiscard]] Won meet(Communicator& ranks, const AtPhase& at, const PartList& list,
                         WordExchange wanted) const;

  // Steps on a surface that ranks share, with 64 numbers per block; ranks agree in between:
  /// 1. Each rank clears its blocks.
  static void clear_own(const BlockGrid& grid, std::size_t rank, std::span<std::uint64_t> surface);
  /// 2. All ranks raise their words at once.
  void raise(std::span<std::uint64_t> surface) const;
  /// 3. A rank has won the pixels that still have its word. `with_blocks`: whether Won::blocks is
  /// needed.
  [[nodiscard]] Won look(std::span<const std::uint64_t> surface, bool with_blocks) const;

 private:
  [[nodiscard]] WordExchange choose(Communicator& ranks) const;
  void put_owned(const SparseBlocks& words, std::size_t owner, Bytes& to) const;
  void meet_by_hops(Communicator& ranks, const AtPhase& at, std::vector<std::uint64_t>& own) const;
  void take(const Mail& mail, std::size_t rank, std::vector<std::uint64_t>& own) const;

  const BlockGrid& grid_;
  SparseBlocks words_;
};

}  // namespace rastrum::ranks
