// SPDX-License-Identifier: BSD-3-Clause
// Colours by height, hill shading, and lit colours put together from them.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/terrain/color_map.hpp>
#include <rastrum/terrain_light.hpp>

namespace rastrum::terrain::color_map_test {
namespace {

double lightness(Rgba8 c) {
  const auto linear = [](int v) {
    const double s = v / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  };
  const double y = 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b);
  return y > 216.0 / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389 / 27;
}

TEST(HeightColor, LightnessRisesEvenly) {
  for (int i = 0; i <= 100; ++i) {
    const double l = lightness(height_color(i / 100.0));
    EXPECT_NEAR(l, 30 + 67 * (i / 100.0), 3) << i;
  }
  EXPECT_EQ(height_color(-5), height_color(0));
  EXPECT_EQ(height_color(7), height_color(1));
  EXPECT_EQ(height_color(NAN), height_color(0));
}

TEST(ColorsByHeight, SpanTheRangeAndLeaveHolesBlack) {
  Image<float> map(4, 1);
  map(0, 0) = -10;
  map(1, 0) = 30;
  map(2, 0) = NAN;
  map(3, 0) = 10;
  const Image<Rgba8> c = colors_by_height(map.view());
  EXPECT_EQ(c(0, 0), height_color(0));
  EXPECT_EQ(c(1, 0), height_color(1));
  EXPECT_EQ(c(2, 0), (Rgba8{0, 0, 0, 255}));
  EXPECT_EQ(c(3, 0), height_color(0.5));
}

TEST(HillShade, IsTheCosineToTheSun) {
  const float s45 = static_cast<float>(std::numbers::sqrt2 / 2);
  const auto hill_shade = [](float dx, float dy, const Sun& sun, float ambient) {
    return ToSun::of(sun).shade(dx, dy, ambient);
  };
  EXPECT_NEAR(hill_shade(0, 0, {0, 90}, 0.2F), 1, 1e-6);
  EXPECT_NEAR(hill_shade(0, 0, {0, 45}, 0), s45, 1e-6);
  // Falls to the east by 1 a cell, so it faces an eastern sun at 45° and turns away from a western
  // one.
  EXPECT_NEAR(hill_shade(-1, 0, {90, 45}, 0), 1, 1e-6);
  EXPECT_NEAR(hill_shade(-1, 0, {270, 45}, 0.25F), 0.25F, 1e-6);
  // Falls to the north; y points south.
  EXPECT_NEAR(hill_shade(0, 1, {0, 45}, 0), 1, 1e-6);
  EXPECT_NEAR(hill_shade(0, -1, {180, 45}, 0), 1, 1e-6);
}

HeightMap post() {
  HeightMap map{Image<float>(64, 32), Image<Rgba8>(64, 32)};
  map.heights(50, 16) = 10;
  for (Rgba8& c : map.colors.pixels()) c = {200, 100, 50, 255};
  return map;
}

TEST(LitColors, AccumulatedIsThePapersDarkness) {
  const HeightMap map = post();
  const Light light{.sun = {90, 30}, .shadows = Shadows::accumulated};
  const ShadowOptions options{Tiling::clamp};
  const Image<Rgba8> lit = lit_colors(map, light, options);
  const auto n = hidden_samples(map.heights.view(), light.sun, light.march, options);
  int dark = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x) {
      dark += n(x, y) > 0;
      EXPECT_EQ(lit(x, y).r, std::lround(200 * std::sqrt(1.0 / (1 + n(x, y)))));
    }
  EXPECT_GT(dark, 2);
}

TEST(LitColors, SharpIsAmbientInTheShadowAndTheColourElsewhere) {
  const HeightMap map = post();
  const Light light{.sun = {90, 45}, .shadows = Shadows::sharp, .ambient = 0.5F};
  const Image<Rgba8> lit = lit_colors(map, light, {Tiling::clamp});
  for (int x = 0; x < 64; ++x) EXPECT_EQ(lit(x, 16).r, x >= 40 && x < 50 ? 100 : 200) << x;
}

TEST(LitColors, ColoursOfAnotherSizeAreScaled) {
  HeightMap map = post();
  map.colors = Image<Rgba8>(2, 1);
  map.colors(0, 0) = {255, 0, 0, 0};
  map.colors(1, 0) = {0, 0, 255, 0};
  const Image<Rgba8> coarse = lit_colors(map, {}, {});
  ASSERT_EQ(coarse.width(), 64);
  EXPECT_EQ(coarse(31, 5), (Rgba8{255, 0, 0, 255}));
  EXPECT_EQ(coarse(32, 5), (Rgba8{0, 0, 255, 255}));
  map.colors = Image<Rgba8>(128, 8);
  const Image<Rgba8> fine = lit_colors(map, {}, {});
  EXPECT_EQ(fine.width(), 128);
  EXPECT_EQ(fine.height(), 32);
  EXPECT_THROW((void)lit_colors(map, {.ambient = 2}, {}), Error);
}

// A ramp between cell centres: 0 and 240 on two cells become steps of 30 on eight, also across the
// map's edge.
TEST(LitColors, SmoothOnesLieBetweenCentres) {
  HeightMap map{Image<float>(8, 1), Image<Rgba8>(2, 1)};
  map.colors(1, 0) = {240, 0, 120, 255};
  const auto red = [&](Tiling tiling) {
    const Image<Rgba8> lit = lit_colors(map, {.smooth = true}, {tiling});
    std::vector<int> row;
    for (int x = 0; x < lit.width(); ++x) {
      row.push_back(lit(x, 0).r);
      EXPECT_EQ(lit(x, 0).b, (row.back() + 1) / 2) << x;
    }
    return row;
  };
  EXPECT_EQ(red(Tiling::clamp), (std::vector<int>{0, 0, 30, 90, 150, 210, 240, 240}));
  EXPECT_EQ(red(Tiling::repeat), (std::vector<int>{90, 30, 30, 90, 150, 210, 210, 150}));
  // The light too: cells of one map under colours four times as fine.
  HeightMap fine = post();
  const ShadowOptions clamped{Tiling::clamp};
  Light light{.sun = {90, 45}, .shadows = Shadows::sharp, .ambient = 0.5F};
  const Image<Rgba8> cells = lit_colors(fine, light, clamped);
  fine.colors = Image<Rgba8>(256, 128);
  for (Rgba8& c : fine.colors.pixels()) c = {200, 100, 50, 255};
  light.smooth = true;
  const Image<Rgba8> smooth = lit_colors(fine, light, clamped);
  // The shadow ends at 40, between the centres 39.5 and 40.5, which are texels 158 to 161.
  for (const auto& [x, r] :
       {std::pair(157, 200), {158, 188}, {159, 163}, {160, 138}, {161, 113}, {162, 100}})
    EXPECT_NEAR(smooth(x, 66).r, r, 13) << x;
  EXPECT_GT(smooth(159, 66).r, smooth(160, 66).r);
  light.smooth = true;
  fine.colors = Image<Rgba8>(64, 32);
  for (Rgba8& c : fine.colors.pixels()) c = {200, 100, 50, 255};
  const Image<Rgba8> same = lit_colors(fine, light, clamped);
  for (int x = 0; x < 64; ++x) EXPECT_EQ(same(x, 16), cells(x, 16)) << "equal sizes stay: " << x;
}

}  // namespace
}  // namespace rastrum::terrain::color_map_test
