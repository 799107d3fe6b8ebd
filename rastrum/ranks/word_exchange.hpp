// SPDX-License-Identifier: BSD-3-Clause
// The opaque phase: words of depth and part meet at the owner of each pixel by maximum, and owners
// tell each rank which pixels it has won.
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

/// A word is depth above the inverted place of a part in the list of all parts, as a visibility key
/// has an id. The maximum is the nearest surface; at equal depths, that of the part which one
/// renderer draws first. A rank has one word a pixel, that of its greatest key, since its ids rise
/// with its parts.
class Words {
 public:
  Words(const BlockGrid& grid, SparseBlocks words) : grid_(grid), words_(std::move(words)) {}
  /// Words from the rank's keys; `places` are its parts' in the list of all.
  Words(const BlockGrid& grid, const SparseBlocks& keys, const OwnParts& own,
        std::span<const std::size_t> places);

  struct Won {
    std::vector<BlockMask> blocks;
    WordExchange taken{};
    std::uint64_t words = 0;         ///< that this rank had
    std::vector<std::uint64_t> own;  ///< the greatest words of all ranks in the blocks it owns
    /// The same of all blocks, where ranks share a surface; `own` has none then.
    std::span<const std::uint64_t> all{};
  };
  /// Finds the greatest words of all ranks, at their owners. Won::blocks stays empty.
  [[nodiscard]] Won meet_owners(Communicator& ranks, const AtPhase& at, WordExchange wanted) const;
  /// The same, and then each rank is told what it has won.
  [[nodiscard]] Won meet(Communicator& ranks, const AtPhase& at, const PartList& list,
                         WordExchange wanted) const;

  // On a surface that ranks share, 64 numbers a block, in phases with agreements between:
  /// first each rank makes its owned blocks empty,
  static void clear_own(const BlockGrid& grid, std::size_t rank, std::span<std::uint64_t> surface);
  /// then raises its words there; other ranks do so at the same time;
  void raise(std::span<std::uint64_t> surface) const;
  /// and then it has won the pixels where its word is still there. `with_blocks`: whether
  /// Won::blocks is needed.
  [[nodiscard]] Won look(std::span<const std::uint64_t> surface, bool with_blocks) const;

 private:
  [[nodiscard]] WordExchange choose(Communicator& ranks) const;
  /// Packs the blocks that `owner` owns.
  void put_owned(const SparseBlocks& words, std::size_t owner, Bytes& to) const;
  void meet_by_hops(Communicator& ranks, const AtPhase& at, std::vector<std::uint64_t>& own) const;
  void take(const Mail& mail, std::size_t rank, std::vector<std::uint64_t>& own) const;

  const BlockGrid& grid_;
  SparseBlocks words_;
};

}  // namespace rastrum::ranks
