// SPDX-License-Identifier: BSD-3-Clause
// hashed: instead of sorting fragments, raises keys in a hash table from pixels to keys, then
// compacts and scatters its entries (paper 5 names this as future work in section 6).
//
// Open addressing (hash_slots.hpp). The counting pass bounds the pixels, so the table never grows:
// it has min(fragments, pixels) / load factor slots. If threads share the table, a compare-and-swap
// takes a slot for a pixel and an atomic maximum raises its key.
#pragma once

#include <memory>

#include <papers/axes/region.hpp>

namespace rastrum::family {

/// Work O(fragments + slots) expected; 12 bytes a slot. Fragments are enumerated twice if the
/// region is shared and the pixels do not bound the table. If their pixels may not fit into the
/// budget, they come in runs of chunks. Counters: "fragments hashed"; "table slots" and "table
/// entries", whose ratio is the load; "probes", the slots tried to find the entries' own.
[[nodiscard]] std::unique_ptr<Region> make_hashed(Sharing sharing, MemoryAccount& memory);

}  // namespace rastrum::family
