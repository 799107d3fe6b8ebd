// Exact coverage: the one interval of a row and the one mask of a block. Every rasterizer covers
// through these two, or through their SIMD form (cover_simd.cpp), which tests hold equal to them.
//
// The arithmetic. An edge from a to b has the function E(p) = (b.x − a.x)(p.y − a.y) −
// (b.y − a.y)(p.x − a.x), positive inside. At sample (i, j), p = 256 (i, j) + 128, so a step of one
// pixel changes E by a multiple of 256 and
//     E ≥ 0  ⇔  ⌊E₀₀ / 256⌋ + A i + B j ≥ 0,   A = a.y − b.y, B = b.x − a.x.
// The top-left rule asks for E > 0 on the other edges, that is E − 1 ≥ 0: the −1 goes under the
// floor. Differences inside the guard band are at most 98,304 px = 3 · 2^23 / 256 px, so |A|, |B| <
// 2^25 and |E| < 2^51 fit int64. Inside a block (steps 0 … 7) A i + B j stays below 2^29; a base
// clamped to ±2^30 therefore keeps the sign of every sum and never overflows int32.
#pragma once

#include <cstdint>

#include <rastrum/core/config.hpp>
#include <rastrum/raster/piece.hpp>

namespace rastrum::raster {

/// One edge for integer stepping over pixels: value(i, j) = base + a · i + b · j ≥ 0 is inside.
struct Edge {
  std::int64_t base;  ///< at pixel (0, 0) of the image
  std::int32_t a, b;  ///< change per pixel in x and y
};

RASTRUM_HD inline Edge edge_function(const Piece& p, int i) {
  const int j = i == 2 ? 0 : i + 1;
  const std::int32_t a = p.y[i] - p.y[j];
  const std::int32_t b = p.x[j] - p.x[i];
  const bool top_left = a > 0 || (a == 0 && b > 0);
  const std::int64_t at_origin = std::int64_t{a} * (kHalfPixel - p.x[i]) +
                                 std::int64_t{b} * (kHalfPixel - p.y[i]) - (top_left ? 0 : 1);
  return {at_origin >> kSubpixelBits, a, b};
}

/// Pixels [begin, end) of a row.
struct Span {
  int begin, end;
};

/// ⌊n / d⌋ for d > 0.
RASTRUM_HD constexpr std::int64_t floor_div(std::int64_t n, std::int64_t d) {
  const std::int64_t q = n / d;
  return q - (n % d < 0 ? 1 : 0);
}

/// The pixels of row y that the piece covers, within [x0, x1): exact, possibly empty.
RASTRUM_HD inline Span row_span(const Piece& p, int y, int x0, int x1) {
  std::int64_t begin = x0;
  std::int64_t end = x1;
  for (int i = 0; i < 3; ++i) {
    const Edge e = edge_function(p, i);
    const std::int64_t at_row = e.base + std::int64_t{e.b} * y;
    if (e.a > 0) {  // at_row + a x ≥ 0 ⇔ x ≥ ⌈−at_row / a⌉
      const std::int64_t first = -floor_div(at_row, e.a);
      begin = first > begin ? first : begin;
    } else if (e.a < 0) {  // ⇔ x ≤ ⌊at_row / −a⌋
      const std::int64_t past = floor_div(at_row, -std::int64_t{e.a}) + 1;
      end = past < end ? past : end;
    } else if (at_row < 0) {
      return {x0, x0};
    }
  }
  if (end < begin) end = begin;
  return {static_cast<int>(begin), static_cast<int>(end)};
}

/// The samples of block (bx, by) that the piece covers; bit 8 · row + column.
RASTRUM_HD inline std::uint64_t cover_8x8(const Piece& p, int bx, int by) {
  constexpr std::int64_t kClamp = std::int64_t{1} << 30;
  std::uint64_t mask = ~std::uint64_t{0};
  for (int i = 0; i < 3; ++i) {
    const Edge e = edge_function(p, i);
    const std::int64_t corner =
        e.base + std::int64_t{e.a} * (bx * kBlockSize) + std::int64_t{e.b} * (by * kBlockSize);
    const auto base =
        static_cast<std::int32_t>(corner < -kClamp ? -kClamp : (corner > kClamp ? kClamp : corner));
    std::uint64_t inside = 0;
    for (int row = 0; row < kBlockSize; ++row)
      for (int column = 0; column < kBlockSize; ++column)
        if (base + e.a * column + e.b * row >= 0)
          inside |= std::uint64_t{1} << (row * kBlockSize + column);
    mask &= inside;
  }
  return mask;
}

}  // namespace rastrum::raster
