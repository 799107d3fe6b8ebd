// SPDX-License-Identifier: BSD-3-Clause
// The papers' figures as data: our copy satisfies what the papers say about their tables.
#include <papers/paper1/published.hpp>
#include <papers/paper2/published.hpp>
#include <papers/paper5/published.hpp>

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace rastrum::bench::published_test {
namespace {

template <class Rows>
int figures(const Rows& rows) {
  int n = 0;
  for (const auto& row : rows)
    for (const Published& p : row.figures) n += p.value > 0 ? 1 : 0;
  return n;
}

template <class Rows>
void expect_figures(const Rows& rows, int count) {
  EXPECT_EQ(figures(rows), count);
  std::set<std::string> seen;
  for (const auto& row : rows)
    EXPECT_TRUE(seen.insert(std::string(row.name).append("/").append(row.at)).second)
        << row.name << " " << row.at;
}

TEST(Published, Paper1HasAllItsFigures) {
  expect_figures(paper1::kTable1, 3 * 6);
  expect_figures(paper1::kTable2, 12 * 6);
  expect_figures(paper1::kTable3, 16 * 6);
  expect_figures(paper1::kTable4, 8);
  expect_figures(paper1::kTable5, 4 * 6);
  expect_figures(paper1::kTable6, 8);
  for (const auto& row : paper1::kTable2)
    for (const Published& p : row.figures) EXPECT_GT(p.mb, 0) << row.name;
}

TEST(Published, Paper1GrowsWithTrianglesAndPixels) {
  // Memory does not shrink with a larger share, nor time with a larger picture.
  for (std::size_t r = 0; r < paper1::kTable2.size(); ++r)
    for (std::size_t c = 0; c < 6; ++c)
      if (r % 3 > 0) {
        EXPECT_GE(paper1::kTable2[r].figures[c].mb, paper1::kTable2[r - 1].figures[c].mb);
      }
  for (std::size_t r = 0; r < paper1::kTable3.size(); ++r)
    for (std::size_t c = 0; c < 6; ++c)
      if (r % 4 > 0) {
        EXPECT_GT(paper1::kTable3[r].figures[c].value, paper1::kTable3[r - 1].figures[c].value);
      }
}

TEST(Published, Paper2StagesAddUp) {
  ASSERT_EQ(figures(paper2::kTable), 4 * 3);
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(paper2::kTable[1].figures[c].value + paper2::kTable[2].figures[c].value,
                paper2::kTable[3].figures[c].value, 0.0011);
}

TEST(Published, Paper5AgreesWithItself) {
  expect_figures(paper5::kTable1, 9 * 6);
  EXPECT_EQ(figures(paper5::kTable4), 8 * 7 - 1) << "one failed for memory";
  for (std::size_t r = 0; r < paper5::kScales.size(); ++r)
    EXPECT_EQ(paper5::kTable4[r].at, std::to_string(paper5::kScales[r]));
  // Table 2's CPU time is the average over table 1's CPU lines, but for rounding.
  double seconds = 0;
  for (std::size_t r = 0; r < paper5::kCpuRows; ++r)
    for (const Published& p : paper5::kTable1[r].figures) seconds += 1 / p.value / 12;
  EXPECT_NEAR(seconds, paper5::kTable2[0].cpu_s, 0.005);
  for (const paper5::Speedup& s : paper5::kTable2)
    EXPECT_NEAR(s.cpu_s / s.gpu_s, s.ratio, 0.05 * s.ratio) << s.algorithm;
  for (const paper5::Scaling& s : paper5::kTable3) {
    EXPECT_NEAR(s.cost_core_s, s.threads * s.seconds, 0.008);
    EXPECT_NEAR(s.speedup, paper5::kTable3[0].seconds / s.seconds, 0.05);
  }
  // Section 4.3: 1,798,432 triangles after two subdivisions; 460,398,592 after six.
  EXPECT_EQ(paper5::kBunny.triangles << 4, 1798432U);
  EXPECT_EQ(paper5::kBunny.triangles << 12, 460398592U);
}

}  // namespace
}  // namespace rastrum::bench::published_test
