// SPDX-License-Identifier: BSD-3-Clause
// Smoke tests of the papers' tables: each runs, checks its pictures and writes three readable
// files.
#include <bench/bench.hpp>

#include <filesystem>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "tests/io/files.hpp"

namespace rastrum::bench::tables_test {
namespace {

class Tables : public testing::TestWithParam<const char*> {};

TEST_P(Tables, RunsQuickly) {
  const std::string bench = GetParam();
  const test::TempFolder folder;
  const std::string out = folder.path("").string();
  const std::vector<std::string_view> args{bench, "--quick", "--out", out};
  ASSERT_EQ(run(args), 0);
  const nlohmann::json j = nlohmann::json::parse(test::slurp(folder.path(bench + ".json")));
  EXPECT_EQ(j["benchmark"], bench);
  // The default is in every one of these tables, so there are figures.
  EXPECT_FALSE(j["figures"].empty());
  const std::string text = j["figures"].dump();
  EXPECT_EQ(text.find("WRONG"), std::string::npos);
  EXPECT_GT(std::filesystem::file_size(folder.path(bench + ".md")), 500U);
  EXPECT_GT(std::filesystem::file_size(folder.path(bench + ".svg")), 500U);
}

INSTANTIATE_TEST_SUITE_P(OneAPaper, Tables,
                         testing::Values("paper1-table1", "paper1-table2", "paper1-table4",
                                         "paper2", "paper3", "paper5-table1", "paper5-table3",
                                         "paper5-table4", "auto", "hashed", "hiz", "transparency",
                                         "points", "spheres", "tubes", "instances", "effects",
                                         "terrain", "ranks", "prepared", "stages", "replay",
                                         "samples"),
                         [](const auto& row) {
                           std::string name = row.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace rastrum::bench::tables_test
