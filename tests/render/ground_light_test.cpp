// SPDX-License-Identifier: BSD-3-Clause
// Lights on terrain: against their formulas in float64, against the equivalent sun, and with the
// same bits on every backend; heights as numbers.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/digest.hpp>
#include <rastrum/on_terrain.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain_light.hpp>

#include "tests/support/every_way.hpp"
#include "tests/support/golden.hpp"
#include "tests/support/ground.hpp"
#include "tests/support/light_oracle.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::ground_light_test {
namespace {

using namespace ground;
using namespace light_oracle;
using terrain::HeightMap;
using terrain::ShadowOptions;
using terrain::Tiling;

/// Lights of every kind, alone and together.
std::vector<std::vector<Light>> sets_of_lights() {
  std::vector<std::vector<Light>> sets{
      {light(AmbientLight{}, 0.6F, {1, 0.5F, 0.25F})},
      {light(HemisphereLight{{1, 2, -1}, {0.3F, 0.1F, 0}}, 0.9F, {0.4F, 0.6F, 1})},
      {light(DirectionalLight{{-3, -2, -1}}, 0.9F, {1, 0.9F, 0.8F})},
      {light(PointLight{{20, 16, 24}}, 90)},
      {light(PointLight{{8, 20, 40}, 31}, 200, {0.5F, 1, 0.5F})},
      {light(SpotLight{{30, 25, 10}, {-0.4F, -1, 0.6F}}, 300)},
      {light(SpotLight{{30, 25, 10}, {-0.4F, -1, 0.6F}, 60, 0.2F, 0.4F}, 300, {1, 0, 0.5F})}};
  sets.push_back(all_dimmed(sets));
  return sets;
}

/// The normal of a cell by central differences of its neighbours.
Vec3d normal_at(const HeightMap& map, int x, int y) {
  const auto at = [&](int i, int j) {
    const float h = map.heights(std::clamp(i, 0, kMap - 1), std::clamp(j, 0, kMap - 1));
    return static_cast<double>(std::isfinite(h) ? h : map.heights(x, y));
  };
  return unit({-(at(x + 1, y) - at(x - 1, y)) / 2, 1, -(at(x, y + 1) - at(x, y - 1)) / 2});
}

/// The light that a white matt surface gathers.
Vec3d arriving(const std::vector<Light>& lights, Vec3d p, Vec3d n) {
  Vec3d sum;
  for (const Light& l : lights) {
    if (const auto all_around = around(l, n)) {
      sum = sum + *all_around;
      continue;
    }
    const Arrived in = arrived(l, p);
    sum = sum + in.radiance * std::max(dot(n, in.to_light), 0.0);
  }
  return sum;
}

double reinhard(double x) {
  return x / (1 + x);
}

/// The largest difference of a channel in 8-bit codes; f gives the expected value in [0, 1].
template <class Expected>
double worst_difference(const Image<Rgba8>& lit, const HeightMap& map, const Expected& expected) {
  double worst = 0;
  for (const auto& [x, y] : pixels(kMap, kMap)) {
    if (!std::isfinite(map.heights(x, y))) continue;
    const Vec3d e = expected(x, y);
    const Rgba8 c = lit(x, y);
    for (const auto& [got, want] : {std::pair{c.r, e.x}, {c.g, e.y}, {c.b, e.z}})
      worst = std::max(worst, std::abs(got - 255 * std::clamp(want, 0.0, 1.0)));
  }
  return worst;
}

TEST(GroundLights, AreTheirFormulas) {
  const HeightMap map = hills();
  for (const std::vector<Light>& lights : sets_of_lights()) {
    SCOPED_TRACE(std::to_string(lights.size()) + " of kind " +
                 std::to_string(lights.front().kind.index()));
    const auto light_at = [&](int x, int y) {
      return arriving(lights, {x + 0.5, map.heights(x, y), y + 0.5}, normal_at(map, x, y));
    };
    const auto display_value = [&](int x, int y) {
      const Rgba8 c = map.colors(x, y);
      return times({c.r / 255.0, c.g / 255.0, c.b / 255.0}, light_at(x, y));
    };
    const ShadowOptions clamped{.tiling = Tiling::clamp};
    EXPECT_LE(worst_difference(lit_colors(map, {.lights = lights}, clamped), map, display_value),
              1.0);
    // Tone-mapped, in linear light.
    const auto mapped = [&](int x, int y) {
      const Rgba8 c = map.colors(x, y);
      const Vec3d l =
          times({test::light(c.r), test::light(c.g), test::light(c.b)}, light_at(x, y)) * 2;
      return Vec3d{display(reinhard(l.x)), display(reinhard(l.y)), display(reinhard(l.z))};
    };
    EXPECT_LE(
        worst_difference(lit_colors(map, {.lights = lights, .tone = {Tone::reinhard, 1}}, clamped),
                         map, mapped),
        1.0);
  }
}

/// A directional light from the sun's place.
Light sunlight(const terrain::Sun& sun, float intensity) {
  const double a = sun.azimuth_deg * std::numbers::pi / 180,
               e = sun.elevation_deg * std::numbers::pi / 180;
  return light(DirectionalLight{Vec3(
                   Vec3d{-std::sin(a) * std::cos(e), -std::sin(e), std::cos(a) * std::cos(e)})},
               intensity);
}

int most_different(const Image<Rgba8>& a, const Image<Rgba8>& b) {
  int most = 0;
  for (std::size_t i = 0; i < a.pixels().size(); ++i)
    most = std::max(most, difference(a.pixels()[i], b.pixels()[i]));
  return most;
}

TEST(GroundLights, SayTheSun) {
  HeightMap map = hills();
  map.heights(20, 30) = static_cast<float>(wave(20, 30));
  for (const terrain::Sun sun : {terrain::Sun{315, 35}, {0, 12}, {90, 20}, {200, 8}, {45, 60}}) {
    SCOPED_TRACE(std::to_string(sun.azimuth_deg));
    constexpr float kAmbient = 0.45F;
    const std::vector<Light> lights{light(AmbientLight{}, kAmbient), sunlight(sun, 1 - kAmbient)};
    for (const terrain::Shadows kind : {terrain::Shadows::none, terrain::Shadows::sharp}) {
      terrain::Light said;
      said.sun = sun;
      said.hill_shading = true;
      said.shadows = kind;
      const auto by_sun = lit_colors(map, said);
      const auto by_lights = lit_colors(map, {.lights = lights, .shadows = kind});
      EXPECT_LE(most_different(by_sun, by_lights), 1);
    }
  }
}

TEST(GroundLights, CastTheShadowsOfTerrains) {
  HeightMap map = hills();
  const terrain::Sun sun{250, 30};
  const std::vector<Light> one{sunlight(sun, 1)};
  const auto open = lit_colors(map, {.lights = one});
  const Image<std::uint8_t> dark = terrain::sharp_shadows(map.heights.view(), sun);
  const auto sharp = lit_colors(map, {.lights = one, .shadows = terrain::Shadows::sharp});
  int hidden = 0;
  for (const auto& [x, y] : pixels(kMap, kMap)) {
    hidden += dark(x, y);
    ASSERT_EQ(sharp(x, y), dark(x, y) != 0 ? (Rgba8{0, 0, 0, 255}) : open(x, y)) << x << " " << y;
  }
  EXPECT_GT(hidden, 100);
  EXPECT_LT(hidden, kMap * kMap * 3 / 4);
  // Each light has its own shadow: it is dark where both are hidden, else at most one is missing.
  const terrain::Sun other{70, 30};
  const auto both = lit_colors(
      map, {.lights = {sunlight(sun, 1), sunlight(other, 1)}, .shadows = terrain::Shadows::sharp});
  const Image<std::uint8_t> dark_too = terrain::sharp_shadows(map.heights.view(), other);
  for (const auto& [x, y] : pixels(kMap, kMap))
    if (dark_too(x, y) != 0) {
      ASSERT_EQ(both(x, y), sharp(x, y));
    }
  // Soft and accumulated shadows lie between.
  for (const terrain::Shadows kind : {terrain::Shadows::soft, terrain::Shadows::accumulated}) {
    const auto some = lit_colors(map, {.lights = one, .shadows = kind, .sun_radius_deg = 4});
    int between = 0;
    for (std::size_t i = 0; i < some.pixels().size(); ++i) {
      ASSERT_LE(some.pixels()[i].r, open.pixels()[i].r);
      between += some.pixels()[i].r > 0 && some.pixels()[i].r < open.pixels()[i].r ? 1 : 0;
    }
    EXPECT_GT(between, 50);
  }
}

TEST(GroundLights, AreTheSameBitsWhoeverLights) {
  const HeightMap map = hills();
  GroundLights ground{.lights = sets_of_lights().back(), .shadows = terrain::Shadows::soft};
  const std::vector<Light> kit = light_kit();
  ground.lights.insert(ground.lights.end(), kit.begin(), kit.end());
  ground.lights.push_back(light(EnvironmentLight{blue_sky()}));
  ground.smooth = true;
  ground.camera = {20, 40, 30, 0.4, 20, 0.2};
  for (const ToneMapping tone : {ToneMapping{}, ToneMapping{Tone::aces, 0.5F}}) {
    ground.tone = tone;
    const Digest first = EveryWay().same([&](const RendererOptions& by) {
      return digest(
          lit_colors(map, ground, {.device = by.device, .threads = by.threads, .isa = by.isa}));
    });
    EXPECT_TRUE(matches_golden(tone == ToneMapping{} ? "ground/display" : "ground/mapped", first));
  }
}

TEST(GroundLights, OfTheCameraMoveWithIt) {
  const HeightMap map = hills();
  GroundLights of_camera{.lights = {headlight()}};
  of_camera.camera.angle_rad = 0.7;
  // The camera looks along (−sin a, −cos a) over the map.
  const std::vector<Light> in_world{
      light(DirectionalLight{Vec3(Vec3d{-std::sin(0.7), 0, -std::cos(0.7)})})};
  const auto a = lit_colors(map, of_camera), b = lit_colors(map, {.lights = in_world});
  EXPECT_LE(most_different(a, b), 1);
  // A lamp to the right of and above a viewer who looks north.
  GroundLights lamp{.lights = {light(PointLight{{5, 9, 0}}, 60)}};
  lamp.lights[0].of_camera = true;
  lamp.camera = {20, 30, 4, 0, 0, 0};
  const auto c = lit_colors(map, lamp);
  const auto d = lit_colors(map, {.lights = {light(PointLight{{25, 13, 30}}, 60)}});
  EXPECT_LE(most_different(c, d), 1);
}

TEST(GroundLights, LieBetweenTheCellsOfCoarseMaps) {
  HeightMap map = hills();
  map.heights(20, 30) = 5;
  map.colors = Image<Rgba8>(4 * kMap, 4 * kMap);
  std::ranges::fill(map.colors.pixels(), Rgba8{200, 200, 200, 255});
  const std::vector<Light> one{sunlight({250, 30}, 1)};
  const auto steps = lit_colors(map, {.lights = one});
  const auto smooth = lit_colors(map, {.lights = one, .smooth = true});
  int equal = 0, pairs = 0;
  for (int y = 0; y < 4 * kMap; ++y)
    for (int x = 4; x + 2 < 4 * kMap; x += 4) {
      ASSERT_EQ(steps(x, y), steps(x + 1, y));
      ++pairs;
      equal += smooth(x, y) == smooth(x + 3, y) ? 1 : 0;
    }
  EXPECT_LT(equal, pairs / 2);
}

TEST(GroundLights, LightFunctionsWhereTheyAreSeen) {
  const terrain::HeightFunction function = [](const double* x, const double* y, std::size_t n,
                                              float* out) {
    for (std::size_t i = 0; i < n; ++i) out[i] = static_cast<float>(wave(x[i], y[i]));
  };
  for (const std::vector<Light>& lights : sets_of_lights()) {
    const ScalarMapping grey{.map = color_map("gray"), .range = ScalarRange{0, 20}};
    const terrain::Terrain lit =
        function_terrain(function, 0, 20, {.lights = lights}, ScalarColors(grey, {}));
    double worst = 0;
    for (double y = 1.25; y < 40; y += 3)
      for (double x = 0.5; x < 40; x += 2) {
        const auto h = static_cast<double>(lit.height_at(x, y));
        const Vec3d n = unit(
            {-(wave(x + 1, y) - wave(x - 1, y)) / 2, 1, -(wave(x, y + 1) - wave(x, y - 1)) / 2});
        const Vec3d e = arriving(lights, {x, h, y}, n) * (h / 20);
        const Rgba8 c = lit.color_at(x, y);
        // The colour before the light is rounded to 8 bits too.
        const Vec3d most = arriving(lights, {x, h, y}, n);
        for (const auto& [got, want, of] :
             {std::tuple{c.r, e.x, most.x}, {c.g, e.y, most.y}, {c.b, e.z, most.z}})
          worst = std::max(
              worst, std::abs(got - 255 * std::clamp(want, 0.0, 1.0)) - 0.5 * std::max(of, 1.0));
      }
    EXPECT_LE(worst, 0.6) << lights.front().kind.index();
  }
  // Each directional light has a march of its own: a wall blocks the light behind it.
  const terrain::HeightFunction wall = [](const double* x, const double*, std::size_t n,
                                          float* out) {
    for (std::size_t i = 0; i < n; ++i) out[i] = x[i] > 10 && x[i] < 14 ? 30.0F : 0.0F;
  };
  const GroundLights low{.lights = {sunlight({90, 30}, 1)}, .shadows = terrain::Shadows::sharp};
  const terrain::Terrain shaded = function_terrain(wall, 0, 30, low);
  EXPECT_EQ(shaded.color_at(0, 5), (Rgba8{0, 0, 0, 255})) << "the sun is in the east";
  EXPECT_GT(shaded.color_at(30, 5).r, 10);
}

TEST(GroundLights, ThatCannotBeMeantAreRefused) {
  const HeightMap map = hills();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const auto refused = [&](const char* part, const GroundLights& bad) {
    expect_refused(part, [&] { static_cast<void>(lit_colors(map, bad)); });
    expect_refused(part, [&] {
      static_cast<void>(function_terrain(terrain::named_function("noise"), 0, 160, bad));
    });
  };
  for (const float bad : {-1.0F, kNan, kInf})
    refused("light 1: its intensity",
            {.lights = {light(AmbientLight{}), light(AmbientLight{}, bad)}});
  refused("light 0: its environment has no picture", {.lights = {light(EnvironmentLight{})}});
  refused("257 lights", {.lights = std::vector<Light>(257)});
  refused("the tone", {.tone = {static_cast<Tone>(9)}});
  refused("the exposure", {.tone = {Tone::aces, kNan}});
  refused("shadows", {.shadows = static_cast<terrain::Shadows>(9)});
  const std::vector<Light> one{sunlight({250, 30}, 1)};
  expect_refused("the sun's radius", [&] {
    (void)lit_colors(map, {.lights = one, .shadows = terrain::Shadows::soft, .sun_radius_deg = -1});
  });
  refused("a march", {.lights = one, .shadows = terrain::Shadows::accumulated, .march = {-3, 20}});
  expect_refused("no cell", [&] { static_cast<void>(lit_colors(HeightMap{}, {.lights = one})); });
}

TEST(HeightNumbers, AreMappedWhereTheyLie) {
  HeightMap map = hills();
  const ScalarMapping steps{.map = color_map("viridis"), .range = ScalarRange{0, 50}, .steps = 5};
  const ScalarColors colors(steps, {});
  // One unit of height is a fifth of a cell.
  const auto cells = terrain::colors_of_heights(map.heights.view(), colors, 0.2);
  const auto code = [](float v) { return static_cast<std::uint8_t>(v * 255 + 0.5F); };
  const auto shown = [&](double number) {
    const Vec4 c = colors(number);
    return Rgba8{code(c.x), code(c.y), code(c.z), 255};
  };
  for (const auto& [x, y] : pixels(kMap, kMap))
    ASSERT_EQ(cells(x, y), shown(static_cast<double>(map.heights(x, y)) / 0.2));
  // Finer colours are mapped after the heights are interpolated, so none lies between two steps.
  const auto fine = terrain::colors_of_heights(map.heights.view(), colors, 0.2, 3);
  ASSERT_EQ(fine.width(), 3 * kMap);
  std::vector<Rgba8> all{shown(std::nan(""))};
  for (int i = 0; i < 5; ++i) all.push_back(shown(10 * i + 5));
  for (const Rgba8 c : fine.pixels())
    ASSERT_NE(std::ranges::find(all, c), all.end()) << int{c.r} << " " << int{c.g};
  EXPECT_EQ(fine(3 * 20 + 1, 3 * 30 + 1), all[0]) << "the hole";
  EXPECT_TRUE(digest(terrain::colors_of_heights(map.heights.view(), colors, 0.2, 0)) ==
              digest(terrain::colors_of_heights(map.heights.view(), colors, 0.2, 4)));
  const auto refused = [&](const char* part, double unit, int finer) {
    expect_refused(part, [&] {
      static_cast<void>(terrain::colors_of_heights(map.heights.view(), colors, unit, finer));
    });
  };
  refused("a unit", 0, 1);
  refused("finer", 1, -1);
  refused("finer", 1, 17);
}

}  // namespace
}  // namespace rastrum::test::ground_light_test
