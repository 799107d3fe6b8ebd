// SPDX-License-Identifier: BSD-3-Clause
// Bands of a picture. Their layers are exchanged one after the other, which bounds the fragments
// that a rank holds at once.
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

/// Rectangles of whole bins that cover all bins with fragments: as many rows as fit, or parts of a
/// row. In each, a rank's own fragments and those that it blends take at most `bytes`, unless one
/// bin needs more. `bins`: of the whole picture, by row.
[[nodiscard]] std::vector<raster::Rect> bands_of(int width, int height,
                                                 std::span<const BinFragments> bins,
                                                 std::size_t ranks, std::uint64_t bytes);

}  // namespace rastrum::ranks
