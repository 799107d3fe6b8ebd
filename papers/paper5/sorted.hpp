// SPDX-License-Identifier: BSD-3-Clause
// sorted: count, scan, write (pixel, key), sort by pixel, maximum of each pixel's segment, scatter
// (paper 5, sections 3.1 to 3.4): no atomic operation on a pixel.
//
// Deviations. The paper sorts an index over all fragments by a comparator and gathers depth and
// colour, 51 bytes a fragment. Here the counting pass counts by bands of pixels as well, so that
// the writing pass already partitions: it is the first, most significant digit of the sort, and
// what is left of a pixel's number fits 16 bits. A band is then sorted by the others in slices that
// stay in cache: 10 bytes a fragment and two slices a thread. Fragments that do not fit into the
// budget come run of chunks by run of chunks; a chunk that does not fit by itself, and the region
// that one thread owns, are sorted slice by slice as they come.
#pragma once

#include <memory>

#include <papers/axes/region.hpp>

namespace rastrum::family {

/// Work O(fragments), enumerated twice where shared, three times where they do not fit at once.
/// Counters: "fragments materialized", "sorts" (slices).
[[nodiscard]] std::unique_ptr<Region> make_sorted(Sharing sharing, MemoryAccount& memory);

}  // namespace rastrum::family
