// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/color.hpp>

#include <algorithm>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

namespace rastrum::test::color_test {
namespace {

TEST(ColorOf, AsPeopleWriteThem) {
  for (const char* white :
       {"#ffffff", "ffffff", "#fff", "fff", "FFF", "#ffff", "ffffffff", "white", "White"})
    EXPECT_EQ(color_of(white), (Rgba8{255, 255, 255, 255})) << white;
  EXPECT_EQ(color_of("#1a2"), (Rgba8{0x11, 0xAA, 0x22, 255}));
  EXPECT_EQ(color_of("1a28"), (Rgba8{0x11, 0xAA, 0x22, 0x88}));
  EXPECT_EQ(color_of("#0033FF80"), (Rgba8{0, 0x33, 0xFF, 0x80}));
  EXPECT_EQ(color_of("transparent"), (Rgba8{0, 0, 0, 0}));
  for (const char* wrong : {"", "#", "#white", "#12345", "1", "ff", "#gggggg", "+1+2+3", "bluee",
                            "#transparent", "#-1-2-3", "#fffffffff"})
    EXPECT_EQ(color_of(wrong), std::nullopt) << wrong;
}

TEST(ColorOf, NamesOfCss) {
  const auto names = color_names();
  EXPECT_EQ(names.size(), 148U);
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  std::uint32_t sum = 0;  // a checksum: previous sum · 31 + 0xRRGGBB
  for (const std::string_view name : names) {
    const auto color = color_of(name);
    ASSERT_TRUE(color) << name;
    EXPECT_EQ(color->a, 255) << name;
    sum = 31 * sum + (std::uint32_t{color->r} << 16 | std::uint32_t{color->g} << 8 | color->b);
    // Both spellings are one colour.
    if (const std::size_t at = name.find("gray"); at != std::string_view::npos) {
      EXPECT_EQ(color_of(std::string(name).replace(at, 4, "grey")), color) << name;
    }
  }
  EXPECT_EQ(sum, 0xD3ADCCD4U);  // the checksum of matplotlib's CSS4_COLORS
  EXPECT_EQ(color_of("blue"), (Rgba8{0, 0, 0xFF, 255}));
  EXPECT_EQ(color_of("aliceblue"), (Rgba8{0xF0, 0xF8, 0xFF, 255}));      // the first,
  EXPECT_EQ(color_of("yellowgreen"), (Rgba8{0x9A, 0xCD, 0x32, 255}));    // the last,
  EXPECT_EQ(color_of("rebeccapurple"), (Rgba8{0x66, 0x33, 0x99, 255}));  // and the newest
}

}  // namespace
}  // namespace rastrum::test::color_test
