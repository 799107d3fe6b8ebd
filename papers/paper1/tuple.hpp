// SPDX-License-Identifier: BSD-3-Clause
// tuple: keeps (key, colour) of every fragment; the greater key wins with its colour (paper 1,
// section 3.2.1). Every fragment is shaded at once. If threads share the region, one lock per block
// guards the pairs, which are too large for an atomic operation.
#pragma once

#include <memory>

#include <papers/axes/region.hpp>

namespace rastrum::family {

/// Work O(fragments) maxima and O(fragments) shading; 16 bytes of colour a pixel, and a byte of
/// lock a block of a shared region. Counter: "fragments shaded".
[[nodiscard]] std::unique_ptr<Region> make_tuple_region(Sharing sharing, MemoryAccount& memory);

}  // namespace rastrum::family
