// SPDX-License-Identifier: BSD-3-Clause
// Bands of a picture whose layers are exchanged one after the other, so that what ranks hold of
// fragments at once is bounded.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/raster/rules/piece.hpp>

namespace rastrum::ranks {

/// Fragments in a bin of 64 × 64 pixels.
struct BinFragments {
  std::uint64_t all = 0;   ///< of all ranks together
  std::uint64_t most = 0;  ///< of the rank that has most
};

/// Rectangles, cut at bins, that cover all bins with fragments: rows of bins, as many as fit, or
/// parts of a row. In each no rank holds more than `bytes`, of its own and of those that it blends
/// together, unless one bin alone needs that. `bins`: by row, of the whole picture.
[[nodiscard]] std::vector<raster::Rect> bands_of(int width, int height,
                                                 std::span<const BinFragments> bins,
                                                 std::size_t ranks, std::uint64_t bytes);

}  // namespace rastrum::ranks
