// SPDX-License-Identifier: BSD-3-Clause
// The sort in `tiled` and `hybrid` (paper 1, section 3.3): sorts (tile, piece) pairs by tile, so
// that a tile's pieces are a segment and one thread can own the tile.
#pragma once

#include <cstdint>
#include <span>

#include <papers/paper1/tiles.hpp>

namespace rastrum::family {

/// Draws pieces tile by tile. Surfaces are made of blocks, so one thread owns the four tiles of 4
/// px in a block.
void draw_sorted_tiles(Frame& frame, BinSizes sizes, const Piece* pieces,
                       std::span<const std::uint32_t> which);

}  // namespace rastrum::family
