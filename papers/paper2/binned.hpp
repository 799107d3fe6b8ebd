// SPDX-License-Identifier: BSD-3-Clause
// binned: paper 2 (Ioannis, "Software rasterization of large triangles"). A worker takes a batch of
// 32 triangles. It draws the small ones itself, block by block of their boxes; large ones go to the
// queue with a (triangle, bin) entry for each bin that their box touches. An entry becomes a mask
// of the tiles that are covered (tile_mask.hpp), a tile is covered exactly. Schedules:
//   two-stage   one queue. The batches fill it; then all tiles of all masks, found by rank and
//               select, are dealt out in equal shares.
//   persistent  a queue for each bin. Workers own bins (bin modulo workers) and draw what lies in
//               their queues, or else take the next batch, until there is neither.
//
// Deviations. Masks are exact. The place of an entry in the two-stage queue comes from a scan, not
// from an atomic tail, so it is the same whatever the threads do. The second stage deals out tiles;
// the paper's takes batches of bins, which are uneven where masks are. The queues are as large as
// they need be; where a memory limit leaves less room, or beyond a million entries, the batches are
// drawn in rounds, each complete in itself: nothing overflows, nothing is lost. Persistent workers
// draw into the keys of the frame, not into a copy of their bin: small triangles lie there too.
// Setup is the family's and comes first; pieces of clipped triangles are batched like others.
#pragma once

#include <papers/axes/coverage.hpp>

namespace rastrum::family {

/// Work O(triangles + queue entries + blocks); memory 96 bytes a drawn triangle, 24 an entry of
/// the queue (72 where a bin has 256 tiles). Throws Error{invalid_argument} for sizes
/// that it does not take. `small` is a piece whose box, cut to the view, has less
/// than `large_px` pixels. Counters: "batches", "small", "large", "bins" (queue entries), "tile
/// pairs" (covered tiles), and the load if 64 workers had shared the work, which is blocks of small
/// pieces and covered tiles: "most loaded of 64 workers" and "work of 64 workers", all of them
/// together. Between barriers batches and shares are dealt in turn, bins owned by number; the most
/// loaded are added up.
[[nodiscard]] std::unique_ptr<Coverage> make_binned(const Tuning& tuning, MemoryAccount& memory);

}  // namespace rastrum::family
