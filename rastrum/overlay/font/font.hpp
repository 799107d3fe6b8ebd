// SPDX-License-Identifier: BSD-3-Clause
// The embedded font: DejaVu Sans, as quadratic outlines in its own units (tools/font_outlines.py).
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <rastrum/overlay.hpp>

namespace rastrum::overlay {

struct Glyph {
  char32_t code;  ///< 0: the box that stands for missing characters
  std::int32_t advance;
  std::int32_t points;  ///< where its contours begin in the table of points
};

struct FontMetrics {
  int units_per_em, capital_height, line_height;
};
[[nodiscard]] FontMetrics font_metrics();

/// The glyph of a code point, or the box.
[[nodiscard]] const Glyph& glyph_of(char32_t code);
[[nodiscard]] inline bool is_missing(const Glyph& glyph) {
  return glyph.code == 0;
}

/// The code points of UTF-8 text; U+FFFD for each byte that belongs to none, as of overlong forms,
/// surrogates and values beyond U+10FFFF.
[[nodiscard]] std::vector<char32_t> decode_utf8(std::string_view text);

/// Calls contour(points) for each contour, a closed polygon in 1/256 px: y down, the glyph's origin
/// at (0, 0), its em `em_fx8` high. Curves lie within `tolerance_fx8` of the chords.
template <class Contour>
void for_each_contour(const Glyph& glyph, std::int32_t em_fx8, std::int32_t tolerance_fx8,
                      Contour&& contour);

[[nodiscard]] const std::int16_t* glyph_points(const Glyph& glyph);

/// Appends the curve from `a`, already there, with control point `c` to `b`.
void append_curve(Point a, Point c, Point b, std::int32_t tolerance_fx8, std::vector<Point>& to);

template <class Contour>
void for_each_contour(const Glyph& glyph, std::int32_t em_fx8, std::int32_t tolerance_fx8,
                      Contour&& contour) {
  const std::int16_t* p = glyph_points(glyph);
  const std::int64_t em = font_metrics().units_per_em;
  const auto scaled = [&](std::int64_t units) {
    return static_cast<std::int32_t>((units * em_fx8 * 2 + em) >> 12);  // em is 2^11: rounds
  };
  std::vector<Point> points;
  for (int contours = *p++; contours > 0; --contours) {
    const int count = *p++;
    const auto at = [&](int i) {
      const std::int16_t* q = p + 2 * (i % count);
      return Point{scaled(q[0] >> 1), -scaled(q[1])};
    };
    const auto on = [&](int i) { return (p[2 * (i % count)] & 1) != 0; };
    const auto middle = [](Point a, Point b) { return Point{(a.x + b.x) >> 1, (a.y + b.y) >> 1}; };
    // Between two points off the curve, their middle lies on it. A contour begins on the curve.
    points.clear();
    const Point start = on(0)           ? at(0)
                        : on(count - 1) ? at(count - 1)
                                        : middle(at(0), at(count - 1));
    Point from = start;
    points.push_back(from);
    for (int i = on(0) ? 1 : 0; i < count; ++i) {
      if (on(i)) {
        from = at(i);
        if (!(from == start)) points.push_back(from);
        continue;
      }
      const Point to = i + 1 == count ? start : on(i + 1) ? at(i + 1) : middle(at(i), at(i + 1));
      append_curve(from, at(i), to, tolerance_fx8, points);
      from = to;
      if (i + 1 < count && on(i + 1)) ++i;
    }
    if (points.size() > 1 && points.back() == points.front()) points.pop_back();
    contour(points);
    p += 2 * count;
  }
}

}  // namespace rastrum::overlay
