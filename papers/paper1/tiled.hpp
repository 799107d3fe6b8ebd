// SPDX-License-Identifier: BSD-3-Clause
// tiled: every triangle is expanded to bins and tiles, the (tile, triangle) pairs are sorted by
// tile, and who draws a tile owns its keys, which never leave the cache before they are shaded
// (paper 1, section 3.3 and `triangle_tiled_pineda.fut`; sort-middle after Molnar et al., 1994).
//
// Deviation. A tile's keys are shaded where they are, which the paper recommends and does not do:
// there is no buffer of the whole frame. The fast relative of this listing is `grouped`.
#pragma once

#include <memory>

#include <papers/axes/coverage.hpp>

namespace rastrum::family {

/// Work O(pieces + bins · tiles a bin + pairs · digits + blocks), span that of the sort plus the
/// longest tile. Memory beside the pieces: 16 bytes and a mask a bin, 20 a pair; none a pixel.
/// Counters: "bins", "tile pairs". Throws Error{invalid_argument} for sizes that it does not take.
[[nodiscard]] std::unique_ptr<Coverage> make_tiled(const Tuning& tuning, MemoryAccount& memory);

}  // namespace rastrum::family
