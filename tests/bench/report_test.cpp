// SPDX-License-Identifier: BSD-3-Clause
// Numbers in tables, and JSON files.
#include <bench/report.hpp>

#include <filesystem>
#include <limits>

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>

#include "tests/io/files.hpp"

namespace rastrum::bench::report_test {
namespace {

TEST(Report, SignificantKeepsDigitsAndNoExponent) {
  EXPECT_EQ(significant(0), "0.00");
  EXPECT_EQ(significant(0.0123), "0.0123");
  EXPECT_EQ(significant(3.14159), "3.14");
  EXPECT_EQ(significant(31.4159), "31.4");
  EXPECT_EQ(significant(314.159), "314");
  EXPECT_EQ(significant(31415.9), "31416");
  EXPECT_EQ(significant(99.9985, 6), "99.9985");
  EXPECT_EQ(significant(std::numeric_limits<double>::infinity()), "-");
}

TEST(Report, MachineNamesWhatAFigureNeeds) {
  const nlohmann::json m = machine_json();
  for (const char* key :
       {"cpu", "cores", "memory_gib", "load", "compiler", "commit", "version", "date"})
    EXPECT_TRUE(m.contains(key)) << key;
  EXPECT_FALSE(m["commit"].get<std::string>().empty());
  EXPECT_GE(m["cores"].get<int>(), 1);
}

TEST(Report, JsonIsWholeOrAbsent) {
  const test::TempFolder folder;
  const std::string file = folder.path("x.json").string();
  write_json(file, {{"a", 1}});
  EXPECT_EQ(nlohmann::json::parse(test::slurp(file))["a"], 1);
  EXPECT_FALSE(std::filesystem::exists(file + ".part"));
  EXPECT_THROW(write_json(folder.path("no_such_folder/x.json").string(), {}), Error);
}

}  // namespace
}  // namespace rastrum::bench::report_test
