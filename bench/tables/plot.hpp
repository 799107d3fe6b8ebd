// SPDX-License-Identifier: BSD-3-Clause
// Plots as SVG: panels of lines or bars over shared axes, so that a page of figures can be seen at
// a glance. Fonts are the reader's own; colours are Okabe and Ito's, which colour-blind readers
// tell apart.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace rastrum::bench {

/// Where there is no value.
inline constexpr double kGap = std::numeric_limits<double>::quiet_NaN();
[[nodiscard]] inline double or_gap(double value) {
  return value > 0 ? value : kGap;
}

/// Values at the plot's places; NaN leaves a gap.
struct Series {
  std::string name;
  std::vector<double> values;
  int color = 0;       ///< series of one colour belong together
  bool ghost = false;  ///< drawn pale and dashed: a figure that was not measured here
};

struct Panel {
  std::string title;
  std::vector<Series> series;
};

struct Plot {
  enum class Kind { lines, bars };

  std::string title;
  std::string note;  ///< under the title, e.g. what dashes mean
  std::string x_title, y_title;
  Kind kind = Kind::lines;
  bool log_y = true;
  std::vector<std::string> places;  ///< labels along x
  std::vector<double> x;            ///< where the places lie; empty: equally far apart
  bool log_x = false;               ///< of `x`
  std::vector<Panel> panels;        ///< all share both axes
};

/// The plot as a complete SVG document. A plot without a single finite value says so in words.
/// With log_y values ≤ 0 are gaps.
[[nodiscard]] std::string to_svg(const Plot& plot);

}  // namespace rastrum::bench
