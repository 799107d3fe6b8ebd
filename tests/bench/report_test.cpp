// Numbers in tables, JSON on disk.
#include <bench/report.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>

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
  const auto folder = std::filesystem::path(testing::TempDir());
  const std::string file = (folder / "rastrum_report_test.json").string();
  write_json(file, {{"a", 1}});
  std::ifstream in(file);
  EXPECT_EQ(nlohmann::json::parse(in)["a"], 1);
  EXPECT_FALSE(std::filesystem::exists(file + ".part"));
  std::filesystem::remove(file);
  EXPECT_THROW(write_json((folder / "no_such_folder" / "x.json").string(), {}), Error);
}

}  // namespace
}  // namespace rastrum::bench::report_test
