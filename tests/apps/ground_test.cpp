// SPDX-License-Identifier: BSD-3-Clause
// `rastrum terrain` with lights and with heights as numbers: its pictures equal the library's, and
// refusals name a remedy.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/color_map.hpp>
#include <rastrum/environment.hpp>
#include <rastrum/on_terrain.hpp>
#include <rastrum/overlay.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain_light.hpp>

#include "hills.hpp"

#include "tests/support/light_oracle.hpp"
#include "tests/support/painter.hpp"

namespace rastrum::test::ground_test {
namespace {

using light_oracle::light;
using terrain::HeightMap;
using terrain::TerrainCamera;

class TerrainGround : public ProgramOnHills {
 protected:
  void SetUp() override {
    ProgramOnHills::SetUp();
    camera_ = {kMap / 2.0, kMap * (800.0 / 1024), 40, 0, 20, 0};
  }

  /// A colour map or none, and `extra` options.
  [[nodiscard]] Image<Rgba8> drawn_with(const Args& extra, bool painted = true) const {
    const Args map("terrain --height h.png --size 96x64 --altitude 40 --horizon 20");
    return drawn(map + (painted ? "--color c.png" : "") + extra);
  }
  struct Ground {
    Image<Rgba8> color{kWidth, kHeight};
    Image<float> depth{kWidth, kHeight};
    [[nodiscard]] terrain::TerrainTargets targets() { return {.color8 = color, .depth = depth}; }
  };
  [[nodiscard]] Ground ground_under(Image<Rgba8> colors, Rgba8 sky = terrain::kSky) const {
    Ground ground;
    TerrainLook look = options_;
    look.sky = sky;
    TerrainPainter(look).render(terrain::Terrain(HeightMap{map_.heights, std::move(colors)}),
                                camera_, ground.targets());
    return ground;
  }
  void refuse(const std::string& part, const Args& extra) const {
    refused("terrain --height h.png -o no.png --size 96x64" + extra, part);
    EXPECT_EQ(std::ranges::count(files(), "no.png"), 0);
  }
};

TEST_F(TerrainGround, LightsTakeThePlaceOfTheSun) {
  const Args lamps(
      "--light ambient:intensity=0.2 --light directional:-1,-1,0.4:intensity=0.8 --light "
      "point:30,45,30:intensity=300:range=90");
  GroundLights ground{
      .lights = {light(AmbientLight{}, 0.2F), light(DirectionalLight{{-1, -1, 0.4F}}, 0.8F),
                 light(PointLight{{30, 45, 30}, 90}, 300)},
      .smooth = true};
  EXPECT_TRUE(same_pixels(drawn_with(lamps), ground_under(lit_colors(map_, ground)).color));
  const Args shaded = lamps + "--shadows sharp";
  ground.shadows = terrain::Shadows::sharp;
  EXPECT_TRUE(same_pixels(drawn_with(shaded), ground_under(lit_colors(map_, ground)).color));
  // Without a colour map the heights give the colours.
  EXPECT_TRUE(same_pixels(drawn_with(shaded, false),
                          ground_under(lit_colors(HeightMap{map_.heights, {}}, ground)).color));
  EXPECT_TRUE(same_pixels(drawn_with("--lights default"), ground_under(map_.colors).color));
}

TEST_F(TerrainGround, TheEnvironmentIsBehindAndOnIt) {
  const Args around("--light environment:sky:intensity=1.4 --tone neutral --environment-behind");
  GroundLights ground{.lights = {light(EnvironmentLight{Environment(
                                           builtin_environment(BuiltinEnvironment::sky).view())},
                                       1.4F)}};
  ground.tone.tone = Tone::neutral;
  ground.smooth = true;
  const Rgba8 horizon = horizon_color(ground.lights, ground.tone);
  Ground expected = ground_under(lit_colors(map_, ground), horizon);
  draw_environment_behind(ground.lights, ground.tone, options_, camera_, expected.targets());
  EXPECT_TRUE(same_pixels(drawn_with(around), expected.color));
  // A mesh on the terrain is drawn by `material` in the same light, whatever its file says.
  const Args mesh = around + "--mesh builtin:sphere@x=30,y=25,scale=9,height=12";
  const Image<Rgba8> with_ball = drawn_with(mesh);
  EXPECT_TRUE(same_pixels(with_ball, drawn_with(mesh + "--shader material")));
  int changed = 0;
  for (std::size_t i = 0; i < with_ball.pixels().size(); ++i)
    changed += with_ball.pixels()[i] == expected.color.pixels()[i] ? 0 : 1;
  EXPECT_GT(changed, 50);
  EXPECT_LT(changed, kWidth * kHeight / 2);
}

TEST_F(TerrainGround, LightsOfTheCameraGoAlongAPath) {
  write("path.json", R"({"keys": [{"time": 0, "position": [30, 45], "angle": 0},
                                  {"time": 1, "position": [30, 45], "angle": 90}]})");
  must(
      "terrain --height h.png --size 96x64 --altitude 40 --horizon 20 --lights headlight --path "
      "path.json --fps 1 -o f%d.png");
  for (const auto& [file, view] : {std::pair{"f0.png", "--angle 0"}, {"f1.png", "--angle 90"}})
    EXPECT_TRUE(same_pixels(png(file),
                            drawn_with(Args("--lights headlight --position 30,45") + view, false)))
        << file;
}

TEST_F(TerrainGround, HeightsAreNumbersWithABar) {
  const ScalarMapping mapping{.map = color_map("plasma"), .range = ScalarRange{0, 40}, .steps = 4};
  const ScalarColors colors(mapping, {});
  const auto finer = terrain::colors_of_heights(map_.heights.view(), colors, 1, 4);
  GroundLights ground{.lights = {light(AmbientLight{})}, .smooth = true};
  Ground expected = ground_under(lit_colors(HeightMap{map_.heights, finer}, ground));
  const Args numbers("--light ambient --cmap plasma --range 0,40 --steps 4");
  EXPECT_TRUE(same_pixels(drawn_with(numbers, false), expected.color));
  overlay::ScalarBar bar = overlay::scalar_bar(mapping, colors);
  bar.title = "Height";
  bar.unit = "m";
  overlay::draw_scalar_bar({.color8 = expected.color}, bar, overlay::look_on({}));
  EXPECT_TRUE(same_pixels(drawn_with(numbers + "--bar Height --bar-unit m --scalars height", false),
                          expected.color));
  // By the file's values: at half the height, colours and numbers are the same.

  HeightMap half{map_.heights, {}};
  for (float& h : half.heights.pixels()) h *= 0.5F;
  half.colors = terrain::colors_of_heights(half.heights.view(), colors, 0.5, 4);
  Ground low;
  TerrainPainter(options_).render(
      terrain::Terrain(HeightMap{half.heights, lit_colors(half, ground)}), camera_, low.targets());
  EXPECT_TRUE(same_pixels(drawn_with(numbers + "--height-scale 0.5", false), low.color));
  // Functions as terrain, also in the sun.
  const Image<Rgba8> noise = drawn("terrain --function noise --cmap gray --size 96x64");
  for (const Rgba8 c : noise.pixels())
    ASSERT_TRUE(c == terrain::kSky || (c.r == c.g && c.g == c.b));
}

TEST_F(TerrainGround, AxesAndABoxLieOverIt) {
  constexpr overlay::AxisNames kNames{"x", "height", "y"};
  const Ground plain = ground_under(map_.colors);
  Camera lens{.matrix = terrain::world_to_clip(options_, camera_, SceneOnTerrain::kNear)};
  Image<Rgba8> axes = plain.color;
  overlay::draw_axes({.color8 = axes}, lens, overlay::Corner::bottom_left, overlay::look_on({}),
                     kNames);
  EXPECT_FALSE(same_pixels(axes, plain.color));
  EXPECT_TRUE(same_pixels(drawn_with("--axes"), axes));
  Image<float> reversed(kWidth, kHeight);
  for (std::size_t i = 0; i < reversed.pixels().size(); ++i)
    reversed.pixels()[i] = terrain::reversed_depth(plain.depth.pixels()[i], SceneOnTerrain::kNear);
  Image<Rgba8> box = plain.color;
  const auto [low, high] = std::ranges::minmax(map_.heights.pixels());
  overlay::draw_bounds({.color8 = box}, lens, {0, low, 0}, {kMap, high, kMap},
                       std::as_const(reversed).view(), overlay::look_on({}), kNames);
  EXPECT_FALSE(same_pixels(box, plain.color));
  EXPECT_TRUE(same_pixels(drawn_with("--bounds"), box));
}

TEST_F(TerrainGround, WhatMakesNoSenseSaysWhatToDo) {
  refuse("--light directional:0.296,-0.5,-0.814", "--sun 200,30 --light ambient");
  refuse("the sky dims", "--dim-sky --light ambient --sky #123456");
  refuse("--light environment:FILE", "--environment-behind");
  refuse("--light environment:FILE", "--environment-behind --light ambient");
  refuse("give --fog a colour", "--environment-behind --light environment:room --sky red");
  refuse("--lights or --light", "--tone aces");
  refuse("--lights or --light", "--exposure 1");
  refuse("by --light", "--lights file");
  refuse("its intensity", "--light point:1,2,3:intensity=-1");
  refuse("three numbers", "--light point:1,inf,3");
  refuse("nope.hdr", "--light environment:nope.hdr");
  refuse("material", "--mesh builtin:teapot@x=30,y=30 --light ambient --tone aces --shader phong");
  refuse("--steps", "--isolines 5");
  refuse("--steps", "--isoline-color red");
  refuse("ground is opaque", "--scalar-opacity 0:0,1:1");
  refuse("'height'", "--scalars z");
  refuse("must not be above the second", "--range 5,2");
  refuse("--cmap: colours the ground", "--cmap viridis --color c.png");
  refuse("above 0", "--bar T --log --range 0,5");
  refuse("planar", "--axes --projection cylindrical");
  refuse("planar", "--bounds --projection cylindrical");
  refused("terrain --function noise --bounds -o no.png", "no ends");
}

}  // namespace
}  // namespace rastrum::test::ground_test
