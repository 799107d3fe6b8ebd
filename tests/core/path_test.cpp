// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/path.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>

#include <gtest/gtest.h>

namespace rastrum::test {
namespace {

std::string text_of(PathView path) {
  return std::string(path.text());
}

TEST(PathView, IsMadeOfWhatNamesAFile) {
  const std::string text = "folder/wing.ply";
  const std::filesystem::path path = text;
  EXPECT_EQ(text_of("folder/wing.ply"), text);
  EXPECT_EQ(text_of(text), text);
  EXPECT_EQ(text_of(std::string_view(text)), text);
  EXPECT_EQ(text_of(path), text);
  EXPECT_EQ(text_of(path.parent_path() / "wing.ply"), text);
  const char* const pointer = text.c_str();
  EXPECT_EQ(text_of(pointer), text);
  const PathView copy = path;
  EXPECT_EQ(copy.text().data(), path.native().data()) << "nothing is copied";
}

TEST(PathView, KeepsZerosInside) {
  const std::string name("a\0b", 3);
  EXPECT_EQ(text_of(name), name);
  EXPECT_EQ(text_of(std::filesystem::path(name)), name);
}

static_assert(!std::is_convertible_v<int, PathView> && !std::is_convertible_v<void*, PathView>);

}  // namespace
}  // namespace rastrum::test
