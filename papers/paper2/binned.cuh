// SPDX-License-Identifier: BSD-3-Clause
// binned on a device, two-stage (binned.hpp). Masks are exact, and tiles, found by rank and select,
// are dealt out to threads one by one.
//
// Deviations: the host's. Also, a batch (the paper's warp) is 32 neighbouring threads of a kernel:
// nothing else is done by batch. The persistent schedule is the CPU's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <papers/axes/small.cuh>
#include <papers/paper1/tiles.cuh>
#include <papers/paper2/tile_mask.hpp>
#include <rastrum/parallel/mask.hpp>

namespace rastrum::family {

/// An element of the queue. The mask has room for the smallest tiles of the largest bin.
struct QueueEntry {
  BinPair pair;
  parallel::Mask<256> tiles;
};

struct MakeEntry {
  Tiles tiles;
  RASTRUM_HD QueueEntry operator()(std::uint32_t piece, std::size_t j) const {
    QueueEntry entry{tiles.bin(piece, j), {}};
    cover_tiles(tiles.sizes, tiles.pieces[piece], tiles.bins.rect(entry.pair.bin),
                [&](int t) { entry.tiles.set(t); });
    return entry;
  }
};
/// The covered tiles of an entry, `parts` blocks each …
struct EntryBlockCount {
  std::size_t parts;
  RASTRUM_HD std::size_t operator()(const QueueEntry& entry) const {
    return static_cast<std::size_t>(entry.tiles.rank()) * parts;
  }
};
/// … and block k of them.
struct MakeEntryBlock {
  Tiles tiles;
  std::size_t parts;
  RASTRUM_HD Block operator()(const QueueEntry& entry, std::size_t k) const {
    const Rect bin = tiles.bins.rect(entry.pair.bin);
    const int t = entry.tiles.select(static_cast<int>(k / parts));
    return block_of_tile(tiles, entry.pair.piece,
                         intersection(bin, tile_of_bin(tiles.sizes, bin, t)), k % parts);
  }
};

/// Work O(pieces + queue entries + blocks · log); 48 bytes an entry. Counters: "batches", "small",
/// "large", "bins" (queue entries), "tile pairs" (covered tiles).
template <class Exec>
void draw_binned(FamilyFrame<Exec>& frame, std::span<const Piece> pieces) {
  constexpr std::size_t kBatch = 32;
  constexpr std::uint64_t kEntryBytes = sizeof(QueueEntry) + sizeof(std::size_t);
  const int large_px = frame.tuning.large_px == 0 ? kLargePx : frame.tuning.large_px;
  frame.count("batches", (pieces.size() + kBatch - 1) / kBatch);
  const auto parted = small_pieces_first(frame, pieces, static_cast<std::uint64_t>(large_px) - 1);
  const std::span<const std::uint32_t> all = parallel::view_of(parted.elements);
  draw_box_blocks(frame, pieces, all.first(parted.first_count));

  const Tiles tiles = tiles_of_frame(frame, pieces, kPaper2Sizes);
  const std::size_t parts = blocks_per_tile(tiles.sizes);
  std::uint64_t blocks_drawn = 0;
  const std::uint64_t bins = expand_in_turns(
      frame.exec, all.subspan(parted.first_count), BinCount{tiles}, MakeEntry{tiles},
      frame.most(kEntryBytes), [&](std::span<const QueueEntry> queue) {
        blocks_drawn +=
            expand_in_turns(frame.exec, queue, EntryBlockCount{parts}, MakeEntryBlock{tiles, parts},
                            frame.most(kBlockBytes),
                            [&](std::span<const Block> blocks) { frame.emit(pieces, blocks); });
      });
  frame.count("bins", bins);
  frame.count("tile pairs", blocks_drawn / parts);
}

}  // namespace rastrum::family
