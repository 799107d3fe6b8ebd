// SPDX-License-Identifier: BSD-3-Clause
// Text: glyphs equal the font's outlines, their places, missing glyphs, and golden digests.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/digest.hpp>
#include <rastrum/overlay.hpp>
#include <rastrum/overlay/font/font.hpp>

#include "tests/support/golden.hpp"

namespace rastrum::text_test {
namespace {

using overlay::AlignX;
using overlay::AlignY;
using overlay::TextStyle;

struct Box {
  int left = 1 << 30, top = 1 << 30, right = -1, bottom = -1;
};

Box drawn_box(const Image<Rgba8>& picture) {
  Box box;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x)
      if (picture(x, y).a != 0)
        box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x),
               std::max(box.bottom, y)};
  return box;
}

Image<Rgba8> drawn(const std::string& text, double x, double y, const TextStyle& style,
                   int width = 200, int height = 200) {
  Image<Rgba8> picture(width, height);
  overlay::draw_text({.color8 = picture.view()}, x, y, text, style);
  return picture;
}

/// The font's curves: a glyph at 2048 px per em, so that units are pixels, by brute force.
TEST(Text, CoversWhatTheOutlineEncloses) {
  const overlay::Path large = overlay::text_path(0, 0, "g", {.size_px = 2048});
  const overlay::Path small = overlay::text_path(0, 20, "g", {.size_px = 32});
  Image<std::uint8_t> coverage(24, 32);
  overlay::fill(coverage.view(), small);
  // 64 units per pixel: samples the large outline at every 4th unit, 16 across and down.
  const auto inside = [&](double x, double y) {
    int around = 0;
    for (std::size_t p = 0; p < large.begins().size(); ++p) {
      const std::size_t begin = large.begins()[p];
      const std::size_t end =
          p + 1 < large.begins().size() ? large.begins()[p + 1] : large.points().size();
      for (std::size_t i = begin; i < end; ++i) {
        const auto a = large.points()[i], b = large.points()[i + 1 < end ? i + 1 : begin];
        const double ay = a.y / 256.0, by = b.y / 256.0;
        if ((ay <= y) == (by <= y)) continue;
        if (a.x / 256.0 + (y - ay) / (by - ay) * (b.x - a.x) / 256.0 > x)
          around += ay <= y ? 1 : -1;
      }
    }
    return around != 0;
  };
  double sum = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 24; ++x) {
      int covered = 0;
      for (int j = 0; j < 16; ++j)
        for (int i = 0; i < 16; ++i)
          covered += inside((x + (i + 0.5) / 16) * 64, (y - 20 + (j + 0.5) / 16) * 64);
      // The small outline's points are rounded to 1/256 px, its curves within 1/32 px.
      ASSERT_NEAR(coverage(x, y), 255.0 * covered / 256, 14) << x << ", " << y;
      sum += coverage(x, y);
    }
  EXPECT_GT(sum, 255 * 100);
}

TEST(Text, LiesWhereItIsAligned) {
  for (const AlignX x : {AlignX::left, AlignX::center, AlignX::right})
    for (const AlignY y : {AlignY::top, AlignY::middle, AlignY::baseline, AlignY::bottom}) {
      const Box box =
          drawn_box(drawn("HHH", 100, 100, {.size_px = 32, .align_x = x, .align_y = y}));
      const double width = overlay::measure_text("HHH", 32).width_px;
      const double height = overlay::measure_text("HHH", 32).height_px;
      const double left = x == AlignX::left     ? 100
                          : x == AlignX::center ? 100 - width / 2
                                                : 100 - width;
      const double bottom = y == AlignY::top      ? 100 + height
                            : y == AlignY::middle ? 100 + height / 2
                                                  : 100;
      EXPECT_NEAR(box.left, left + 3, 2);  // an H has space at its sides
      EXPECT_NEAR(box.right, left + width - 3, 2);
      EXPECT_NEAR(box.bottom, bottom - 0.5, 1);
      EXPECT_NEAR(box.top, bottom - height, 1);
    }
}

TEST(Text, LinesAreAligned) {
  const auto extent = overlay::measure_text("HHH\nH", 20);
  EXPECT_EQ(extent.width_px, overlay::measure_text("HHH", 20).width_px);
  EXPECT_NEAR(extent.height_px, 20 * (0.729 + 1.164), 0.1);
  const Box box = drawn_box(
      drawn("HHH\nH", 100, 100, {.size_px = 20, .align_x = AlignX::right, .align_y = AlignY::top}));
  EXPECT_NEAR(box.top, 100, 1);
  EXPECT_NEAR(box.bottom, 100 + extent.height_px, 2);
}

TEST(Text, QuartersTurnTheSamePixels) {
  // At a pixel's corner, so that a quarter turn maps pixels to pixels.
  const auto upright = drawn("Rag", 100, 100, {.size_px = 24}),
             turned = drawn("Rag", 100, 100, {.size_px = 24, .quarter_turns = 1}),
             around = drawn("Rag", 100, 100, {.size_px = 24, .quarter_turns = 2});
  for (int y = 60; y < 140; ++y)
    for (int x = 60; x < 140; ++x) {
      // Lines run both down and across, so coverage differs in the last digits.
      ASSERT_NEAR(upright(x, y).a, turned(y, 199 - x).a, 3) << x << ", " << y;
      ASSERT_NEAR(upright(x, y).a, around(199 - x, 199 - y).a, 3) << x << ", " << y;
    }
}

TEST(Text, HalosAreAroundLetters) {
  const auto plain = drawn("i", 100, 100, {.size_px = 40});
  const auto haloed = drawn("i", 100, 100, {.size_px = 40, .halo_px = 3, .halo = {0, 0, 0, 255}});
  const Box inner = drawn_box(plain), outer = drawn_box(haloed);
  EXPECT_NEAR(inner.left - outer.left, 3, 1);
  EXPECT_NEAR(outer.right - inner.right, 3, 1);
  EXPECT_NEAR(outer.bottom - inner.bottom, 3, 1);
  // A half-transparent halo applies once, however many strokes overlap.
  const auto half = drawn("i", 100, 100, {.size_px = 40, .halo_px = 3, .halo = {0, 0, 0, 128}});
  for (const Rgba8 pixel : half.pixels())
    if (pixel.r == 0) {
      EXPECT_LE(pixel.a, 128);
    }
}

TEST(Text, SaysWhatIsMissing) {
  EXPECT_TRUE(
      overlay::missing_glyphs("Speed |v| in m·s⁻¹, 20 °C ± 3 µm, Å, ∞ ≤ ≥ − × ² ³ Ωλ").empty());
  EXPECT_EQ(overlay::missing_glyphs("a漢b漢\n字"), (std::vector<char32_t>{U'漢', U'字'}));
  EXPECT_EQ(overlay::missing_glyphs("\xff"), (std::vector<char32_t>{0xFFFD}));
  // A missing glyph shows as a box.
  EXPECT_GT(drawn_box(drawn("漢", 50, 50, {.size_px = 20})).right, 0);
}

TEST(Text, DecodesUtf8) {
  using overlay::decode_utf8;
  EXPECT_EQ(decode_utf8("aµ€\xF0\x9F\x98\x80"), (std::vector<char32_t>{U'a', U'µ', U'€', 0x1F600}));
  // Overlong, surrogate, beyond the last code point, truncated: each byte is invalid.
  EXPECT_EQ(decode_utf8("\xC0\xAF"), (std::vector<char32_t>{0xFFFD, 0xFFFD}));
  EXPECT_EQ(decode_utf8("\xED\xA0\x80"), (std::vector<char32_t>{0xFFFD, 0xFFFD, 0xFFFD}));
  EXPECT_EQ(decode_utf8("\xF4\x90\x80\x80").size(), 4U);
  EXPECT_EQ(decode_utf8("\xE2\x82"), (std::vector<char32_t>{0xFFFD, 0xFFFD}));
  EXPECT_EQ(decode_utf8("\xC3g"), (std::vector<char32_t>{0xFFFD, U'g'}));
}

TEST(Text, RefusesSizesOutOfRange) {
  Image<Rgba8> picture(8, 8);
  const overlay::Canvas canvas{.color8 = picture.view()};
  for (const double size : {0.0, -1.0, 1e5, std::nan("")})
    EXPECT_THROW(overlay::draw_text(canvas, 0, 0, "a", {.size_px = size}), Error) << size;
  EXPECT_THROW(overlay::draw_text(canvas, 0, 0, "a", {.halo_px = -1}), Error);
  EXPECT_THROW(overlay::draw_text(canvas, std::nan(""), 0, "a"), Error);
}

TEST(Text, IsTheSameBits) {
  std::string all;
  for (char c = ' '; c < 127; ++c) {
    all.push_back(c);
    if (c % 24 == 0) all.push_back('\n');
  }
  all +=
      "\nÀÉîõü ß ÆØ åÅ ¼ £ € µ ± × ÷ ° ² ³\nαβγδεζηθικλμνξοπρστυφχψω\n∞ ≤ ≥ ≠ ≈ √ ∂ ∇ ∑ ∫ − → "
      "10⁻¹²";
  const auto picture =
      drawn(all, 8, 8, {.size_px = 19.5, .halo_px = 1.5, .align_y = AlignY::top}, 420, 230);
  EXPECT_TRUE(test::matches_golden("overlay/text", digest(picture)));
  Image<Vec4> floats(420, 230);
  overlay::draw_text({.color = floats.view()}, 400, 220, all,
                     {.size_px = 11, .align_x = AlignX::right, .align_y = AlignY::bottom});
  EXPECT_TRUE(test::matches_golden("overlay/text_floats", digest(floats)));
}

}  // namespace
}  // namespace rastrum::text_test
