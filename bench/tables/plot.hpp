// SPDX-License-Identifier: BSD-3-Clause
// Plots as SVG: panels of lines or bars that share their axes. Fonts are the reader's; the colours
// of Okabe and Ito are distinct for colour-blind readers.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace rastrum::bench {

/// A missing value.
inline constexpr double kGap = std::numeric_limits<double>::quiet_NaN();
[[nodiscard]] inline double or_gap(double value) {
  return value > 0 ? value : kGap;
}

/// Values at the plot's places; NaN leaves a gap.
struct Series {
  std::string name;
  std::vector<double> values;
  int color = 0;       ///< series of one colour belong together
  bool ghost = false;  ///< drawn pale and dashed: not measured here
};

struct Panel {
  std::string title;
  std::vector<Series> series;
};

struct Plot {
  enum class Kind { lines, bars };

  std::string title;
  std::string note;  ///< below the title, e.g. what dashes mean
  std::string x_title, y_title;
  Kind kind = Kind::lines;
  bool log_y = true;
  std::vector<std::string> places;  ///< labels along x
  std::vector<double> x;            ///< positions of the places; empty: equally spaced
  bool log_x = false;               ///< of `x`
  std::vector<Panel> panels;        ///< all share both axes
};

/// Makes the plot a complete SVG document, or a text if no value is finite. With log_y, values ≤ 0
/// are gaps.
[[nodiscard]] std::string to_svg(const Plot& plot);

}  // namespace rastrum::bench
