// SPDX-License-Identifier: BSD-3-Clause
// hashed: instead of sorting fragments, a hash table from pixels to keys whose keys are raised;
// then its entries are compacted and scattered (what paper 5 names as future work, its section 6).
//
// Open addressing. The counting pass bounds the pixels, so the table never grows: it has
// min(fragments, pixels) / load factor slots. Blocks are hashed, and the 64 samples of a block have
// 64 slots in a row; a collision goes on to the next block's slots and the next sample, so that
// blocks with few samples fill what others leave. Where threads share the table a slot is taken by
// a compare-and-swap of its pixel and its key raised by an atomic maximum.
#pragma once

#include <memory>

#include <papers/axes/region.hpp>

namespace rastrum::family {

/// Work O(fragments + slots) expected, enumerated twice where shared and not bounded by the pixels;
/// 12 bytes a slot. Fragments whose pixels may not fit into the budget come run of chunks by run of
/// chunks. Counters: "fragments hashed", "table slots" and "table entries", whose ratio is the load
/// that was reached, and "probes", the slots that were looked at to find the entries' own.
[[nodiscard]] std::unique_ptr<Region> make_hashed(Sharing sharing, MemoryAccount& memory);

}  // namespace rastrum::family
