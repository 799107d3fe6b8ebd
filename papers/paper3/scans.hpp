// SPDX-License-Identifier: BSD-3-Clause
// The operators of paper 3's scans (section 4.3). Both are associative: the paper's appendix B.2
// proves it, and a test samples it.
#pragma once

#include <cstdint>

#include <rastrum/config.hpp>
#include <rastrum/image.hpp>
#include <rastrum/terrain/setup.hpp>

namespace rastrum::family {

/// The paper's colour–height pair, with a distance for depth pictures. `row` is the first row that
/// it would be drawn in, at least 0, or terrain::kNoRow if it is not drawn. Listing 4.6 instead
/// clamps rows to the last one, which draws terrain below the picture into its bottom row.
struct Pair {
  Rgba8 color;
  float depth = 0;
  std::int32_t row = 0;
  friend bool operator==(const Pair&, const Pair&) = default;
};
/// The neutral element of `Occlude`: a pair that is not drawn.
inline constexpr Pair kNoPair{{}, 0, terrain::kNoRow};

/// Listing 4.8: the nearer pair if it hides the farther one.
struct Occlude {
  RASTRUM_HD Pair operator()(const Pair& nearer, const Pair& farther) const {
    return nearer.row <= farther.row ? nearer : farther;
  }
};

/// A pixel of a column. A distance of 0, which no sample has, is empty. Listing 4.10 instead uses
/// the sky's colour, so it overpaints terrain of that colour.
struct Pixel {
  Rgba8 color;
  float depth = 0;
  friend bool operator==(const Pixel&, const Pixel&) = default;
};

/// Listing 4.10: an empty pixel shows the one above it.
struct Fill {
  RASTRUM_HD Pixel operator()(const Pixel& above, const Pixel& below) const {
    return below.depth == 0 ? above : below;
  }
};

}  // namespace rastrum::family
