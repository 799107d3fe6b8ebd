// SPDX-License-Identifier: BSD-3-Clause
// SVG: well-formed, complete, and drawn where the axes say.
#include <bench/tables/plot.hpp>

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace rastrum::bench::plot_test {
namespace {

/// Whether all tags are closed in order and the text has no bare & or <.
bool well_formed(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t i = 0; i < xml.size(); ++i) {
    if (xml[i] == '&' && xml.compare(i, 5, "&amp;") != 0 && xml.compare(i, 4, "&lt;") != 0 &&
        xml.compare(i, 4, "&gt;") != 0 && xml.compare(i, 6, "&quot;") != 0)
      return false;
    if (xml[i] != '<') continue;
    const std::size_t end = xml.find('>', i);
    if (end == std::string::npos) return false;
    const std::string tag = xml.substr(i + 1, end - i - 1);
    if (tag.find('<') != std::string::npos) return false;
    const std::string name = tag.substr(0, tag.find_first_of(" /"));
    if (tag[0] == '/') {
      if (open.empty() || open.back() != tag.substr(1)) return false;
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(name);
    }
    i = end;
  }
  return open.empty();
}

int count(const std::string& text, const std::string& what) {
  int n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

/// The values of an attribute of all `tag` elements, in order.
std::vector<double> attributes(const std::string& svg, const std::string& tag,
                               const std::string& name) {
  std::vector<double> values;
  for (std::size_t at = svg.find("<" + tag + " "); at != std::string::npos;
       at = svg.find("<" + tag + " ", at + 1)) {
    const std::size_t value = svg.find(" " + name + "=\"", at);
    values.push_back(std::stod(svg.substr(value + name.size() + 3)));
  }
  return values;
}

Plot lines() {
  Plot plot;
  plot.title = "a < b & \"c\"";
  plot.y_title = "ms";
  plot.places = {"1", "2", "4"};
  plot.panels = {{"one", {{"ours", {1, 10, 100}, 0}, {"theirs", {2, 20, 200}, 1, true}}}};
  return plot;
}

TEST(Plot, IsWellFormedAndEscapes) {
  const std::string svg = to_svg(lines());
  EXPECT_TRUE(well_formed(svg)) << svg;
  EXPECT_NE(svg.find("a &lt; b &amp; &quot;c&quot;"), std::string::npos);
  EXPECT_EQ(svg.find("<svg xmlns"), 0U);
}

TEST(Plot, LogarithmicAxisHasEqualStepsForEqualRatios) {
  const std::vector<double> y = attributes(to_svg(lines()), "circle", "cy");
  ASSERT_EQ(y.size(), 6U);
  EXPECT_GT(y[0], y[1]) << "up is more";
  EXPECT_NEAR(y[0] - y[1], y[1] - y[2], 0.2);
  EXPECT_NEAR(y[0] - y[1], y[3] - y[4], 0.2);
}

TEST(Plot, GapsBreakLinesAndLeaveNoMarks) {
  Plot plot = lines();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  plot.panels[0].series = {{"ours", {1, nan, 3}, 0}, {"zero", {0, 1, 2}, 1}};
  const std::string svg = to_svg(plot);
  EXPECT_EQ(count(svg, "<circle"), 4) << "NaN, and 0 on a logarithmic axis, have no place";
  EXPECT_EQ(count(svg, "<polyline"), 1) << "two lone points are no line";
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(Plot, BarsStandOnTheAxisAndScale) {
  Plot plot = lines();
  plot.kind = Plot::Kind::bars;
  plot.log_y = false;
  plot.panels[0].series = {{"ours", {1, 2, 4}, 0}};
  const std::string svg = to_svg(plot);
  // The page, the legend's square, then the bars. The page's height is a percentage.
  const std::vector<double> y = attributes(svg, "rect", "y"), h = attributes(svg, "rect", "height");
  ASSERT_GE(h.size(), 3U);
  const std::vector<double> bars(h.end() - 3, h.end());
  EXPECT_NEAR(bars[1], 2 * bars[0], 0.2);
  EXPECT_NEAR(bars[2], 4 * bars[0], 0.2);
  for (std::size_t i = 1; i < 3; ++i)
    EXPECT_NEAR(y[y.size() - i] + h[h.size() - i], y[y.size() - 3] + h[h.size() - 3], 0.2);
}

TEST(Plot, NamesEachSeriesOnce) {
  Plot plot = lines();
  plot.panels.push_back(plot.panels[0]);
  const std::string svg = to_svg(plot);
  EXPECT_EQ(count(svg, ">ours<"), 1);
  EXPECT_EQ(count(svg, ">theirs<"), 1);
}

TEST(Plot, PlacesLieWhereTheirNumbersSay) {
  Plot plot = lines();
  plot.x = {1, 10, 100};
  plot.log_x = true;
  std::vector<double> x = attributes(to_svg(plot), "circle", "cx");
  EXPECT_NEAR(x[1] - x[0], x[2] - x[1], 0.2);
  plot.log_x = false;
  x = attributes(to_svg(plot), "circle", "cx");
  EXPECT_NEAR((x[2] - x[1]) / (x[1] - x[0]), 10, 0.1);
}

TEST(Plot, SaysSoWhereNothingWasMeasured) {
  Plot plot = lines();
  plot.panels[0].series = {{"ours", {}, 0}};
  const std::string svg = to_svg(plot);
  EXPECT_TRUE(well_formed(svg));
  EXPECT_NE(svg.find("nothing was measured"), std::string::npos);
  plot.panels.clear();
  plot.places.clear();
  EXPECT_TRUE(well_formed(to_svg(plot)));
}

}  // namespace
}  // namespace rastrum::bench::plot_test
