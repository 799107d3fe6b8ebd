// SPDX-License-Identifier: BSD-3-Clause
// Writes SVG by hand: a dozen shapes need no library. See the header.
#include "plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include <bench/report.hpp>

namespace rastrum::bench {
namespace {

constexpr std::array kColors{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                             "#e69f00", "#56b4e9", "#5b5b5b", "#8a6d00"};
constexpr double kPlotWidth = 960, kMargin = 16;
constexpr double kLeft = 56, kRight = 10, kAbove = 24, kBelow = 40;  ///< around a panel's axes
constexpr double kCharacter = 7.3;  ///< approximate width of a character at 12 px

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  return out;
}

double length_px(const std::string& text) {
  return kCharacter * static_cast<double>(characters(text));
}

const char* color_of(const Series& s) {
  return kColors[static_cast<std::size_t>(s.color) % kColors.size()];
}

template <class... Args>
std::string format(const char* pattern, Args... args) {
  const int length = std::snprintf(nullptr, 0, pattern, args...);
  std::string text(static_cast<std::size_t>(length), '\0');
  std::snprintf(text.data(), text.size() + 1, pattern, args...);
  return text;
}

std::string text_at(double x, double y, const std::string& text, const char* anchor = "middle",
                    const char* more = "") {
  return format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\"%s>", x, y, anchor, more)
      .append(escaped(text))
      .append("</text>\n");
}

std::string line(double x1, double y1, double x2, double y2, const char* style) {
  return format("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" %s/>\n", x1, y1, x2, y2,
                style);
}

/// The range of the values, and the ticks.
struct Axis {
  double low = 0, high = 1;
  bool log = false;
  std::vector<double> ticks;

  /// 0 at the low end, 1 at the high one.
  [[nodiscard]] double at(double v) const {
    return log ? std::log(v / low) / std::log(high / low) : (v - low) / (high - low);
  }
  [[nodiscard]] bool holds(double v) const { return std::isfinite(v) && (!log || v > 0); }
};

/// 1, 2 and 5 times powers of ten within [low, high].
std::vector<double> round_numbers(double low, double high, bool decades_only) {
  std::vector<double> ticks;
  const int first = static_cast<int>(std::floor(std::log10(low)));
  const int last = static_cast<int>(std::ceil(std::log10(high)));
  for (int e = first; e <= last; ++e)
    for (const double m : {1.0, 2.0, 5.0}) {
      const double v = m * std::pow(10.0, e);
      if (decades_only && m > 1) continue;
      if (v >= low * (1 - 1e-9) && v <= high * (1 + 1e-9)) ticks.push_back(v);
    }
  return ticks;
}

Axis value_axis(const Plot& plot) {
  Axis axis;
  axis.log = plot.log_y;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Panel& panel : plot.panels)
    for (const Series& s : panel.series)
      for (const double v : s.values)
        if (axis.holds(v)) {
          low = std::min(low, v);
          high = std::max(high, v);
        }
  if (!(low <= high)) return axis;
  if (axis.log) {
    axis.low = low / 1.4;
    axis.high = high * 1.4;
    axis.ticks = round_numbers(axis.low, axis.high, axis.high / axis.low > 2000);
  } else {
    axis.low = 0;
    axis.high = high > 0 ? high * 1.08 : 1;
    const double rough = axis.high / 5;
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    const double step = power * (rough < 2 * power ? 2 : rough < 5 * power ? 5 : 10);
    for (int i = 0; i * step <= axis.high; ++i) axis.ticks.push_back(i * step);
  }
  return axis;
}

/// The axes of a panel on the page.
struct Frame {
  double x, y, width, height;
  [[nodiscard]] double up(const Axis& axis, double v) const {
    return y + height - height * std::clamp(axis.at(v), 0.0, 1.0);
  }
};

/// The centre of place i, from 0 to 1 across the panel.
double place(const Plot& plot, std::size_t i) {
  const std::size_t n = plot.places.size();
  if (plot.x.size() != n || n < 2)
    return (static_cast<double>(i) + 0.5) / static_cast<double>(std::max<std::size_t>(n, 1));
  const auto on_axis = [&](double v) { return plot.log_x ? std::log(v) : v; };
  const double first = on_axis(plot.x.front()), last = on_axis(plot.x.back());
  return 0.06 + 0.88 * (on_axis(plot.x[i]) - first) / (last - first);
}

std::string draw_axes(const Plot& plot, const Panel& panel, const Axis& axis, const Frame& f) {
  std::string svg =
      text_at(f.x + f.width / 2, f.y - 8, panel.title, "middle", " font-weight=\"bold\"");
  for (const double v : axis.ticks) {
    svg += line(f.x, f.up(axis, v), f.x + f.width, f.up(axis, v), "stroke=\"#e2e2e2\"");
    svg += text_at(f.x - 6, f.up(axis, v) + 4, format("%g", v), "end");
  }
  svg += line(f.x, f.y, f.x, f.y + f.height, "stroke=\"#333\"");
  svg += line(f.x, f.y + f.height, f.x + f.width, f.y + f.height, "stroke=\"#333\"");
  // If neighbouring labels would touch, every second one is left out.
  double widest = 0;
  for (const std::string& label : plot.places) widest = std::max(widest, length_px(label));
  double room = f.width;
  for (std::size_t i = 1; i < plot.places.size(); ++i)
    room = std::min(room, (place(plot, i) - place(plot, i - 1)) * f.width);
  const auto step = static_cast<std::size_t>(std::max(1.0, std::ceil((widest + 6) / room)));
  for (std::size_t i = 0; i < plot.places.size(); i += step)
    svg += text_at(f.x + place(plot, i) * f.width, f.y + f.height + 16, plot.places[i]);
  svg += text_at(f.x + f.width / 2, f.y + f.height + 33, plot.x_title);
  return svg;
}

std::string draw_lines(const Plot& plot, const Panel& panel, const Axis& axis, const Frame& f) {
  std::string svg;
  for (const Series& s : panel.series) {
    std::string points;
    const auto flush = [&] {
      if (points.find(' ') != std::string::npos)
        svg += format("<polyline fill=\"none\" stroke=\"%s\" stroke-width=\"%s\"%s points=\"",
                      color_of(s), s.ghost ? "1.5" : "2",
                      s.ghost ? " stroke-dasharray=\"5 4\" opacity=\"0.75\"" : "")
                   .append(points)
                   .append("\"/>\n");
      points.clear();
    };
    for (std::size_t i = 0; i < std::min(s.values.size(), plot.places.size()); ++i) {
      if (!axis.holds(s.values[i])) {
        flush();
        continue;
      }
      const double x = f.x + place(plot, i) * f.width, y = f.up(axis, s.values[i]);
      points += format("%s%.1f,%.1f", points.empty() ? "" : " ", x, y);
      svg += format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" stroke=\"%s\" fill=\"%s\"/>\n", x, y,
                    color_of(s), s.ghost ? "white" : color_of(s));
    }
    flush();
  }
  return svg;
}

std::string draw_bars(const Plot& plot, const Panel& panel, const Axis& axis, const Frame& f) {
  std::string svg;
  const double group = f.width / static_cast<double>(std::max<std::size_t>(plot.places.size(), 1));
  const double width = 0.8 * group / static_cast<double>(panel.series.size());
  for (std::size_t k = 0; k < panel.series.size(); ++k) {
    const Series& s = panel.series[k];
    for (std::size_t i = 0; i < std::min(s.values.size(), plot.places.size()); ++i) {
      if (!axis.holds(s.values[i])) continue;
      const double x =
          f.x + place(plot, i) * f.width - 0.4 * group + width * static_cast<double>(k);
      const double y = f.up(axis, s.values[i]);
      svg += format(
          "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"%s\" stroke=\"%s\"%s/>"
          "\n",
          x + 0.5, y, width - 1, f.y + f.height - y, color_of(s), color_of(s),
          s.ghost ? " fill-opacity=\"0.25\"" : "");
    }
  }
  return svg;
}

/// Lists each name once, in rows across the page. Returns the height used.
double draw_legend(const Plot& plot, double top, std::string& svg) {
  std::vector<std::string> names;
  double x = kMargin, y = top;
  for (const Panel& panel : plot.panels)
    for (const Series& s : panel.series) {
      if (std::ranges::find(names, s.name) != names.end()) continue;
      names.push_back(s.name);
      // A name is pale only if no panel has it measured.
      const bool ghost = std::ranges::all_of(plot.panels, [&](const Panel& p) {
        return std::ranges::all_of(p.series,
                                   [&](const Series& o) { return o.name != s.name || o.ghost; });
      });
      const double needed = 22 + length_px(s.name) + 18;
      if (x > kMargin && x + needed > kPlotWidth - kMargin) {
        x = kMargin;
        y += 18;
      }
      svg += format(
          "<rect x=\"%.1f\" y=\"%.1f\" width=\"14\" height=\"10\" fill=\"%s\" stroke=\"%s\"%s/>\n",
          x, y - 9, color_of(s), color_of(s), ghost ? " fill-opacity=\"0.25\"" : "");
      svg += text_at(x + 20, y, s.name, "start");
      x += needed;
    }
  return names.empty() ? 0 : y - top + 22;
}

}  // namespace

std::string to_svg(const Plot& plot) {
  const Axis axis = value_axis(plot);
  std::string body = text_at(kMargin, 24, plot.title, "start", " font-size=\"15\"");
  double y = 42;
  if (!plot.note.empty()) {
    body += text_at(kMargin, y, plot.note, "start", " fill=\"#555\"");
    y += 20;
  }
  y += draw_legend(plot, y + 2, body);
  if (axis.ticks.empty()) {
    body += text_at(kPlotWidth / 2, y + 40, "nothing was measured");
    y += 80;
  }
  const std::size_t columns =
      plot.kind == Plot::Kind::bars ? 1 : std::min<std::size_t>(plot.panels.size(), 3);
  const double panel_width =
      (kPlotWidth - 2 * kMargin) / static_cast<double>(std::max(columns, std::size_t{1}));
  const double axes_height = columns == 1 ? 300 : 190;
  const double panel_height = kAbove + axes_height + kBelow;
  for (std::size_t i = 0; i < plot.panels.size() && !axis.ticks.empty(); ++i) {
    const Panel& panel = plot.panels[i];
    const auto column = static_cast<double>(i % columns), row = static_cast<double>(i / columns);
    const Frame f{kMargin + column * panel_width + kLeft, y + row * panel_height + kAbove,
                  panel_width - kLeft - kRight, axes_height};
    body += draw_axes(plot, panel, axis, f);
    if (i % columns == 0) {
      const double middle = f.y + f.height / 2;
      body += format("<g transform=\"rotate(-90 %.1f %.1f)\">", kMargin + 8, middle) +
              text_at(kMargin + 8, middle, plot.y_title) + "</g>\n";
    }
    body += plot.kind == Plot::Kind::bars ? draw_bars(plot, panel, axis, f)
                                          : draw_lines(plot, panel, axis, f);
  }
  if (!axis.ticks.empty())
    y += panel_height * std::ceil(static_cast<double>(plot.panels.size()) /
                                  static_cast<double>(std::max(columns, std::size_t{1})));
  return format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" "
             "viewBox=\"0 0 %.0f %.0f\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\" "
             "font-size=\"12\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
             kPlotWidth, y + kMargin, kPlotWidth, y + kMargin) +
         body + "</svg>\n";
}

}  // namespace rastrum::bench
