// SPDX-License-Identifier: BSD-3-Clause
// Exact coverage: the span of a row and the mask of a block. Every rasterizer uses these two or
// their SIMD form (cover/cover_simd.cpp), which tests hold equal. Triangles, lines and points are
// each the common inside of a few edge functions. A round point's are those of its square.
//
// An edge from a to b has the function E(p) = (b.x − a.x)(p.y − a.y) − (b.y − a.y)(p.x − a.x),
// positive inside. At sample (i, j), p = 256 (i, j) + 128, so a step of one pixel changes E by a
// multiple of 256 and
//     E ≥ 0  ⇔  ⌊E₀₀ / 256⌋ + A i + B j ≥ 0,   A = a.y − b.y, B = b.x − a.x.
// The top-left rule wants E > 0 on other edges, that is E − 1 ≥ 0: the −1 goes under the floor. In
// the guard band differences are at most 98,304 px = 3 · 2^23 / 256 px, so |A|, |B| < 2^25 and |E|
// < 2^51 fit int64. In a block (steps 0 … 7) A i + B j stays below 2^29, so a base clamped to ±2^30
// keeps the sign of every sum and never overflows int32.
#pragma once

#include <cmath>
#include <cstdint>

#include <rastrum/config.hpp>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/raster/rules/quadric.hpp>

namespace rastrum::raster {

/// value(i, j) = base + a · i + b · j ≥ 0 is inside.
struct Edge {
  std::int64_t base;  ///< at pixel (0, 0) of the image
  std::int32_t a, b;  ///< change per pixel in x and y
};

/// E of the edge (a, b) at (dx, dy) from its begin, n.8, less the top-left rule's 1.
template <class Int>
[[nodiscard]] RASTRUM_HD constexpr Int edge_value(Int a, Int b, Int dx, Int dy) {
  const bool top_left = a > 0 || (a == 0 && b > 0);
  return a * dx + b * dy - (top_left ? 0 : 1);
}

RASTRUM_HD inline Edge edge_function(const Piece& p, int i) {
  const int j = i == 2 ? 0 : i + 1;
  const std::int32_t a = p.y[i] - p.y[j];
  const std::int32_t b = p.x[j] - p.x[i];
  const auto at_origin = edge_value<std::int64_t>(a, b, kHalfPixel - p.x[i], kHalfPixel - p.y[i]);
  return {at_origin >> kSubpixelBits, a, b};
}

/// ⌊n / d⌋ for d > 0.
RASTRUM_HD constexpr std::int64_t floor_div(std::int64_t n, std::int64_t d) {
  const std::int64_t q = n / d;
  return q - (n % d < 0 ? 1 : 0);
}

/// A line without its ends: at pixel m of the major axis it covers the pixels [n, n + width) of the
/// minor one, n = ⌊(base + rise · m) / run⌋. A line of slope −1 to 1 meets the diamond |x − x_f| +
/// |y − y_f| < 1/2 of a pixel exactly if it passes between its upper and its lower corner, so the
/// minor coordinate at the sample of m decides. At a corner OpenGL's shift of the ends by −(ε, ε²)
/// decides, which also makes the top-left rule of triangles. Wide lines are first moved by −(width
/// − 1) / 2. |rise| ≤ run < 2^25.
struct LineBand {
  std::int64_t base;
  std::int32_t rise, run, width;
  bool x_major;

  RASTRUM_HD std::int64_t minor(std::int64_t m) const { return floor_div(base + rise * m, run); }
  /// Its shift along the minor axis, n.8.
  RASTRUM_HD std::int32_t shift() const { return (width - 1) * kHalfPixel; }
};

RASTRUM_HD inline LineBand line_band(const Piece& p) {
  const std::int32_t dx = p.x[1] - p.x[0], dy = p.y[1] - p.y[0];
  LineBand band;
  band.x_major = (dx < 0 ? -dx : dx) >= (dy < 0 ? -dy : dy);
  band.run = band.x_major ? dx : dy;
  band.rise = band.x_major ? dy : dx;
  if (band.run < 0) {
    band.run = -band.run;
    band.rise = -band.rise;
  }
  band.width = static_cast<std::int32_t>(p.flags >> kLineWidthShift);
  // In a tie the shift moves a y-major line left, and an x-major one by ε · rise / run − ε²: down
  // if it falls to the right, else up. The −1 goes under the floor, as in edge_function.
  const int tie = !band.x_major || band.rise <= 0 ? 1 : 0;
  const std::int64_t major = band.x_major ? p.x[0] : p.y[0];
  const std::int64_t minor = (band.x_major ? p.y[0] : p.x[0]) - band.shift();
  band.base = (minor * band.run + band.rise * (kHalfPixel - major) - tie) >> kSubpixelBits;
  return band;
}

/// The samples in the point's square [x − size / 2, x + size / 2) × [y − size / 2, y + size / 2).
/// Pixel i is in from 2 (256 i + 128) ≥ 2 v ∓ size on: ⌈(2 v ∓ size − 256) / 512⌉.
RASTRUM_HD inline Rect point_square(std::int32_t x_fx8, std::int32_t y_fx8, std::int32_t size_fx8) {
  const auto first = [](std::int32_t twice) {
    return (twice - kSubpixels + 2 * kSubpixels - 1) >> (kSubpixelBits + 1);
  };
  return {first(2 * x_fx8 - size_fx8), first(2 * y_fx8 - size_fx8), first(2 * x_fx8 + size_fx8),
          first(2 * y_fx8 + size_fx8)};
}

/// Smaller round points (n.8 px) are square: a disc narrower than √2 px may miss all samples.
inline constexpr std::int32_t kLeastRound = 3 * kSubpixels / 2;

/// Pixels [begin, end) of a row.
struct Span {
  int begin, end;
};

/// The pixels of row y in the disc of a round point, in [x0, x1). On the rim the left half and the
/// top are in, as for the square. In 1/512 px all numbers are whole: u² + v² against size², (u, v)
/// from the centre to the sample.
RASTRUM_HD inline Span disc_span(std::int32_t x_fx8, std::int32_t y_fx8, std::int32_t size_fx8,
                                 int y, int x0, int x1) {
  const std::int64_t v = 2 * (std::int64_t{y} * kSubpixels + kHalfPixel - y_fx8);
  const std::int64_t room = std::int64_t{size_fx8} * size_fx8 - v * v;
  if (room < 0) return {x0, x0};
  // Below 2^41, so the root is never rounded up to a whole number.
  const auto root = static_cast<std::int64_t>(std::sqrt(static_cast<double>(room)));
  const bool left = room > 0 || v < 0;    // the sample at −root is in
  const bool right = root * root < room;  // so is that at root
  if (!left) return {x0, x0};
  // The first and last u that are in. Where both are 0 it is the top, or a row of one sample.
  const std::int64_t first = -root, last = right || root == 0 ? root : root - 1;
  const std::int64_t centre = 2 * std::int64_t{x_fx8} - kSubpixels;
  const std::int64_t begin = -((-(centre + first)) >> (kSubpixelBits + 1));
  const std::int64_t end = ((centre + last) >> (kSubpixelBits + 1)) + 1;
  const auto cut = [&](std::int64_t x) {
    return static_cast<int>(x < x0 ? x0 : (x > x1 ? x1 : x));
  };
  return {cut(begin), cut(end > begin ? end : begin)};
}

/// A triangle's three, a line's two sides and two ends, a point's four sides.
struct Edges {
  Edge edge[4];
  int count;
};

RASTRUM_HD inline Edges edges_of(const Piece& p) {
  if (is_triangle(p))
    return {{edge_function(p, 0), edge_function(p, 1), edge_function(p, 2), {}}, 3};
  if ((p.flags & kPoint) != 0) {
    const Rect r = point_square(p.x[0], p.y[0], p.x[1]);
    return {{{-r.x0, 1, 0}, {r.x1 - 1, -1, 0}, {-r.y0, 0, 1}, {r.y1 - 1, 0, -1}}, 4};
  }
  // n ≤ pixel < n + width ⇔ run (pixel + 1) > base + rise m and run (pixel − width + 1) ≤ the same.
  const LineBand l = line_band(p);
  const std::int64_t below = l.run - 1 - l.base;
  const std::int64_t above = l.base + std::int64_t{l.run} * (l.width - 1);
  const std::int32_t first = p.x[2], last = p.y[2] - 1;
  if (l.x_major)
    return {{{below, -l.rise, l.run}, {above, l.rise, -l.run}, {-first, 1, 0}, {last, -1, 0}}, 4};
  return {{{below, l.run, -l.rise}, {above, -l.run, l.rise}, {-first, 0, 1}, {last, 0, -1}}, 4};
}

/// May be empty.
RASTRUM_HD inline Rect piece_bounds(const Piece& p, Rect view) {
  if (has_corners(p)) return sample_bounds(p.x, p.y, view);
  Rect box;
  if ((p.flags & kPoint) != 0) {
    box = point_square(p.x[0], p.y[0], p.x[1]);
  } else {
    const LineBand band = line_band(p);
    const std::int32_t first = p.x[2], end = p.y[2];
    const auto a = static_cast<int>(band.minor(first));
    const auto b = static_cast<int>(band.minor(end - 1));
    const int low = a < b ? a : b, high = (a < b ? b : a) + band.width;
    box = band.x_major ? Rect{first, low, end, high} : Rect{low, first, high, end};
  }
  return {box.x0 > view.x0 ? box.x0 : view.x0, box.y0 > view.y0 ? box.y0 : view.y0,
          box.x1 < view.x1 ? box.x1 : view.x1, box.y1 < view.y1 ? box.y1 : view.y1};
}

[[nodiscard]] RASTRUM_HD inline bool covers_centre(const Edges& edges, int x, int y) {
  bool inside = true;
  for (int k = 0; k < edges.count; ++k) {
    const Edge& e = edges.edge[k];
    inside = inside && e.base + std::int64_t{e.a} * x + std::int64_t{e.b} * y >= 0;
  }
  return inside;
}

/// No single edge excludes the whole rectangle.
RASTRUM_HD inline bool may_touch(const Edges& edges, Rect r) {
  for (int i = 0; i < edges.count; ++i) {
    const Edge& e = edges.edge[i];
    if (e.base + std::int64_t{e.a} * (e.a > 0 ? r.x1 - 1 : r.x0) +
            std::int64_t{e.b} * (e.b > 0 ? r.y1 - 1 : r.y0) <
        0)
      return false;
  }
  return true;
}

/// Exact; may be empty.
RASTRUM_HD inline Span row_span(const Piece& p, int y, int x0, int x1) {
  std::int64_t begin = x0;
  std::int64_t end = x1;
  const Edges edges = edges_of(p);
  for (int i = 0; i < edges.count; ++i) {
    const Edge e = edges.edge[i];
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
  const Span span{static_cast<int>(begin), static_cast<int>(end)};
  return is_round(p) && span.begin < span.end
             ? disc_span(p.x[0], p.y[0], p.x[1], y, span.begin, span.end)
             : span;
}

/// The samples of block (bx, by) inside of all edges, bit 8 · row + column, cut to columns [x0, x1)
/// and rows [y0, y1) of the block.
RASTRUM_HD inline std::uint64_t cover_8x8(const Edges& edges, int bx, int by,
                                          Rect within = {0, 0, kBlockSize, kBlockSize}) {
  constexpr std::int64_t kClamp = std::int64_t{1} << 30;
  std::uint64_t mask = ~std::uint64_t{0};
  for (int k = 0; k < edges.count; ++k) {
    const Edge e = edges.edge[k];
    const std::int64_t corner =
        e.base + std::int64_t{e.a} * (bx * kBlockSize) + std::int64_t{e.b} * (by * kBlockSize);
    const auto base =
        static_cast<std::int32_t>(corner < -kClamp ? -kClamp : (corner > kClamp ? kClamp : corner));
    std::uint64_t inside = 0;
    for (int row = within.y0; row < within.y1; ++row)
      for (int column = within.x0; column < within.x1; ++column)
        if (base + e.a * column + e.b * row >= 0)
          inside |= std::uint64_t{1} << (row * kBlockSize + column);
    mask &= inside;
  }
  return mask;
}

RASTRUM_HD inline std::uint64_t cover_disc(const Piece& p, int bx, int by) {
  std::uint64_t mask = 0;
  const int x0 = bx * kBlockSize;
  for (int row = 0; row < kBlockSize; ++row) {
    const Span s = disc_span(p.x[0], p.y[0], p.x[1], by * kBlockSize + row, x0, x0 + kBlockSize);
    const std::uint64_t bits = (1U << (s.end - x0)) - (1U << (s.begin - x0));
    mask |= bits << (row * kBlockSize);
  }
  return mask;
}

/// The samples of block (bx, by) that a quadric's piece covers, cut to the pixels `within`.
RASTRUM_HD inline std::uint64_t cover_quadric(const Piece& p, int bx, int by, Rect within) {
  std::uint64_t mask = 0;
  for (int i = 0; i < 64; ++i) {
    const int x = bx * kBlockSize + i % kBlockSize, y = by * kBlockSize + i / kBlockSize;
    if (x >= within.x0 && x < within.x1 && y >= within.y0 && y < within.y1)
      mask |= std::uint64_t{sample_quadric(p, x, y).is_covered} << i;
  }
  return mask;
}

RASTRUM_HD inline std::uint64_t cover_8x8(const Piece& p, int bx, int by) {
  if (is_quadric(p)) {
    const int x0 = bx * kBlockSize, y0 = by * kBlockSize;
    const Rect block{x0, y0, x0 + kBlockSize, y0 + kBlockSize};
    return cover_quadric(p, bx, by, sample_bounds(p.x, p.y, block));
  }
  return is_round(p) ? cover_disc(p, bx, by) : cover_8x8(edges_of(p), bx, by);
}

/// Calls f(x, y) row by row.
template <class F>
RASTRUM_HD inline void for_each_covered(const Piece& p, Rect view, F&& f) {
  const Rect box = piece_bounds(p, view);
  for (int y = box.y0; y < box.y1; ++y) {
    const Span span = is_quadric(p) ? Span{box.x0, box.x1} : row_span(p, y, box.x0, box.x1);
    for (int x = span.begin; x < span.end; ++x)
      if (!is_quadric(p) || sample_quadric(p, x, y).is_covered) f(x, y);
  }
}

/// Calls add(bx, by, mask) for every block of `view` that the piece covers, row by row, unless
/// skip(bx, by). `box`: piece_bounds, not empty.
template <class Skip, class Add>
RASTRUM_HD inline void cover_blocks(const Piece& p, Rect box, Rect view, Skip&& skip, Add&& add) {
  const bool quadric = is_quadric(p);
  const Edges edges = quadric ? Edges{} : edges_of(p);
  for (int by = box.y0 / kBlockSize; by <= (box.y1 - 1) / kBlockSize; ++by)
    for (int bx = box.x0 / kBlockSize; bx <= (box.x1 - 1) / kBlockSize; ++bx) {
      const int x0 = bx * kBlockSize, y0 = by * kBlockSize;
      if (!may_touch(edges, {x0, y0, x0 + kBlockSize, y0 + kBlockSize}) || skip(bx, by)) continue;
      const std::uint64_t mask =
          quadric ? cover_quadric(p, bx, by, box)
                  : (is_round(p) ? cover_disc(p, bx, by) : cover_8x8(edges, bx, by)) &
                        samples_inside(view, bx, by);
      if (mask != 0) add(bx, by, mask);
    }
}

}  // namespace rastrum::raster
