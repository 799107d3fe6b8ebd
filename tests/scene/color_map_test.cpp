// SPDX-License-Identifier: BSD-3-Clause
// Colour maps against their published tables, and the mapping of numbers.
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/color_map.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/transform.hpp>

#include "tests/support/random.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::color_map_test {
namespace {

struct PublishedColor {
  int place;
  int r, g, b;  ///< in 65535ths
};
struct Published {
  const char* name;
  int count;
  std::vector<PublishedColor> colors;
};

const std::vector<Published> kPublished = {
#include "tests/scene/color_maps_published.inc"
};

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A map whose entries have these red values, in tenths.
ColorMap tenths(std::initializer_list<int> reds, bool discrete = false) {
  ColorMap map{"tenths", {}, discrete};
  for (const int r : reds) map.colors.push_back({static_cast<float>(r) / 10.0F, 0, 0, 1});
  return map;
}
float red(const ScalarColors& colors, double value) {
  return colors(value).x;
}
void expect_reds(const ScalarColors& colors, std::initializer_list<std::pair<double, float>> reds) {
  for (const auto& [value, expected] : reds) EXPECT_EQ(red(colors, value), expected) << value;
}

TEST(ColorMap, HasThePublishedColours) {
  ASSERT_EQ(kPublished.size(), color_map_names().size());
  int compared = 0;
  for (const Published& p : kPublished) {
    SCOPED_TRACE(p.name);
    const ColorMap map = color_map(p.name);
    const ColorMap reversed = color_map(std::string(p.name) + "_r");
    ASSERT_EQ(map.colors.size(), reversed.colors.size());
    EXPECT_EQ(map.colors.front(), reversed.colors.back());
    for (const PublishedColor& c : p.colors) {
      // At each colour of its table, at even steps or by category, the map has that colour.
      ScalarMapping m{.map = map, .range = ScalarRange{0, static_cast<double>(p.count - 1)}};
      if (map.discrete) {
        ASSERT_EQ(map.colors.size(), static_cast<std::size_t>(p.count));
        m.range = ScalarRange{-0.5, p.count - 0.5};
      }
      const Vec4 got = ScalarColors(m, {})(c.place);
      // To the nearest of 8 bits, and 1/65535 for this table's notation.
      const double within = 0.51 / 255;
      ASSERT_NEAR(got.x, c.r / 65535.0, within) << c.place;
      ASSERT_NEAR(got.y, c.g / 65535.0, within) << c.place;
      ASSERT_NEAR(got.z, c.b / 65535.0, within) << c.place;
      ASSERT_EQ(got.w, 1);
      ++compared;
    }
  }
  EXPECT_GT(compared, 400);
}

TEST(ColorMap, OfAUsersOwnColours) {
  const ColorMap map = color_map_or_list("#ff0000, #00ff0080,#0000FF");
  ASSERT_EQ(map.colors.size(), 3U);
  EXPECT_EQ(map.colors[0], (Vec4{1, 0, 0, 1}));
  EXPECT_EQ(map.colors[1], (Vec4{0, 1, 0, 128.0F / 255}));
  EXPECT_EQ(map.colors[2], (Vec4{0, 0, 1, 1}));
  EXPECT_EQ(color_map_or_list("RdBu").colors, color_map("RdBu").colors);
  expect_refused("'#12' is none", [] { (void)color_map_or_list("#ff0000,#12"); });
  expect_refused("'red' is none", [] { (void)color_map_or_list("#ff0000 red"); });
  expect_refused("RdYlBu", Errc::not_found, [] { (void)color_map("vridis"); });
  expect_refused("did you mean 'viridis'?", Errc::not_found, [] { (void)color_map("vridis"); });
  expect_refused("did you mean 'RdBu_r'?", Errc::not_found, [] { (void)color_map("rdbu_r"); });
  expect_refused("'' (there are", Errc::not_found, [] { (void)color_map(""); });
  expect_refused("viridis_r_r", Errc::not_found, [] { (void)color_map("viridis_r_r"); });
}

TEST(ScalarColors, BlendsBetweenEvenSteps) {
  const ScalarColors c({.map = tenths({0, 4, 10}), .range = ScalarRange{-2, 2}}, {});
  expect_reds(c, {{-2, 0}, {0, 0.4F}, {2, 1}});
  EXPECT_NEAR(red(c, -1), 0.2, 1e-7);
  EXPECT_NEAR(red(c, 1), 0.7, 1e-7);
}

// The formula in exact arithmetic, over generated maps and ranges.
TEST(ScalarColors, AreAFloat64Formula) {
  Random random(17);
  for (int n = 0; n < 20000; ++n) {
    ColorMap map{"own", {}, false};
    const int count = random.integer(1, 6);
    for (int i = 0; i < count; ++i)
      map.colors.push_back({static_cast<float>(random.real(0, 1)), 0, 0, 1});
    const bool log = random.chance(0.4);
    const double low = log ? random.real(1e-4, 10) : random.real(-10, 10);
    const double high = low + random.real(1e-3, 20);
    const ScalarColors c({.map = map, .range = ScalarRange{low, high}, .logarithmic = log}, {});
    const double v = random.real(low, high);
    const long double t = log ? std::log(static_cast<long double>(v) / low) /
                                    std::log(static_cast<long double>(high) / low)
                              : (static_cast<long double>(v) - low) / (high - low);
    const long double at = t * (count - 1);
    const int i = std::min(static_cast<int>(at), std::max(count - 2, 0));
    const long double part = at - i;
    const float a = map.colors[static_cast<std::size_t>(i)].x,
                b = map.colors[static_cast<std::size_t>(std::min(i + 1, count - 1))].x;
    ASSERT_NEAR(red(c, v), static_cast<double>(a + (b - a) * part), 2e-6) << n;
  }
}

TEST(ScalarColors, OfDiscreteSteps) {
  // A boundary belongs to the bin above, except the last one.
  const ScalarColors c({.map = tenths({0, 10}), .range = ScalarRange{0, 4}, .steps = 4}, {});
  ASSERT_EQ(c.colors().size(), 4U);
  EXPECT_TRUE(c.is_discrete());
  const float bins[] = {0, 1.0F / 3, 2.0F / 3, 1};
  for (int i = 0; i < 4; ++i) {
    EXPECT_FLOAT_EQ(red(c, i), bins[i]);
    EXPECT_FLOAT_EQ(red(c, i + 0.999), bins[i]);
  }
  EXPECT_EQ(red(c, 4), 1);
  // A discrete map repeats its colours if there are too few.
  const ScalarColors own({.map = tenths({1, 2, 3}, true), .range = ScalarRange{0, 1}, .steps = 5},
                         {});
  expect_reds(own, {{0.7, 0.1F}, {0.9, 0.2F}});
}

TEST(ScalarColors, OfCategories) {
  const ScalarColors c(
      {.map = tenths({1, 2, 3}, true), .categories = {7, -2, 40, 1000}, .nan = {0, 1, 0, 1}}, {});
  expect_reds(c, {{7, 0.1F}, {-2, 0.2F}, {40, 0.3F}, {1000, 0.1F}});
  for (const double other : {6.999999, 0.0, kNan, kInfinity})
    EXPECT_EQ(c(other), (Vec4{0, 1, 0, 1}));
}

TEST(ScalarColors, BeyondTheRangeAndWhereThereIsNoNumber) {
  ScalarMapping m{.map = tenths({2, 8}), .range = ScalarRange{1, 100}, .logarithmic = true};
  const ScalarColors ends(m, {});
  expect_reds(ends, {{0.5, 0.2F}, {kInfinity, 0.8F}});
  EXPECT_NEAR(red(ends, 10), 0.5, 1e-7);
  m.below = Vec4{0, 0, 1, 1};
  m.above = Vec4{0, 1, 0, 1};
  m.nan = {1, 1, 1, 1};
  const ScalarColors own(m, {});
  for (const double below : {0.5, 0.0}) EXPECT_EQ(own(below), *m.below);
  for (const double above : {100.5, kInfinity}) EXPECT_EQ(own(above), *m.above);
  EXPECT_EQ(own(-1), m.nan);  // it has no logarithm
  EXPECT_EQ(own(kNan), m.nan);
  expect_reds(own, {{1, 0.2F}, {100, 0.8F}});
}

TEST(ScalarColors, OfOneNumberAloneAreTheMiddle) {
  const ScalarColors c({.map = tenths({0, 5, 10})}, {3, 3});
  expect_reds(c, {{3, 0.5F}, {2, 0}, {4, 1}});
}

TEST(ScalarColors, AroundZero) {
  const ScalarColors c({.map = tenths({0, 5, 10}), .symmetric = true}, {-1, 4});
  EXPECT_EQ(c.range(), (ScalarRange{-4, 4}));
  expect_reds(c, {{0, 0.5F}, {4, 1}});
}

TEST(ScalarColors, OpacityByNumber) {
  const ScalarColors c(
      {.map = tenths({0, 10}), .range = ScalarRange{0, 1}, .opacity = {{0.25, 0}, {0.75, 1}}}, {});
  EXPECT_TRUE(c.is_translucent());
  EXPECT_EQ(c(0.1).w, 0);
  EXPECT_NEAR(c(0.5).w, 0.5, 1e-7);
  EXPECT_EQ(c(0.9).w, 1);
  EXPECT_EQ(c(kNan).w, 1);
  EXPECT_FALSE(ScalarColors({}, {}).is_translucent());
  EXPECT_TRUE(ScalarColors({.nan = {0, 0, 0, 0}}, {}).is_translucent());
}

TEST(ScalarColors, RefuseWhatIsNoMapping) {
  const auto refuse = [](const char* part, const ScalarMapping& m) {
    expect_refused(part, [&] { ScalarColors(m, {0, 1}); });
  };
  refuse("map: 'none' has no colours", {.map = {"none", {}, false}});
  refuse("map: a colour is not in [0, 1]", {.map = {"wild", {{2, 0, 0, 1}}, false}});
  refuse("range: upside down", {.range = ScalarRange{1, 0}});
  refuse("range: not finite", {.range = ScalarRange{0, kNan}});
  refuse("range: not finite", {.range = ScalarRange{0, kInfinity}});
  refuse("range: too wide", {.range = ScalarRange{-1.7e308, 1.7e308}});
  refuse("range: must lie above 0", {.range = ScalarRange{0, 1}, .logarithmic = true});
  refuse("logarithmic", {.range = ScalarRange{1, 2}, .logarithmic = true, .symmetric = true});
  refuse("steps: must lie in 0 to 65536, got -1", {.steps = -1});
  refuse("got 2147483647", {.steps = std::numeric_limits<int>::max()});
  refuse("range: too wide for float64: -1.7e+308 to 1.7e+308",
         {.range = ScalarRange{-1.7e308, 1.7e308}});
  refuse("categories[1]: not finite", {.categories = {0, kNan}});
  refuse("categories[2]: is there already", {.categories = {1, 0, 1}});
  refuse("below", {.below = Vec4{0, 0, 0, 2}});
  refuse("above", {.above = Vec4{0, -1, 0, 1}});
  refuse("nan", {.nan = {static_cast<float>(kNan), 0, 0, 1}});
  refuse("opacity[1]: numbers must rise", {.opacity = {{1, 0}, {1, 1}}});
  refuse("opacity[0]", {.opacity = {{0, 1.5F}}});
  refuse("isolines[0]: not finite", {.isolines = {kInfinity}});
  refuse("isoline_px", {.isoline_px = 0});
}

TEST(ScalarView, ReadsEveryTypeAndStride) {
  const std::vector<std::uint8_t> bytes{0, 7, 255};
  const std::vector<std::int64_t> wide{-5, std::int64_t{1} << 52, 3};
  const std::vector<float> floats{0.5F, -1, 2};
  const std::vector<double> doubles{0.1, 1e300, kInfinity};
  EXPECT_EQ(ScalarView(bytes)[2], 255);  // not normalized
  EXPECT_EQ(ScalarView(wide)[1], 4503599627370496.0);
  EXPECT_EQ(ScalarView(wide)[0], -5);
  EXPECT_EQ(ScalarView(floats)[0], 0.5);
  EXPECT_EQ(ScalarView(doubles)[1], 1e300);
  const ScalarView back = ScalarView::of(doubles.data() + 2, 3, -8);
  EXPECT_EQ(back[2], 0.1);
  EXPECT_EQ(ScalarView::of(floats.data(), 9, 0)[8], 0.5);
  const auto buffer = std::as_bytes(std::span(floats));
  EXPECT_EQ(ScalarView::in(buffer, {NumberType::float32, 1, 2, 4, 4})[1], 2);
  expect_refused("array", [&] { (void)ScalarView::in(buffer, {NumberType::float32, 1, 3, 4, 4}); });
  expect_refused("one channel", [&] {
    (void)ScalarView::in(buffer, {NumberType::float32, 2, 1, 0, 8});
  });
}

TEST(FiniteRange, LeavesOutWhatIsNot) {
  const std::vector<double> v{kNan, 3, -kInfinity, -2, 0};
  EXPECT_EQ(finite_range(v), (ScalarRange{-2, 3}));
  EXPECT_EQ(finite_range(v, true), (ScalarRange{3, 3}));
  EXPECT_EQ(finite_range({}), (ScalarRange{0, 0}));
}

Scene two_meshes() {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.scalars.push_back({"heat", {1, 2, kNan}});
  scene.instances.resize(2);
  scene.instances[1].object_to_world = translation({0, 0, 5});
  return scene;
}

TEST(SceneScalars, AreShownByName) {
  Scene scene = two_meshes();
  EXPECT_EQ(scalar_summaries(scene), (std::vector<ScalarSummary>{{"heat", 3, {1, 2}, 1}}));
  show_scalars(scene, "heat");
  scene.scalar_mappings.resize(1);
  const SceneBinding binding(scene);
  EXPECT_EQ(binding.view().instances[1].mesh()->scalars.values.size(), 3U);
  EXPECT_TRUE(shows_scalars(binding.view(), binding.view().instances[0]));
  EXPECT_EQ(scalar_colors(binding.view()).range(), (ScalarRange{1, 2}));
  expect_refused("there are heat, and those of every scene: x, y, z, distance", Errc::not_found,
                 [&] { show_scalars(scene, "cold"); });
  expect_refused("did you mean 'heat'?", Errc::not_found, [&] { show_scalars(scene, "haet"); });
}

TEST(SceneScalars, OfPlacesAreThoseOfEachInstance) {
  Scene scene = two_meshes();
  show_scalars(scene, "z");
  ASSERT_EQ(scene.meshes.size(), 2U);
  const SceneBinding binding(scene);
  EXPECT_EQ(binding.view().instances[0].mesh()->scalars.values[1], 0);
  EXPECT_EQ(binding.view().instances[1].mesh()->scalars.values[1], 5);
  Scene far = two_meshes();
  show_scalars(far, "distance");
  // The middle is (0.5, 0.5, 2.5).
  EXPECT_EQ(SceneBinding(far).view().instances[0].mesh()->scalars.values[0],
            std::sqrt(0.25 + 0.25 + 6.25));
}

}  // namespace
}  // namespace rastrum::test::color_map_test
