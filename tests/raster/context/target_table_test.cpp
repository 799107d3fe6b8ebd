// SPDX-License-Identifier: BSD-3-Clause
// The table of targets has a row for every image, and the pages list the rows.
#include <rastrum/raster/context/target_table.hpp>

#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/directories.hpp"

namespace rastrum::test::target_table_test {
namespace {

std::string page(const char* name) {
  std::ifstream file(golden_dir() / "../../docs" / name);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(TargetTable, HasARowForEachImage) {
  std::size_t rows = 0;
  std::set<std::string_view> names;
  raster::for_each_target([&](const auto& row) {
    ++rows;
    names.insert(row.name);
  });
  EXPECT_EQ(names.size(), rows) << "two rows have one name";
  EXPECT_EQ(sizeof(Targets) - sizeof(Targets::extra), rows * sizeof(ImageView<float>))
      << "an image has no row";
}

TEST(TargetTable, FindsWhatIsAskedFor) {
  Targets targets;
  EXPECT_FALSE(raster::has_target(targets, [](const auto&) { return true; }));
  Vec3 pixel;
  targets.positions = {&pixel, 1, 1};
  EXPECT_TRUE(raster::has_target(targets, [](const auto& row) { return row.name == "positions"; }));
  EXPECT_TRUE(raster::wants_surface(targets));
}

TEST(TargetTable, IsInThePages) {
  const std::string outputs = page("outputs.md"), python = page("python_reference.md");
  const std::string of_c = page("../include/rastrum.h");
  raster::for_each_target([&](const auto& row) {
    const auto has = [](const std::string& text, std::string_view word, const char* quote = "`") {
      return text.find(std::string(quote).append(word).append(quote)) != std::string::npos;
    };
    EXPECT_TRUE(has(outputs, row.name)) << row.name << " in docs/outputs.md";
    EXPECT_TRUE(has(of_c, row.name, "\"")) << row.name << " in include/rastrum.h";
    if (!row.python.empty()) {
      EXPECT_TRUE(has(python, row.python)) << row.python << " in docs/python_reference.md";
    }
  });
}

}  // namespace
}  // namespace rastrum::test::target_table_test
