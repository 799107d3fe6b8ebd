// SPDX-License-Identifier: BSD-3-Clause
// tuple: (key, colour) of every fragment, the greater key wins with its colour (paper 1, section
// 3.2.1). Every fragment is shaded at once; where threads share the region a lock a block guards
// the pair, which no machine can change at once.
#pragma once

#include <memory>

#include <papers/axes/region.hpp>

namespace rastrum::family {

/// Work O(fragments) maxima and O(fragments) shading; colours of 16 bytes a pixel in the surface,
/// for a shared region a byte a block for the lock. Counter: "fragments shaded".
[[nodiscard]] std::unique_ptr<Region> make_tuple_region(Sharing sharing, MemoryAccount& memory);

}  // namespace rastrum::family
