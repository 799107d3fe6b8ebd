// SPDX-License-Identifier: BSD-3-Clause
// hybrid: small triangles are drawn at once into the frame, the others tile by tile onto the same
// surface (paper 1, section 3.3 and `triangle_hybrid_pineda.fut`, after Schütz et al., 2021).
//
// Small ones go through the blocks of their boxes or, as section 4.2 proposes, through rows
// (Tuning::small_path).
#pragma once

#include <memory>

#include <papers/axes/coverage.hpp>

namespace rastrum::family {

/// Work and memory: those of `pineda` for the small triangles (or of `scanline`), of `tiled` for
/// the others. Counters: "small", "large", "bins", "tile pairs" (and "rows", "runs"). Throws
/// Error{invalid_argument} for sizes that it does not take.
[[nodiscard]] std::unique_ptr<Coverage> make_hybrid(const Tuning& tuning, MemoryAccount& memory);

}  // namespace rastrum::family
