// SPDX-License-Identifier: BSD-3-Clause
// A terrain's surroundings and the things on it, under the same lights: checked by the rays of its
// pictures and against the scene's own picture, with the same bits on every backend.
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/digest.hpp>
#include <rastrum/on_terrain.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/transform.hpp>

#include "tests/support/every_way.hpp"
#include "tests/support/golden.hpp"
#include "tests/support/ground.hpp"
#include "tests/support/light_oracle.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::on_ground_test {
namespace {

using namespace ground;
using namespace light_oracle;

struct Sky {
  terrain::TerrainOptions options{.width = 90, .height = 60, .distance = 60};
  terrain::TerrainCamera camera{24, 30, 20, 0.6, 30, 0};
  Image<Rgba8> color;
  Image<float> depth;

  terrain::TerrainTargets draw_ground() {
    color = Image<Rgba8>(options.width, options.height);
    depth = Image<float>(options.width, options.height);
    const terrain::TerrainTargets targets{.color8 = color, .depth = depth};
    const terrain::Terrain ground(hills());
    terrain::TerrainRenderer({.threads = 1}).render(ground, camera, options, targets);
    return targets;
  }
  void draw(std::span<const Light> lights, const ToneMapping& tone = {}, int threads = 0) {
    const terrain::TerrainTargets targets = draw_ground();
    before = color;
    draw_environment_behind(lights, tone, options, camera, targets, threads);
  }
  Image<Rgba8> before;
};

/// The direction of a pixel's ray by docs/terrain_rules.md.
Vec3d direction_of(const terrain::TerrainOptions& o, const terrain::TerrainCamera& c, int x,
                   int y) {
  const double dx = x + 0.5 - o.width / 2.0, dy = y + 0.5 - o.height / 2.0;
  const double u = dx * std::cos(c.roll_rad) - dy * std::sin(c.roll_rad);
  const double v = dx * std::sin(c.roll_rad) + dy * std::cos(c.roll_rad) + o.height / 2.0;
  const bool planar = o.projection == terrain::Projection::planar;
  const double half = planar ? std::tan(o.fov_rad / 2) : o.fov_rad / 2;
  double right = u * 2 / o.width * half, ahead = 1;
  if (!planar) {
    ahead = std::cos(right);
    right = std::sin(right);
  }
  const double scale = o.width / 2.0 / half;
  const double sin = std::sin(c.angle_rad), cos = std::cos(c.angle_rad);
  return unit({cos * right - sin * ahead, (c.horizon_px - v) / scale, -sin * right - cos * ahead});
}

TEST(TerrainSky, IsTheEnvironmentWhereNoGroundIs) {
  const std::vector<Light> lights{light(EnvironmentLight{directions<128>()})};
  for (const bool cylinder : {false, true})
    for (const double roll : {0.0, 0.5}) {
      SCOPED_TRACE(std::to_string(cylinder) + ", " + std::to_string(roll));
      Sky sky;
      sky.camera.roll_rad = roll;
      if (cylinder) {
        sky.options.projection = terrain::Projection::cylindrical;
        sky.options.fov_rad = 5;
      }
      sky.draw(lights);
      int seen = 0;
      double worst = 0;
      for (const auto& [x, y] : pixels(sky.options.width, sky.options.height)) {
        const Rgba8 c = sky.color(x, y);
        if (std::isfinite(sky.depth(x, y))) {
          ASSERT_EQ(c, sky.before(x, y));
          continue;
        }
        ++seen;
        const Vec3d d = direction_of(sky.options, sky.camera, x, y);
        const double want[3] = {0.5 + 0.5 * d.x, 0.5 + 0.5 * d.y, 0.5 + 0.5 * d.z};
        const int got[3] = {c.r, c.g, c.b};
        for (int i = 0; i < 3; ++i)
          worst = std::max(worst, std::abs(got[i] - 255 * display(want[i])));
        ASSERT_EQ(c.a, 255);
      }
      EXPECT_GT(seen, 1000);
      EXPECT_LE(worst, 2.5);  // between the texels of an octahedral map
    }
}

TEST(TerrainSky, IsTheSameBitsOnManyThreadsAndTakesTheTone) {
  std::vector<Light> lights{light(EnvironmentLight{blue_sky()}, 2)};
  lights.push_back(light(AmbientLight{}));
  Sky one, many, mapped;
  one.camera.roll_rad = many.camera.roll_rad = mapped.camera.roll_rad = 0.2;
  one.draw(lights, {}, 1);
  many.draw(lights, {}, 3);
  EXPECT_TRUE(digest(one.color) == digest(many.color));
  EXPECT_TRUE(matches_golden("ground/sky", digest(one.color)));
  mapped.draw(lights, {Tone::neutral, 1});
  EXPECT_FALSE(digest(one.color) == digest(mapped.color));
  EXPECT_TRUE(matches_golden("ground/sky_mapped", digest(mapped.color)));
}

TEST(TerrainSky, HasAColourAtTheHorizon) {
  const std::vector<Light> lights{light(EnvironmentLight{directions()})};
  const Rgba8 c = horizon_color(lights, {});
  const int middle = static_cast<int>(std::lround(255 * display(0.5)));
  for (const int channel : {c.r, c.g, c.b}) EXPECT_NEAR(channel, middle, 1);
  Light turned = lights[0];
  turned.intensity = 0.5F;
  EXPECT_NEAR(horizon_color({&turned, 1}, {}).g, 255 * display(0.25), 1);
}

TEST(TerrainSky, IsRefusedWithoutAnEnvironmentOrADepth) {
  Sky sky;
  const std::vector<Light> none{light(AmbientLight{})};
  expect_refused("no environment", [&] { sky.draw(none); });
  expect_refused("no environment", [&] { static_cast<void>(horizon_color(none, {})); });
  const std::vector<Light> lights{light(EnvironmentLight{directions()})};
  Image<Rgba8> color(90, 60);
  expect_refused("depth", [&] {
    draw_environment_behind(lights, {}, sky.options, sky.camera, {.color8 = color});
  });
  expect_refused("the tone", [&] { sky.draw(lights, {static_cast<Tone>(9)}); });
  Image<float> small(20, 20);
  expect_refused("the depth target", [&] {
    draw_environment_behind(lights, {}, sky.options, sky.camera, {.color8 = color, .depth = small});
  });
}

// --- What stands on it --------------------------------------------------------------------------

struct Standing {
  Scene scene;
  FrameOptions frame;
  Sky sky;

  explicit Standing(float opacity = 1, const Environment& around = directions()) {
    scene = single(shapes::sphere(12, 16));
    scene.instances[0].object_to_world = translation({14, 18, 14}) * scaling({4, 4, 4});
    Material matt{.base_color = {0.8F, 0.5F, 0.2F, opacity},
                  .metallic = 0,
                  .roughness = 1,
                  .alpha_mode = opacity < 1 ? AlphaMode::blend : AlphaMode::opaque};
    scene.materials.push_back(matt);
    frame.width = sky.options.width;
    frame.height = sky.options.height;
    frame.shader = Shader::material;
    frame.lights = {light(EnvironmentLight{around}), light(DirectionalLight{{-1, -1, -0.3F}}, 3)};
    frame.tone = {Tone::reinhard, 0};
    frame.environment_behind = true;
  }
  Image<Rgba8> draw(RendererOptions how = {.threads = 1}) {
    const terrain::TerrainTargets targets = sky.draw_ground();
    ground_depth = sky.depth;
    const SceneBinding binding(scene);
    SceneOnTerrain(Renderer(how))
        .draw({.scene = binding.view()}, frame, sky.options, sky.camera, targets);
    return sky.color;
  }
  Image<float> ground_depth;
};

TEST(OnTerrainLights, AreThoseOfTheScenePictureByItself) {
  Standing on;
  const Image<Rgba8> color = on.draw();
  Camera view;
  view.matrix = terrain::world_to_clip(on.sky.options, on.sky.camera, SceneOnTerrain::kNear);
  const Frame alone =
      draw(RendererOptions{}, SceneBinding(on.scene).view(), view, on.frame, kColor8 | kDepth);
  on.sky.draw(on.frame.lights, on.frame.tone);
  int ball = 0, sky = 0, ground = 0;
  for (const auto& [x, y] : pixels(on.frame.width, on.frame.height)) {
    const float of_ground = terrain::reversed_depth(on.ground_depth(x, y), SceneOnTerrain::kNear);
    const bool is_ball = alone.depth(x, y) > of_ground;
    (is_ball ? ball : of_ground == 0 ? sky : ground) += 1;
    ASSERT_EQ(color(x, y), is_ball ? alone.color8(x, y) : on.sky.color(x, y)) << x << ", " << y;
  }
  EXPECT_GT(ball, 100);
  EXPECT_GT(sky, 500);
  EXPECT_GT(ground, 500);
}

TEST(OnTerrainLights, BlendMappedLightOverTheGround) {
  Standing solid(1, directions<128>()), glass(0.25F, directions<128>());
  solid.frame.cull = glass.frame.cull = Cull::back;
  const Image<Rgba8> opaque = solid.draw(), blended = glass.draw();
  solid.sky.draw(solid.frame.lights, solid.frame.tone);
  int seen = 0;
  for (const auto& [x, y] : pixels(solid.frame.width, solid.frame.height)) {
    const Rgba8 front = opaque(x, y), behind = solid.sky.color(x, y);
    if (front == behind) continue;
    ++seen;
    ASSERT_NEAR(blended(x, y).r, 0.25 * front.r + 0.75 * behind.r, 1.01);
    ASSERT_NEAR(blended(x, y).g, 0.25 * front.g + 0.75 * behind.g, 1.01);
  }
  EXPECT_GT(seen, 100);
  EXPECT_TRUE(matches_golden("ground/glass", digest(blended)));
}

TEST(OnTerrainLights, AreTheSameBitsWhateverDraws) {
  for (const float opacity : {1.0F, 0.5F}) {
    Standing on(opacity);
    on.frame.shadows = true;
    EveryWay().same([&](const RendererOptions& by) { return digest(on.draw(by)); });
  }
}

TEST(OnTerrainLights, RefuseTonesOfOtherShaders) {
  Standing on;
  on.frame.shader = Shader::phong;
  expect_refused("'material'", [&] { static_cast<void>(on.draw()); });
  on.frame.tone = {};
  EXPECT_NO_THROW(static_cast<void>(on.draw()));
  on.frame.lights = {light(AmbientLight{})};
  expect_refused("no environment", [&] { static_cast<void>(on.draw()); });
}

TEST(TerrainBounds, AreOfMapsAndUnits) {
  Sky sky;
  Image<Rgba8> color(90, 60);
  const terrain::TerrainTargets picture{.color8 = color};
  const terrain::Terrain map(hills());
  const auto box_around = [&](const terrain::Terrain& of, double unit) {
    draw_terrain_bounds(of, unit, sky.options, sky.camera, picture);
  };
  box_around(map, 1);
  EXPECT_GT(std::ranges::count_if(color.pixels(), [](Rgba8 c) { return c.a != 0; }), 50);
  expect_refused("no ends", [&] {
    box_around(terrain::Terrain::of([](double, double) { return 1.0F; },
                                    [](double, double) { return Rgba8{}; }),
               1);
  });
  expect_refused("some cells high", [&] { box_around(map, 0); });
  sky.options.projection = terrain::Projection::cylindrical;
  expect_refused("cylindrical", [&] { box_around(map, 1); });
  expect_refused("cylindrical", [&] { draw_terrain_axes(sky.options, sky.camera, picture); });
}

TEST(GroundAnnotations, AreTheirPartsInOrder) {
  Sky sky;
  const terrain::Terrain map(hills());
  const ScalarMapping mapping{.map = color_map("plasma"), .range = ScalarRange{0, 9}};
  const ScalarColors colors(mapping, {});
  const GroundNumbers numbers{0.5, &mapping, &colors};
  Annotations all{.bounds = true,
                  .axes = true,
                  .bar = BarWords{"Height", "m", true},
                  .title = "Hills",
                  .captions = {"here"},
                  .text_scale = 0.6};
  Image<Rgba8> together(160, 120), apart(160, 120);
  sky.options.width = 160;
  sky.options.height = 120;
  draw_ground_annotations(all, map, numbers, sky.options, sky.camera, {.color8 = together});
  const overlay::Look look = look_of(all, {});
  draw_terrain_bounds(map, 0.5, sky.options, sky.camera, {.color8 = apart}, look);
  draw_terrain_axes(sky.options, sky.camera, {.color8 = apart}, overlay::Corner::bottom_left, look);
  overlay::ScalarBar bar = overlay::scalar_bar(mapping, colors);
  bar.title = "Height";
  bar.unit = "m";
  bar.nan = mapping.nan;
  overlay::draw_scalar_bar({.color8 = apart}, bar, look);
  draw_words(all, {.color8 = apart}, look);
  EXPECT_TRUE(digest(together) == digest(apart));
  EXPECT_FALSE(digest(together) == digest(Image<Rgba8>(160, 120)));
}

TEST(GroundAnnotations, RefuseWhatIsOfMeshes) {
  const auto refused = [](const char* part, const Annotations& a) {
    expect_refused(part, [&] { check_ground_annotations(a, {}); });
  };
  refused("occlusion", {.occlusion = AmbientOcclusion{}});
  refused("dome", {.dome = EyeDome{}});
  refused("silhouettes", {.silhouettes = Silhouettes{}});
  refused("edges", {.edges = EdgeLines{}});
  refused("as numbers", {.bar = BarWords{}});
  refused("four captions", {.captions = std::vector<std::string>(5)});
  EXPECT_NO_THROW(check_ground_annotations({.bounds = true, .axes = true, .title = "T"}, {}));
}

}  // namespace
}  // namespace rastrum::test::on_ground_test
