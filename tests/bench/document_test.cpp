// SPDX-License-Identifier: BSD-3-Clause
// Published tables beside ours: Markdown, JSON, plots, files.
#include <bench/tables/comparison.hpp>

#include <cmath>

#include <sstream>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>

#include "tests/io/files.hpp"

namespace rastrum::bench::document_test {
namespace {

Comparison example() {
  Comparison c{"A table", "ms", "paper", "here", "rasterizer", {"Bunny", "Cat"}, {}};
  c.rows.push_back({"tiled", "25 %", {{5, 9.25}, {}}, {{2.5, 0.01, 1'000'000, 3'000'000}, {}}});
  c.rows.push_back({"tiled", "50 %", {{8.5}, {4}}, {{4}, {.not_run = "absent"}}});
  c.rows.push_back({"auto", "", {}, {{1.25}, {2}}});
  return c;
}

TEST(Document, MarkdownShowsPaperAndOursLineByLine) {
  Document document{"name", "A title"};
  document.notes = {"A note."};
  add(document, example());
  const std::string text = to_markdown(document);
  // Widths follow the longest cell, so runs of blanks and dashes are ignored.
  std::string squeezed;
  for (const char c : text)
    if (!(c == ' ' || c == '-') || squeezed.empty() || squeezed.back() != c) squeezed += c;
  const std::string expected =
      "# A title\n\nA note.\n\nA table\n\n"
      "| rasterizer | Bunny | Cat |\n"
      "|:-|-:|-:|\n"
      "| tiled (25 %) — paper | 5.0 ms, 9.25 MB | — |\n"
      "| · here | 2.50 ms, 3.00 MB (1.00) | |\n"
      "| tiled (50 %) — paper | 8.5 ms | 4.0 ms |\n"
      "| · here | 4.00 ms | not run (absent) |\n"
      "| auto — here | 1.25 ms | 2.00 ms |\n\n";
  EXPECT_EQ(squeezed.substr(0, expected.size()), expected);
}

TEST(Document, MarkdownColumnsAreOfOneWidthAndBarsAreEscaped) {
  Document document{"name", "A title"};
  document.grids.push_back({"", {"a|b", "long column"}, {{"× ²", "1"}, {"only"}}});
  std::istringstream lines(to_markdown(document));
  std::vector<std::string> table;
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("|")) table.push_back(line);
  ASSERT_EQ(table.size(), 4U);
  EXPECT_EQ(table[0], "| a\\|b | long column |");
  EXPECT_EQ(table[1], "|:-----|------------:|");
  EXPECT_EQ(table[2], "| × ²  |           1 |");
  EXPECT_EQ(table[3], "| only |             |");
}

TEST(Document, JsonHoldsEveryFigureOnce) {
  Document document{"name", "A title"};
  add(document, example());
  const nlohmann::json j = to_json(document);
  ASSERT_EQ(j["figures"].size(), 6U);
  const nlohmann::json& first = j["figures"][0];
  EXPECT_EQ(first["row"], "tiled");
  EXPECT_EQ(first["at"], "25 %");
  EXPECT_EQ(first["column"], "Bunny");
  EXPECT_EQ(first["published"]["value"], 5.0);
  EXPECT_EQ(first["published"]["mb"], 9.25);
  EXPECT_EQ(first["here"]["value"], 2.5);
  EXPECT_EQ(first["here"]["all_bytes"], 3'000'000);
  EXPECT_TRUE(j["figures"][1]["published"].is_null()) << "the paper has none";
  EXPECT_EQ(j["figures"][3]["here"]["not_run"], "absent");
  EXPECT_TRUE(j["machine"].contains("cpu"));
}

TEST(Document, LinesHaveAPanelAColumnAndPairsOfSeries) {
  Comparison c = example();
  c.rows.pop_back();
  const Plot plot = lines_of(c, "share");
  EXPECT_EQ(plot.places, (std::vector<std::string>{"25 %", "50 %"}));
  ASSERT_EQ(plot.panels.size(), 2U);
  ASSERT_EQ(plot.panels[0].series.size(), 2U);
  const Series &paper = plot.panels[0].series[0], &ours = plot.panels[0].series[1];
  EXPECT_TRUE(paper.ghost);
  EXPECT_FALSE(ours.ghost);
  EXPECT_EQ(paper.color, ours.color);
  EXPECT_EQ(paper.values, (std::vector<double>{5, 8.5}));
  EXPECT_EQ(ours.values, (std::vector<double>{2.5, 4}));
  EXPECT_TRUE(std::isnan(plot.panels[1].series[1].values[1])) << "not run is a gap";
}

TEST(Document, BarsHaveASeriesARow) {
  const Plot plot = bars_of(example());
  EXPECT_EQ(plot.places, (std::vector<std::string>{"Bunny", "Cat"}));
  ASSERT_EQ(plot.panels.size(), 1U);
  ASSERT_EQ(plot.panels[0].series.size(), 5U);
  EXPECT_EQ(plot.panels[0].series[4].name, "auto");
  EXPECT_EQ(plot.panels[0].series[4].values, (std::vector<double>{1.25, 2}));
}

TEST(Document, PublishWritesThreeFiles) {
  const test::TempFolder temporary;
  const auto folder = temporary.path("deep");
  Document document{"name", "A title"};
  add(document, example());
  document.plot = bars_of(example());
  publish(document, folder.string());
  EXPECT_EQ(nlohmann::json::parse(test::slurp(folder / "name.json"))["benchmark"], "name");
  EXPECT_TRUE(test::slurp(folder / "name.md").starts_with("# A title\n"));
  EXPECT_TRUE(test::slurp(folder / "name.svg").starts_with("<svg "));
  const auto file = temporary.write("file", "in the way");
  EXPECT_THROW(publish(document, (file / "deep").string()), Error);
}

}  // namespace
}  // namespace rastrum::bench::document_test
