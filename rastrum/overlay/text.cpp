// SPDX-License-Identifier: BSD-3-Clause
// Places the glyphs of text, in integers from the font's own units.
#include <algorithm>
#include <cmath>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/overlay.hpp>
#include <rastrum/overlay/font/font.hpp>

namespace rastrum::overlay {
namespace {

constexpr std::int32_t kFillTolerance = 8, kHaloTolerance = 64;  // 1/32 and 1/4 px

void check(const TextStyle& style) {
  if (!(style.size_px > 0 && style.size_px <= 8192))
    reject("TextStyle::size_px must lie in (0, 8192], got ", style.size_px);
  if (!(style.halo_px >= 0 && style.halo_px <= 256))
    reject("TextStyle::halo_px must lie in [0, 256], got ", style.halo_px);
}

std::int32_t em_of(double size_px) {
  return static_cast<std::int32_t>(std::nearbyint(size_px * 256));
}

/// From the font's units to 1/256 px.
std::int64_t scaled(std::int64_t units, std::int32_t em_fx8) {
  const std::int64_t em = font_metrics().units_per_em;
  return (2 * units * em_fx8 + em) / (2 * em);
}

std::vector<std::vector<char32_t>> lines_of(std::string_view text) {
  std::vector<std::vector<char32_t>> lines(1);
  for (const char32_t code : decode_utf8(text))
    if (code == U'\n')
      lines.emplace_back();
    else
      lines.back().push_back(code);
  return lines;
}

std::int64_t advance_of(const std::vector<char32_t>& line) {
  std::int64_t units = 0;
  for (const char32_t code : line) units += glyph_of(code).advance;
  return units;
}

/// Calls f(glyph, origin) for each glyph. Origins are in 1/256 px from the text's place, before the
/// style's turns.
template <class F>
void for_each_glyph(std::string_view text, const TextStyle& style, F&& f) {
  const std::int32_t em = em_of(style.size_px);
  const FontMetrics font = font_metrics();
  const auto lines = lines_of(text);
  const std::int64_t line_height = scaled(font.line_height, em),
                     capital = scaled(font.capital_height, em),
                     last = line_height * static_cast<std::int64_t>(lines.size() - 1);
  std::int64_t y = style.align_y == AlignY::top      ? capital
                   : style.align_y == AlignY::middle ? (capital - last) / 2
                   : style.align_y == AlignY::bottom ? -last
                                                     : 0;
  for (const auto& line : lines) {
    const std::int64_t width = advance_of(line);
    std::int64_t units = 0, begin = 0;
    if (style.align_x == AlignX::center) begin = -scaled(width, em) / 2;
    if (style.align_x == AlignX::right) begin = -scaled(width, em);
    for (const char32_t code : line) {
      const Glyph& glyph = glyph_of(code);
      f(glyph,
        Point{static_cast<std::int32_t>(begin + scaled(units, em)), static_cast<std::int32_t>(y)});
      units += glyph.advance;
    }
    y += line_height;
  }
}

/// Calls contour(points) for each contour, in the picture. Baselines lie on whole pixels, so that a
/// line's letters are equally sharp.
template <class F>
void for_each_outline(double x_px, double y_px, std::string_view text, const TextStyle& style,
                      std::int32_t tolerance_fx8, F&& contour) {
  check(style);
  Path at;  // rounds and checks
  at.move_to(x_px, y_px);
  const Point place = at.points().front();
  const int turns = ((style.quarter_turns % 4) + 4) % 4;
  constexpr int kCos[] = {1, 0, -1, 0};
  const int cos = kCos[turns], sin = kCos[(turns + 3) % 4];
  const auto turned = [&](Point p) { return Point{cos * p.x + sin * p.y, cos * p.y - sin * p.x}; };
  const auto whole = [](std::int32_t fx8) { return (fx8 + 128) & ~255; };
  std::vector<Point> points;
  for_each_glyph(text, style, [&](const Glyph& glyph, Point origin) {
    Point o = turned(origin);
    o = {place.x + o.x, place.y + o.y};
    if (turns % 2 == 0)
      o.y = whole(o.y);
    else
      o.x = whole(o.x);
    for_each_contour(glyph, em_of(style.size_px), tolerance_fx8,
                     [&](const std::vector<Point>& outline) {
                       points.clear();
                       for (const Point p : outline) {
                         const Point q = turned(p);
                         points.push_back({o.x + q.x, o.y + q.y});
                       }
                       contour(points);
                     });
  });
}

/// Adds the area that a round pen covers as it follows the outline.
void add_stroke(Path& path, const std::vector<Point>& outline, double radius_px) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point a = outline[i], b = outline[(i + 1) % outline.size()];
    const double ax = a.x / 256.0, ay = a.y / 256.0;
    path.add_disc(ax, ay, radius_px);
    path.add_line(ax, ay, b.x / 256.0, b.y / 256.0, 2 * radius_px);
  }
}

}  // namespace

Path text_path(double x_px, double y_px, std::string_view text, const TextStyle& style) {
  const FloatScope floats;
  Path path;
  for_each_outline(x_px, y_px, text, style, kFillTolerance, [&](const std::vector<Point>& outline) {
    for (std::size_t i = 0; i < outline.size(); ++i)
      if (i == 0)
        path.move_to(outline[i]);
      else
        path.line_to(outline[i]);
  });
  return path;
}

void draw_text(const Canvas& canvas, double x_px, double y_px, std::string_view text,
               const TextStyle& style, PixelTest test) {
  const FloatScope floats;
  if (style.halo_px > 0 && style.halo.a != 0) {
    Path halo;
    for_each_outline(
        x_px, y_px, text, style, kHaloTolerance,
        [&](const std::vector<Point>& outline) { add_stroke(halo, outline, style.halo_px); });
    fill(canvas, halo, style.halo, test);
  }
  fill(canvas, text_path(x_px, y_px, text, style), style.color, test);
}

TextExtent measure_text(std::string_view text, double size_px) {
  const FloatScope floats;
  check(TextStyle{.size_px = size_px});
  const std::int32_t em = em_of(size_px);
  const auto lines = lines_of(text);
  std::int64_t widest = 0;
  for (const auto& line : lines) widest = std::max(widest, advance_of(line));
  const FontMetrics font = font_metrics();
  const std::int64_t height =
      scaled(font.capital_height, em) +
      scaled(font.line_height, em) * static_cast<std::int64_t>(lines.size() - 1);
  return {static_cast<double>(scaled(widest, em)) / 256, static_cast<double>(height) / 256};
}

std::vector<char32_t> missing_glyphs(std::string_view text) {
  std::vector<char32_t> missing;
  for (const char32_t code : decode_utf8(text)) {
    // Bytes that are not UTF-8 decode to U+FFFD, which is no letter of the text.
    const bool there = code == U'\n' || (code != 0xFFFD && !is_missing(glyph_of(code)));
    if (!there && std::find(missing.begin(), missing.end(), code) == missing.end())
      missing.push_back(code);
  }
  return missing;
}

}  // namespace rastrum::overlay
