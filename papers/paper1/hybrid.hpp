// SPDX-License-Identifier: BSD-3-Clause
// hybrid: draws small triangles directly into the frame and the others tile by tile onto the same
// surface (paper 1, section 3.3 and `triangle_hybrid_pineda.fut`, after Schütz et al., CuRast,
// 2026). Small ones go through the blocks of their boxes or, as section 4.2 proposes, through rows
// (Tuning::small_path).
#pragma once

#include <memory>

#include <papers/axes/coverage.hpp>

namespace rastrum::family {

/// Work and memory: `pineda`'s (or `scanline`'s) for small triangles, `tiled`'s for the others.
/// Counters: "small", "large", "bins", "tile pairs" (and "rows", "runs"). Throws
/// Error{invalid_argument} for invalid sizes.
[[nodiscard]] std::unique_ptr<Coverage> make_hybrid(const Tuning& tuning, MemoryAccount& memory);

}  // namespace rastrum::family
