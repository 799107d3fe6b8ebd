// SPDX-License-Identifier: BSD-3-Clause
// sorted: count, scan, write (pixel, key), sort by pixel, take the maximum of each pixel's segment,
// scatter (paper 5, sections 3.1 to 3.4), without an atomic operation on a pixel.
//
// Deviations. The paper sorts an index over all fragments by a comparator and gathers depth and
// colour, 51 bytes a fragment. Here the counting pass also counts by bands of pixels, so the
// writing pass already partitions: a band is the first, most significant digit of the sort, and the
// rest of a pixel's number fits into 16 bits. A band is then sorted by the rest in slices that stay
// in cache: 10 bytes a fragment and two slices a thread. Fragments beyond the budget come in runs
// of chunks. A chunk that is too large by itself, or a region that one thread owns, is sorted slice
// by slice as its fragments come.
#pragma once

#include <memory>

#include <papers/axes/region.hpp>

namespace rastrum::family {

/// Work O(fragments), enumerated twice if shared, three times if they do not fit at once. Counters:
/// "fragments materialized", "sorts" (slices).
[[nodiscard]] std::unique_ptr<Region> make_sorted(Sharing sharing, MemoryAccount& memory);

}  // namespace rastrum::family
