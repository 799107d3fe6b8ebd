// SPDX-License-Identifier: BSD-3-Clause
// search: a first enumeration finds the maximum of the depth, a second one the smallest id that has
// it (paper 1, section 3.2.2: what 32-bit atomics can do).
//
// Deviations. The paper keeps all fragments between its two passes and lets the last of equal ones
// win; here nothing is kept, the second pass enumerates again, and equal depths go to the smaller
// id as everywhere.
#pragma once

#include <memory>

#include <papers/axes/region.hpp>

namespace rastrum::family {

/// Work O(fragments), twice; 4 bytes a pixel of the region beside the surface. Counters:
/// "fragments compared", of the second pass, and "depth matches" among them.
[[nodiscard]] std::unique_ptr<Region> make_search(Sharing sharing, MemoryAccount& memory);

}  // namespace rastrum::family
