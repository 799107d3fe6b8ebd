// SPDX-License-Identifier: BSD-3-Clause
// Coverage for renderers that keep fragments by pixel: a small triangle's samples are one record
// anywhere, not one for each block.
#pragma once

#include <cstddef>

#include <rastrum/raster/kernels/kernels.hpp>

namespace rastrum::raster {

/// As Kernels::cover, but masks are of windows of 8 × 8 pixels. A Block's bx and by are a window's
/// first pixel, relative to that of `bin`. No sample lies outside of `bin`. Opaque or clipped
/// (kClipped) pieces give blocks only.
using CoverWindows = std::size_t (*)(const PieceList& pieces, std::size_t& cursor, Rect bin,
                                     Block* out, std::size_t capacity,
                                     DepthBounds* bounds) noexcept;

[[nodiscard]] CoverWindows cover_windows(Isa isa) noexcept;

}  // namespace rastrum::raster
