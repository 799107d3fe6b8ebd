// SPDX-License-Identifier: BSD-3-Clause
// search: a first enumeration finds the greatest depth, a second one the smallest id at that depth
// (paper 1, section 3.2.2: what 32-bit atomics can do).
//
// Deviations. The paper keeps all fragments between its two passes; here the second pass enumerates
// again. At equal depths the smaller id wins, as everywhere here; in the paper the last one wins.
#pragma once

#include <memory>

#include <papers/axes/region.hpp>

namespace rastrum::family {

/// Work O(fragments), twice; 4 bytes a pixel of the region beside the surface. Counters: "fragments
/// compared" (second pass) and "depth matches" among them.
[[nodiscard]] std::unique_ptr<Region> make_search(Sharing sharing, MemoryAccount& memory);

}  // namespace rastrum::family
