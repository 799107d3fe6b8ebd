// SPDX-License-Identifier: BSD-3-Clause
// The bar that shows which colour is which number.
#include <algorithm>
#include <cmath>
#include <string>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/number_text.hpp>
#include <rastrum/error.hpp>
#include <rastrum/overlay.hpp>
#include <rastrum/overlay/canvas.hpp>

namespace rastrum::overlay {
namespace {

void check(const ScalarBar& bar) {
  const auto refuse = [](const std::string& what) {
    throw Error(Errc::invalid_argument, "ScalarBar::" + what);
  };
  if (bar.colors.empty()) refuse("colors are none");
  if (!bar.categories.empty() && bar.categories.size() != bar.colors.size())
    refuse(
        text_of("categories are ", bar.categories.size(), " for ", bar.colors.size(), " colours"));
  const std::string range = number_text(bar.low) + " to " + number_text(bar.high);
  if (!(std::isfinite(bar.low) && std::isfinite(bar.high) && bar.low <= bar.high))
    refuse("low to high is not finite or upside down: " + range);
  if (bar.logarithmic && !(bar.low > 0)) refuse("low must lie above 0 with a logarithm: " + range);
}

void fill_opaque(const Canvas& canvas, const Path& path, Vec4 color) {
  const auto channel = [](float v) {
    return static_cast<std::uint8_t>(std::nearbyint(std::clamp(v, 0.0F, 1.0F) * 255.0F));
  };
  fill(canvas, path, {channel(color.x), channel(color.y), channel(color.z), 255});
}

/// `t`: in [0, 1], along the bar.
Vec4 color_at(const ScalarBar& bar, double t) {
  const std::size_t n = bar.colors.size();
  if (bar.discrete || !bar.categories.empty())
    return bar.colors[std::min(n - 1, static_cast<std::size_t>(t * static_cast<double>(n)))];
  const double place = t * static_cast<double>(n - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(place), n - 1),
                    j = std::min(i + 1, n - 1);
  const auto part = static_cast<float>(place - static_cast<double>(i));
  return bar.colors[i] * (1 - part) + bar.colors[j] * part;
}

double part_of(const ScalarBar& bar, double value) {
  if (bar.low == bar.high) return 0.5;
  return bar.logarithmic
             ? elementary::log10(value / bar.low) / elementary::log10(bar.high / bar.low)
             : (value - bar.low) / (bar.high - bar.low);
}

struct Label {
  double part;
  std::string text;
};

std::vector<Label> labels_of(const ScalarBar& bar, int wanted) {
  std::vector<Label> labels;
  const auto n = static_cast<double>(bar.categories.size());
  for (std::size_t i = 0; i < bar.categories.size(); ++i)
    labels.push_back({(static_cast<double>(i) + 0.5) / n, bar.categories[i]});
  if (!labels.empty()) return labels;
  for (const Tick& tick : ticks(bar.low, bar.high, wanted, bar.logarithmic))
    labels.push_back({part_of(bar, tick.value), tick.label});
  return labels;
}

/// A bar that runs up or to the right. `at(along, across)`: px from its low end and from the edge
/// without labels.
struct BarFrame {
  bool upright;
  double x, y, length, thickness;

  [[nodiscard]] Vec2 at(double along, double across) const {
    return upright ? Vec2{static_cast<float>(x + across), static_cast<float>(y - along)}
                   : Vec2{static_cast<float>(x + along), static_cast<float>(y + across)};
  }
};

void add_polygon(Path& path, const BarFrame& f, std::initializer_list<Vec2> along_across) {
  bool first = true;
  for (const Vec2 p : along_across) {
    const Vec2 q = f.at(p.x, p.y);
    if (first)
      path.move_to(q.x, q.y);
    else
      path.line_to(q.x, q.y);
    first = false;
  }
}

/// From `low_end` px before the low end to `high_end` px after the high one; an end is pointed
/// unless its length is 0.
void add_outline(Path& path, const BarFrame& f, double low_end, double high_end, double wider) {
  const auto l = static_cast<float>(f.length), t = static_cast<float>(f.thickness),
             w = static_cast<float>(wider), a = static_cast<float>(low_end),
             b = static_cast<float>(high_end);
  add_polygon(
      path, f,
      {{-w, -w}, {-w - a, t / 2}, {-w, t + w}, {l + w, t + w}, {l + w + b, t / 2}, {l + w, -w}});
}

}  // namespace

ScalarBar scalar_bar(const ScalarMapping& mapping, const ScalarColors& colors) {
  const FloatScope floats;
  ScalarBar bar;
  bar.colors = colors.colors();
  bar.discrete = colors.is_discrete();
  bar.low = colors.range().low;
  bar.high = colors.range().high;
  bar.logarithmic = mapping.logarithmic && mapping.categories.empty();
  if (mapping.categories.empty()) {
    bar.below = mapping.below;
    bar.above = mapping.above;
  }
  for (const double category : mapping.categories) {
    const auto numbers = ticks(category, category, 1);
    bar.categories.push_back(numbers.empty() ? number_text(category) : numbers.front().label);
  }
  return bar;
}

void draw_scalar_bar(const Canvas& canvas, const ScalarBar& bar, const Look& look) {
  const FloatScope floats;
  check(bar);
  check(canvas);
  const Measures m = measures_of(canvas, look);
  const double width = canvas.width(), height = canvas.height();
  const bool upright = bar.side == Side::right || bar.side == Side::left;
  const double length =
      std::nearbyint(upright ? height * 0.55 : std::min(width * 0.55, height * 1.1));
  const double thickness = std::nearbyint(m.letter * 1.1), tip = thickness * 0.8;
  const double low_tip = bar.below ? tip : 0, high_tip = bar.above ? tip : 0;
  std::vector<Label> labels =
      labels_of(bar, static_cast<int>(length / (m.letter * (upright ? 3 : 6))));
  double widest = bar.nan ? measure_text("NaN", m.letter).width_px : 0;
  for (const Label& label : labels)
    widest = std::max(widest, measure_text(label.text, m.letter).width_px);
  const double tick = bar.categories.empty() ? m.letter * 0.35 : 0, gap = tick + m.letter * 0.35;
  std::string title = bar.title;
  if (!bar.unit.empty()) title += title.empty() ? bar.unit : " (" + bar.unit + ")";

  BarFrame f{upright, 0, 0, length, thickness};
  const double capital = measure_text("0", m.letter).height_px;
  if (upright) {
    f.x = bar.side == Side::right ? width - m.margin - widest - gap - thickness : m.margin;
    f.y = (height + length) / 2;
  } else {
    f.x = (width - length) / 2;
    const double title_height = title.empty() ? 0 : capital + m.letter * 0.6;
    f.y = bar.side == Side::bottom ? height - m.margin - capital - gap - thickness
                                   : m.margin + title_height;
  }
  f.x = std::nearbyint(f.x);
  f.y = std::nearbyint(f.y);

  if (look.halo.a != 0) {
    Path behind;
    add_outline(behind, f, low_tip, high_tip, m.line + m.halo);
    fill(canvas, behind, look.halo);
  }
  Path frame;
  add_outline(frame, f, low_tip, high_tip, m.line);
  fill(canvas, frame, look.color);
  // The colours, one pixel of length at a time. The rest of the frame is its line.
  const auto whole = static_cast<int>(length);
  for (int i = 0; i < whole; ++i) {
    Path slice;
    const auto a = static_cast<float>(i), b = static_cast<float>(i + 1),
               t = static_cast<float>(thickness);
    add_polygon(slice, f, {{a, 0}, {a, t}, {b, t}, {b, 0}});
    fill_opaque(canvas, slice, color_at(bar, (i + 0.5) / length));
  }
  const auto add_tip = [&](double from, double to, Vec4 color) {
    Path path;
    const auto a = static_cast<float>(from), b = static_cast<float>(to),
               t = static_cast<float>(thickness);
    add_polygon(path, f, {{a, 0}, {b, t / 2}, {a, t}});
    fill_opaque(canvas, path, color);
  };
  if (bar.below) add_tip(-m.line, -low_tip, *bar.below);
  if (bar.above) add_tip(length + m.line, length + high_tip, *bar.above);

  TextStyle style = letters(m, look);
  style.align_x = upright ? AlignX::left : AlignX::center;
  style.align_y = upright ? AlignY::middle : AlignY::top;
  for (const Label& label : labels) {
    const double along = label.part * length;
    if (tick > 0)
      fill_with_halo(canvas, m, look, look.color, [&](Path& path, double wider) {
        const Vec2 from = f.at(along, thickness + m.line),
                   to = f.at(along, thickness + tick + wider / 2);
        path.add_line(from.x, from.y, to.x, to.y, m.line + wider);
      });
    const Vec2 at = f.at(along, thickness + gap);
    draw_text(canvas, at.x, at.y, label.text, style);
  }
  if (bar.nan) {
    const double x = upright ? f.x : f.x + length + high_tip + 2.5 * m.letter,
                 y = upright ? f.y + low_tip + m.letter : f.y;
    Path border, inner;
    border.add_rectangle(x - m.line, y - m.line, x + thickness + m.line, y + thickness + m.line);
    fill(canvas, border, look.color);
    inner.add_rectangle(x, y, x + thickness, y + thickness);
    fill_opaque(canvas, inner, *bar.nan);
    draw_text(canvas, x + (upright ? thickness + gap : thickness / 2),
              y + (upright ? thickness / 2 : thickness + gap), "NaN", style);
  }
  if (title.empty()) return;
  style.align_y = AlignY::bottom;
  if (upright) {
    style.align_x = bar.side == Side::right ? AlignX::right : AlignX::left;
    draw_text(canvas, bar.side == Side::right ? width - m.margin : m.margin,
              f.y - length - high_tip - m.letter * 0.9, title, style);
  } else {
    style.align_x = AlignX::center;
    draw_text(canvas, f.x + length / 2, f.y - m.letter * 0.6, title, style);
  }
}

}  // namespace rastrum::overlay
