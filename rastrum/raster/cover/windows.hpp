// SPDX-License-Identifier: BSD-3-Clause
// Coverage for renderers that keep fragments by pixel: a small triangle's samples are one record
// wherever they lie, not one for each block that they touch.
#pragma once

#include <cstddef>

#include <rastrum/raster/kernels/kernels.hpp>

namespace rastrum::raster {

/// As Kernels::cover, but the masks are of windows of 8 × 8 pixels: a Block's bx and by say where
/// one begins, in px from the first pixel of `bin`. No sample of one lies outside of `bin`. Pieces
/// that are opaque or clipped (kClipped) give blocks only.
using CoverWindows = std::size_t (*)(const PieceList& pieces, std::size_t& cursor, Rect bin,
                                     Block* out, std::size_t capacity,
                                     DepthBounds* bounds) noexcept;

[[nodiscard]] CoverWindows cover_windows(Isa isa) noexcept;

}  // namespace rastrum::raster
