// SPDX-License-Identifier: BSD-3-Clause
// binned: paper 2 (Ioannis, "Software rasterization of large triangles"). A worker takes a batch of
// 32 triangles. It draws the small ones itself, block by block of their boxes. It queues large
// ones, with a (triangle, bin) entry for each bin that the box touches. An entry becomes a mask of
// the covered tiles (tile_mask.hpp), and a tile is covered exactly. Schedules:
//   two-stage   one queue. The batches fill it; then all tiles of all masks, found by rank and
//               select, are dealt out in equal shares.
//   persistent  a queue for each bin. A worker owns bins (bin modulo workers). It draws what is in
//               their queues or else takes the next batch, until there is neither.
//
// Deviations. Masks are exact. A scan, not an atomic tail, gives the place of an entry in the
// two-stage queue, so it does not depend on the threads. The second stage deals out tiles; the
// paper deals out batches of bins, which are uneven where masks are. Queues are as large as needed.
// Under a memory limit, or beyond a million entries, the batches are drawn in complete rounds, so
// nothing overflows. Persistent workers draw into the keys of the frame, which also hold the small
// triangles, not into a copy of their bin. The family's setup comes first; pieces of clipped
// triangles are batched like others.
#pragma once

#include <papers/axes/coverage.hpp>

namespace rastrum::family {

/// Work O(triangles + queue entries + blocks); memory 96 bytes a drawn triangle, 24 an entry of the
/// queue (72 where a bin has 256 tiles). Throws Error{invalid_argument} for invalid sizes. A piece
/// is small if its box in the view has less than `large_px` pixels. Counters: "batches", "small",
/// "large", "bins" (queue entries), "tile pairs" (covered tiles).
///
/// Two counters are the load if 64 workers had shared the work, in blocks of small pieces plus
/// covered tiles: "work of 64 workers" is the total, "most loaded of 64 workers" the sum of the
/// greatest load between barriers. Batches and shares are dealt in turn, bins by number.
[[nodiscard]] std::unique_ptr<Coverage> make_binned(const Tuning& tuning, MemoryAccount& memory);

}  // namespace rastrum::family
