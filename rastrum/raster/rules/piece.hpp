// SPDX-License-Identifier: BSD-3-Clause
// A piece: a set-up triangle, line, point or side of a quadric.
#pragma once

#include <bit>
#include <cstdint>

#include <rastrum/config.hpp>
#include <rastrum/primitives.hpp>
#include <rastrum/raster/rules/projection.hpp>

namespace rastrum::raster {

/// Visibility keys (docs/coverage.md): bits(depth) << 33 | (2^33 − 1 − id). 0 is empty. The maximum
/// wins, and at equal depth the smallest id.
inline constexpr int kIdBits = 33;
inline constexpr std::uint64_t kIdMask = (std::uint64_t{1} << kIdBits) - 1;
inline constexpr std::uint64_t kMaxId = kIdMask - 1;

RASTRUM_HD constexpr std::uint64_t id_of_key(std::uint64_t key) {
  return kIdMask - (key & kIdMask);
}

inline float depth_of_key(std::uint64_t key) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(key >> kIdBits));
}

/// A triangle is wound so that all three edge functions are positive inside (clockwise on the
/// screen, whose y points down). Edge i runs from vertex i to vertex (i + 1) mod 3. Vertex 0 is the
/// first submitted and the depth plane's origin. A line keeps its two ends, and in x[2] and y[2]
/// the first pixel along its major axis and the one past the last. A point keeps its centre and, in
/// x[1], its size. For a quadric see quadric.hpp.
struct alignas(16) Piece {
  std::int32_t x[3], y[3];  ///< n.8, inside the guard band, except what is in pixels
  float z0, zx, zy;         ///< depth at vertex 0 and its change per px
  std::uint32_t flags;  ///< kTested … kFacesAway, kLine … kQuadric, the sample, a line's width
  std::uint64_t low;    ///< the key's low part: kIdMask − id
};
static_assert(sizeof(Piece) == 48);

/// Beside kTested and kTranslucent (primitives.hpp): draws only fragments nearer than the picture
/// in the targets (Pass::over). Every coverage and visibility, layers too, checks this before it
/// resolves a pixel.
inline constexpr std::uint32_t kOverPicture = 32;
/// A clip plane crosses this piece's primitive (draws/cut.hpp).
inline constexpr std::uint32_t kCut = 128;
/// A flag of a primitive, not of a piece: clip planes leave nothing, so there is no piece.
inline constexpr std::uint32_t kCutAway = 1U << 31;
inline constexpr std::uint32_t kMayDrop = kTested | kOverPicture | kCut;
/// The kind of piece; none of them: a triangle.
inline constexpr std::uint32_t kLine = 2, kPoint = 4, kQuadric = 64;
inline constexpr std::uint32_t kRound = 1U << 12;
inline constexpr int kLineWidthShift = 16;
/// A triangle that was wound clockwise on the screen. In a closed surface others hide it.
inline constexpr std::uint32_t kFacesAway = 16;
/// One of the triangles that clipping made of one.
inline constexpr std::uint32_t kClipped = 1U << 14;
/// A triangle relative to pixel centres, for all samples of the pixels (rules/samples.hpp).
inline constexpr std::uint32_t kAllSamples = 1U << 15;
/// With kQuadric: the bins that see the piece make its quadric (bin/bin_quadrics.hpp). It has only
/// the box and, in z0, Quadric::highest; it faces the viewer.
inline constexpr std::uint32_t kDeferred = 1U << 13;

RASTRUM_HD inline bool is_triangle(const Piece& p) {
  return (p.flags & (kLine | kPoint | kQuadric)) == 0;
}
RASTRUM_HD inline bool is_round(const Piece& p) {
  return (p.flags & kRound) != 0;
}
RASTRUM_HD inline bool is_quadric(const Piece& p) {
  return (p.flags & kQuadric) != 0;
}
RASTRUM_HD inline bool is_deferred(const Piece& p) {
  return (p.flags & kDeferred) != 0;
}
/// Whether x and y are three places on the screen whose box holds the piece.
RASTRUM_HD inline bool has_corners(const Piece& p) {
  return (p.flags & (kLine | kPoint)) == 0;
}

/// A fragment of a micro triangle, whose samples lie in kMicroSize² pixels. Setup finds its
/// coverage and depth at once.
struct BinFragment {
  std::uint64_t key;
  std::uint32_t bin;
  std::uint32_t pixel;  ///< in the bin: 64 · block + 8 · row + column, and kTranslucentFragment
};
inline constexpr std::uint32_t kTranslucentFragment = 1U << 16;
inline constexpr int kMicroSize = 4;

/// An 8 × 8 block with the samples that a piece covers: bit 8 · row + column.
struct Block {
  std::uint32_t piece;
  std::uint16_t bx, by;  ///< in blocks
  std::uint64_t mask;
};

inline constexpr int kBlockSize = 8;

/// Pixels [x0, x1) × [y0, y1).
struct Rect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  [[nodiscard]] RASTRUM_HD bool empty() const { return x0 >= x1 || y0 >= y1; }
};

RASTRUM_HD inline std::uint64_t samples_inside(Rect r, int bx, int by) {
  const int x0 = bx * kBlockSize, y0 = by * kBlockSize;
  std::uint64_t mask = ~std::uint64_t{0};
  const auto columns = [](unsigned bits) {
    return std::uint64_t{bits & 255U} * 0x0101010101010101U;
  };
  if (x0 < r.x0) mask &= columns(255U << (r.x0 - x0));
  if (y0 < r.y0) mask &= ~std::uint64_t{0} << (kBlockSize * (r.y0 - y0));
  if (x0 + kBlockSize > r.x1) mask &= columns(255U >> (x0 + kBlockSize - r.x1));
  if (y0 + kBlockSize > r.y1) mask &= ~std::uint64_t{0} >> (kBlockSize * (y0 + kBlockSize - r.y1));
  return mask;
}

RASTRUM_HD constexpr int min3(int a, int b, int c) {
  return a < b ? (a < c ? a : c) : (b < c ? b : c);
}
RASTRUM_HD constexpr int max3(int a, int b, int c) {
  return a > b ? (a > c ? a : c) : (b > c ? b : c);
}

/// The pixels whose samples lie in the closed box of the vertices, cut to `view`. `reach` (n.8)
/// widens it for samples up to so far from the centre.
RASTRUM_HD inline Rect sample_bounds(const std::int32_t (&x)[3], const std::int32_t (&y)[3],
                                     Rect view, int reach = 0) {
  // Sample i lies at 256 i + 128: the first at or after v is ⌈(v − 128) / 256⌉.
  const int x0 = (min3(x[0], x[1], x[2]) + kHalfPixel - 1 - reach) >> kSubpixelBits;
  const int y0 = (min3(y[0], y[1], y[2]) + kHalfPixel - 1 - reach) >> kSubpixelBits;
  const int x1 = ((max3(x[0], x[1], x[2]) - kHalfPixel + reach) >> kSubpixelBits) + 1;
  const int y1 = ((max3(y[0], y[1], y[2]) - kHalfPixel + reach) >> kSubpixelBits) + 1;
  return {x0 > view.x0 ? x0 : view.x0, y0 > view.y0 ? y0 : view.y0, x1 < view.x1 ? x1 : view.x1,
          y1 < view.y1 ? y1 : view.y1};
}

}  // namespace rastrum::raster
