// SPDX-License-Identifier: BSD-3-Clause
// The operators of paper 3's scans (section 4.3). Both are associative, which its appendix B.2
// proves and a test samples.
#pragma once

#include <cstdint>

#include <rastrum/config.hpp>
#include <rastrum/image.hpp>
#include <rastrum/terrain/setup.hpp>

namespace rastrum::family {

/// The paper's colour–height pair, with the distance for those who want depth. Its row is the first
/// that it would be drawn in, at least 0. Not drawn: terrain::kNoRow. Listing 4.6 clamps rows to
/// the last one instead, which draws what lies below the picture into its bottom row.
struct Pair {
  Rgba8 color;
  float depth = 0;
  std::int32_t row = 0;
  friend bool operator==(const Pair&, const Pair&) = default;
};
/// The neutral element of `Occlude`: a pair that is not drawn.
inline constexpr Pair kNoPair{{}, 0, terrain::kNoRow};

/// Listing 4.8: the nearer one where it hides the farther one.
struct Occlude {
  RASTRUM_HD Pair operator()(const Pair& nearer, const Pair& farther) const {
    return nearer.row <= farther.row ? nearer : farther;
  }
};

/// A pixel of a column. Empty is a distance of 0, which no sample has; listing 4.10 takes the sky's
/// colour for emptiness, so that terrain of that colour is painted over.
struct Pixel {
  Rgba8 color;
  float depth = 0;
  friend bool operator==(const Pixel&, const Pixel&) = default;
};

/// Listing 4.10: what is empty shows what is above it.
struct Fill {
  RASTRUM_HD Pixel operator()(const Pixel& above, const Pixel& below) const {
    return below.depth == 0 ? above : below;
  }
};

}  // namespace rastrum::family
