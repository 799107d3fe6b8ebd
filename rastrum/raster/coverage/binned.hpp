// binned: paper 2 (Ioannis, "Software rasterization of large triangles"). A worker takes a batch of
// 32 triangles. It draws the small ones itself, block by block of their boxes; large ones go to the
// queue with a (triangle, bin) entry for each bin that their box touches. An entry becomes a mask
// of the tiles that are covered (tile_mask.hpp), a tile is covered exactly. Schedules:
//   two-stage   one queue. The batches fill it; then all tiles of all masks, found by rank and
//               select, are dealt out in equal shares.
//   persistent  a queue for each bin. Workers own bins (bin modulo workers) and draw what lies in
//               their queues, or else take the next batch, until there is neither.
//
// Deviations. Masks are exact. The two-stage queue's tail is a scan, not an atomic counter: an
// entry has its place whatever the threads do. Tiles are dealt out, not taken by bins: the paper's
// shares are uneven where masks are. Queues are as large as they need be; what would make them
// larger than `kQueueEntries` is drawn in rounds, each complete in itself, so nothing is lost and
// memory is bounded. Setup is the family's and comes first, and pieces of clipped triangles are
// batched like others.
#pragma once

#include <rastrum/raster/coverage/coverage.hpp>

namespace rastrum::raster {

/// Work O(triangles + queue entries + blocks); memory 48 bytes a drawn triangle while all are set
/// up (twice that for a moment), 24 to 48 an entry. Requires one of the tunings (bin, tile) 32, 8;
/// 64, 8; 64, 16; 128, 8; 128, 16. `small` is a piece whose box, cut to the view, has less than
/// `large_px` pixels.
/// Counters: "batches", "small", "large", "bins" (queue entries), "tile pairs" (covered tiles), and
/// the load if 64 workers had shared the work, which is blocks of small pieces and covered tiles:
/// "most loaded of 64 workers" and "work of 64 workers", all of them together. Between barriers
/// batches and shares are dealt in turn, bins owned by number; the most loaded are added up.
[[nodiscard]] std::unique_ptr<Coverage> make_binned(const Tuning& tuning, MemoryAccount& memory);

}  // namespace rastrum::raster
