// SPDX-License-Identifier: BSD-3-Clause
// tiled: expands every triangle to bins and tiles and sorts the (tile, triangle) pairs by tile. The
// thread that draws a tile owns its keys, which stay in the cache until they are shaded (paper 1,
// section 3.3 and `triangle_tiled_pineda.fut`; sort-middle after Molnar et al., 1994).
//
// Deviation. A tile's keys are shaded in place, without a buffer of the whole frame; the paper only
// recommends this. `grouped` is the fast variant.
#pragma once

#include <memory>

#include <papers/axes/coverage.hpp>

namespace rastrum::family {

/// Work O(pieces + bins · tiles a bin + pairs · digits + blocks), span of the sort plus the longest
/// tile. Memory beside the pieces: 16 bytes and a mask a bin, 20 a pair; none a pixel. Counters:
/// "bins", "tile pairs". Throws Error{invalid_argument} for invalid sizes.
[[nodiscard]] std::unique_ptr<Coverage> make_tiled(const Tuning& tuning, MemoryAccount& memory);

}  // namespace rastrum::family
