// SPDX-License-Identifier: BSD-3-Clause
// Meshes and sprites on a terrain. Every pixel is that of the nearer of two separate pictures,
// which the test composes; translucent layers lie over the terrain; and a thing on a cell appears
// at the cell.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/family.hpp>
#include <rastrum/on_terrain.hpp>
#include <rastrum/raster/draws/interpolate.hpp>
#include <rastrum/raster/draws/vertices.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/transform.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::on_terrain_test {
namespace {

using terrain::Terrain;
using terrain::TerrainCamera;
using test::TerrainLook;

constexpr int kWidth = 240, kHeight = 160, kMap = 256;

/// Hills in waves, 0 to 60 high.
Terrain hills() {
  terrain::HeightMap map{Image<float>(kMap, kMap), Image<Rgba8>(kMap, kMap)};
  for (const auto& [x, y] : pixels(kMap, kMap)) {
    map.heights(x, y) =
        static_cast<float>(std::floor(30 + 30 * std::sin(x * 0.05) * std::cos(y * 0.07)));
    map.colors(x, y) = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 60, 255};
  }
  return Terrain(std::move(map));
}

TerrainLook terrain_options() {
  return TerrainLook({.width = kWidth, .height = kHeight, .distance = 400});
}
RenderOptions render_options(Shader shader = Shader::flat) {
  return RenderOptions({.width = kWidth, .height = kHeight, .shader = shader});
}

Mat4d at(double x, double height, double y, double scale) {
  return translation({x, height, y}) * scaling({scale, scale, scale});
}
Scene placed(Mesh mesh, const Mat4d& where) {
  Scene scene = single(std::move(mesh));
  scene.instances[0].object_to_world = where;
  return scene;
}

struct Picture : Frame {
  TerrainCamera camera;  ///< as drawn

  Picture(const Terrain& ground, const TerrainLook& options, const TerrainCamera& given)
      : Frame(kWidth, kHeight, kColor8 | kDepth) {
    camera = TerrainPainter(options).render(ground, given, targets()).camera;
  }
  [[nodiscard]] terrain::TerrainTargets targets() { return {color8.view(), depth.view()}; }
  void add(const Scene& scene, const TerrainLook& options, const RenderOptions& how,
           const std::vector<std::size_t>& facing = {}) {
    const SceneBinding binding(scene);
    SceneOnTerrain(family::make_renderer(how, how))
        .draw({binding.view(), facing}, how, options, camera, targets());
  }
};

Frame alone(const Scene& scene, const TerrainLook& options, const TerrainCamera& camera,
            const RenderOptions& how) {
  return draw(how, SceneBinding(scene).view(),
              {.matrix = terrain::world_to_clip(options, camera, SceneOnTerrain::kNear)},
              kColor8 | kDepth);
}

struct View {
  const char* name;
  TerrainLook options;
  TerrainCamera camera;
};
/// Views of the hills from every side: planar, rolled, looking down, classic; by both methods.
std::vector<View> views() {
  const TerrainLook plain = terrain_options();
  const TerrainCamera south{128, 240, 75, 0, 40, 0};
  std::vector<View> list{{"plain", plain, south}};
  const auto add = [&](const char* name, auto&& change) {
    list.push_back({name, plain, south});
    change(list.back().options, list.back().camera);
  };
  add("rolled", [](TerrainLook&, TerrainCamera& c) { c.roll_rad = 0.6; });
  add("looks down", [](TerrainLook&, TerrainCamera& c) { c.horizon_px = -30; });
  add("from the east", [](TerrainLook& o, TerrainCamera& c) {
    c.x = 250;
    c.y = 90;
    c.angle_rad = 1.4;
    o.fov_rad = 1.1;
  });
  add("words", [](TerrainLook& o, TerrainCamera&) { o.added = &family::terrain_words(); });
  add("bilinear", [](TerrainLook& o, TerrainCamera&) { o.filter = terrain::MapFilter::bilinear; });
  add("serial", [](TerrainLook& o, TerrainCamera&) { o.device = Device::serial; });
  add("classic", [](TerrainLook& o, TerrainCamera&) { o.classic = true; });
  add("classic, turned", [](TerrainLook& o, TerrainCamera& c) {
    o.classic = true;
    c.angle_rad = 0.4;
    c.horizon_px = 20;
  });
  return list;
}

TEST(OnTerrain, ABoxBehindAHillIsSeenWhereItIsNearer) {
  const Terrain ground = hills();
  // Its foot is behind the crest along y = 180.
  const Scene box = placed(shapes::boxes(1, 1), at(100, 30, 120, 50));
  for (const View& v : views()) {
    SCOPED_TRACE(v.name);
    const Picture before(ground, v.options, v.camera);
    const Frame alone =
        on_terrain_test::alone(box, v.options, before.camera, render_options(Shader::normal));
    Picture both = before;
    both.add(box, v.options, render_options(Shader::normal));
    std::size_t shown = 0, hidden = 0, wrong = 0;
    for (const auto& [x, y] : pixels(kWidth, kHeight)) {
      const float d = alone.depth(x, y);
      const auto other = [](float depth) {  // converts between the depths of terrain and scene
        return static_cast<float>(SceneOnTerrain::kNear / static_cast<double>(depth));
      };
      const bool wins = d > other(before.depth(x, y));
      shown += wins;
      hidden += d > 0 && !wins;
      wrong += both.color8(x, y) != (wins ? alone : before).color8(x, y) ||
               both.depth(x, y) != (wins ? other(d) : before.depth(x, y));
    }
    EXPECT_EQ(wrong, 0U);
    EXPECT_GT(shown, 200U);
    EXPECT_GT(hidden, 200U);
  }
}

TEST(OnTerrain, TranslucentSurfacesLieOverTheTerrain) {
  const Terrain ground = hills();
  const Scene box = placed(shapes::boxes(1, 1), at(100, 30, 120, 50));
  RenderOptions opaque = render_options(Shader::normal);
  opaque.cull = Cull::back;  // one layer
  RenderOptions glass = opaque;
  glass.opacity = 0.3F;
  for (const View& v : views()) {
    SCOPED_TRACE(v.name);
    const Picture before(ground, v.options, v.camera);
    const Frame alone = on_terrain_test::alone(box, v.options, before.camera, opaque);
    Picture both = before;
    both.add(box, v.options, glass);
    int worst = 0;
    std::size_t blended = 0;
    for (const auto& [x, y] : pixels(kWidth, kHeight)) {
      const Rgba8 behind = before.color8(x, y), front = alone.color8(x, y);
      if (!(alone.depth(x, y) >
            terrain::reversed_depth(before.depth(x, y), SceneOnTerrain::kNear))) {
        EXPECT_EQ(both.color8(x, y), behind) << x << ", " << y;
        continue;
      }
      ++blended;
      const auto mix = [](int a, int b) {
        return static_cast<std::uint8_t>(std::lround(0.3 * a + 0.7 * b));
      };
      worst = std::max(
          worst, difference(both.color8(x, y), {mix(front.r, behind.r), mix(front.g, behind.g),
                                                mix(front.b, behind.b), 255}));
      EXPECT_EQ(both.color8(x, y).a, 255);
    }
    EXPECT_LE(worst, 1);
    EXPECT_GT(blended, 200U);
  }
}

TEST(OnTerrain, SpritesFaceTheCameraAndBlendInLinearLight) {
  // The left half is green at half alpha, the right half opaque except for a clear top row.
  Image<Rgba8> picture(8, 16);
  for (const auto& [x, y] : pixels(8, 16))
    picture(x, y) =
        y < 8 ? Rgba8{255, 0, 255, 0} : (x < 4 ? Rgba8{20, 200, 40, 128} : Rgba8{250, 10, 30, 255});
  Scene scene = sprite(picture);
  scene.textures[0].mag = scene.textures[0].min = TextureFilter::nearest;
  terrain::HeightMap map{Image<float>(kMap, kMap), Image<Rgba8>(kMap, kMap)};
  std::ranges::fill(map.colors.pixels(), Rgba8{180, 140, 90, 255});
  const Terrain flat(std::move(map));
  const TerrainLook options = terrain_options();
  const double size = 24, away = 60;
  scene.instances[0].object_to_world = at(128, 0, 128, size);
  for (const double angle : {0.0, 0.9, 2.5, -1.57}) {
    SCOPED_TRACE(angle);
    // The camera circles the sprite, which stays in the middle.
    const TerrainCamera camera{
        128 + away * std::sin(angle), 128 + away * std::cos(angle), 30, angle, 50, 0};
    const Picture before(flat, options, camera);
    Picture both = before;
    both.add(scene, options, render_options(Shader::material), {0});
    int half = 0, whole = 0, other = 0;
    for (const auto& [x, y] : pixels(kWidth, kHeight)) {
      const Rgba8 got = both.color8(x, y), behind = before.color8(x, y);
      if (got == behind) continue;
      const auto mix = [&](int front, int back) {
        const double a = 128 / 255.0;
        return static_cast<std::uint8_t>(
            std::lround(255 * display(a * light(front) + (1 - a) * light(back))));
      };
      const Rgba8 blend{mix(20, behind.r), mix(200, behind.g), mix(40, behind.b), 255};
      if (difference(got, {250, 10, 30, 255}) <= 1)
        ++whole;
      else if (difference(got, blend) <= 1)
        ++half;
      else
        ++other;
    }
    EXPECT_EQ(other, 0);
    // 12 × 24 cells at 2 px a cell, with only the lower half visible: two halves of 12 × 24 px.
    EXPECT_NEAR(half, 12 * 24, 30);
    EXPECT_NEAR(whole, 12 * 24, 30);
  }
}

TEST(OnTerrain, WhatStandsOnACellIsSeenWhereTheCellIs) {
  // A flat map at height 5 with one red cell, and a thin pole of two blades on its middle.
  Mesh pole{.positions = {{-0.3F, 0, 0},
                          {0.3F, 0, 0},
                          {0.3F, 12, 0},
                          {-0.3F, 12, 0},
                          {0, 0, -0.3F},
                          {0, 0, 0.3F},
                          {0, 12, 0.3F},
                          {0, 12, -0.3F}},
            .indices = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7}};
  const Scene one = placed(pole, at(100.5, 5, 130.5, 1));
  terrain::HeightMap map{Image<float>(kMap, kMap), Image<Rgba8>(kMap, kMap)};
  std::ranges::fill(map.heights.pixels(), 5.0F);
  std::ranges::fill(map.colors.pixels(), Rgba8{0, 90, 0, 255});
  map.colors(100, 130) = {255, 0, 0, 255};
  const Terrain ground(std::move(map));
  for (const bool classic : {false, true})
    for (const double angle : {0.0, 0.35, 1.9, 3.6})
      for (const double roll : {0.0, 0.4}) {
        if (classic && roll != 0) continue;
        SCOPED_TRACE(std::to_string(classic) + " " + std::to_string(angle) + " " +
                     std::to_string(roll));
        TerrainLook options = terrain_options();
        options.classic = classic;
        options.step = classic ? options.step : 0.25;
        // Classic's steps are 4 rows long here; the pole stands on its slice 27.
        const double away = classic ? 1 + 27 + 0.005 * 27 * 28 / 2 : 30, aside = 6;
        const TerrainCamera camera{100.5 + away * std::sin(angle) + aside * std::cos(angle),
                                   130.5 + away * std::cos(angle) - aside * std::sin(angle),
                                   classic ? 18.0 : 35.0,
                                   angle,
                                   30,
                                   roll};
        const Picture before(ground, options, camera);
        Picture both = before;
        both.add(one, options, render_options(Shader::flat));
        const Frame alone =
            on_terrain_test::alone(one, options, before.camera, render_options(Shader::flat));
        // The pole's lowest pixel along the picture's vertical, and its lowest visible one: the
        // ground hides the part of the blades behind the cell.
        double lowest = -1e9, lowest_seen = -1e9;
        int px = -1, py = -1;
        for (const auto& [x, y] : pixels(kWidth, kHeight)) {
          const double down = x * std::sin(roll) + y * std::cos(roll);
          if (both.color8(x, y) != before.color8(x, y)) lowest_seen = std::max(lowest_seen, down);
          if (!(alone.depth(x, y) > 0) || down <= lowest) continue;
          lowest = down;
          px = x;
          py = y;
        }
        EXPECT_NEAR(lowest_seen, lowest, 3);
        ASSERT_GE(px, 0) << "the pole is not seen";
        int nearest = 1000;
        for (const auto& [x, y] : pixels(kWidth, kHeight))
          if (before.color8(x, y).r > 60)
            nearest = std::min(nearest, std::max(std::abs(x - px), std::abs(y - py)));
        EXPECT_LE(nearest, 1) << "its foot is drawn at " << px << ", " << py;
      }
}

/// A cloud of triangles on and in the hills.
Scene cloud() {
  return placed(shapes::soup(600, 0.05F, 0.5F, 3), at(120, 40, 130, 60));
}

TEST(OnTerrain, IsTheSameOnEveryDeviceByEveryMethodAndInLittleMemory) {
  const Terrain ground = hills();
  const TerrainLook options = terrain_options();
  const Picture before(ground, options, views()[1].camera);
  const Scene scene = cloud();
  for (const float opacity : {1.0F, 0.4F}) {
    RenderOptions plain = render_options(Shader::lambert);
    plain.isa = Isa::scalar;
    plain.opacity = opacity;
    RenderOptions serial = plain;
    serial.device = Device::serial;
    Picture reference = before;
    reference.add(scene, options, serial);
    std::vector<RenderOptions> all;
    const auto add = [&](const std::string& rasterizer, const std::string& visibility) {
      RenderOptions& o = all.emplace_back(plain);
      o.rasterizer = rasterizer;
      o.visibility = visibility;
      o.threads = 8;
    };
    for (const family::AxisInfo& rasterizer : family::rasterizer_axis()) {
      // Layers need threads that own tiles.
      if (rasterizer.name == "reference") continue;
      const bool owns = rasterizer.name == "grouped" || rasterizer.name == "tiled";
      if (opacity == 1 || owns) add(rasterizer.name, plain.visibility);
      if (opacity == 1)
        for (const family::AxisInfo& visibility : family::visibility_axis())
          add(rasterizer.name, visibility.name);
    }
    RenderOptions& little = all.emplace_back(plain);
    little.threads = 2;
    little.memory_limit = 3 << 20;
    for (const RenderOptions& o : all) {
      Picture got = before;
      got.add(scene, options, o);
      EXPECT_TRUE(same_images(got, reference))
          << o.rasterizer << " " << o.visibility << " " << o.memory_limit << " " << opacity;
    }
  }
}

/// Discards all fragments.
struct Nothing final : raster::FragmentTest {
  std::uint64_t test(const raster::FrameGeometry&, const raster::Piece&, const raster::Block&,
                     const raster::ShadingPoints*) const noexcept override {
    return 0;
  }
};

TEST(OverPicture, AsksTheTestOfADrawForThatDrawAlone) {
  const Mesh box = shapes::boxes(1, 1);
  Camera camera{.eye = {0, 0, 4}};
  const Mat4d to_clip = world_to_clip(camera, kWidth, kHeight);
  const raster::MatrixVertices sources[] = {{box.positions, to_clip * at(-0.8, 0, 0, 1)},
                                            {box.positions, to_clip * at(0.8, 0, 0, 1)}};
  raster::Draw draws[2];
  for (int i = 0; i < 2; ++i) {
    draws[i].source = sources[i];
    draws[i].vertex_count = box.positions.size();
    draws[i].indices = box.indices;
    draws[i].primitive_count = box.triangle_count();
  }
  draws[1].flags = kTested;
  Image<float> depth(kWidth, kHeight);
  const Targets targets{.depth = depth.view()};
  const raster::FragmentShader shader(
      [](const raster::FrameGeometry&, const Fragment&) { return Vec4{}; });
  const Nothing nothing;
  Painter(render_options()).draw(draws, shader, &nothing, targets, {.over = true});
  std::size_t left = 0, right = 0;
  for (const auto& [x, y] : pixels(kWidth, kHeight))
    (x < kWidth / 2 ? left : right) += depth(x, y) > 0;
  EXPECT_GT(left, 500U);
  EXPECT_EQ(right, 0U);
  EXPECT_EQ(draws[0].flags, 0U) << "the caller's draws stay as they are";
}

TEST(OnTerrain, LightsAsALensWithTheSameMatrix) {
  const Scene scene = placed(shapes::sphere(24, 32), at(3, 1, -2, 4));
  Camera lens{.eye = {1, 7, 12}, .target = {2, 0, -1}};
  const SceneBinding binding(scene);
  Camera matrix{.matrix = world_to_clip(lens, kWidth, kHeight)};
  for (const Shader shader : {Shader::phong, Shader::material}) {
    const Image<Rgba8> a = render(binding.view(), lens, render_options(shader));
    const Image<Rgba8> b = render(binding.view(), matrix, render_options(shader));
    int worst = 0;
    std::size_t seen = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) {
      EXPECT_EQ(a.pixels()[i].a, b.pixels()[i].a);
      seen += a.pixels()[i].a != 0;
      worst = std::max(worst, difference(a.pixels()[i], b.pixels()[i]));
    }
    EXPECT_GT(seen, 2000U);
    EXPECT_LE(worst, 1);
  }
}

TEST(OverPicture, KeepsThePictureWhereDepthsAreEqualAndWhereNothingIs) {
  const Fitted boxes(shapes::boxes(2, 0.7F), 1);
  const Frame first =
      draw(render_options(Shader::flat), boxes.view, boxes.camera, kColor8 | kDepth);
  Frame again = first;
  // The same surfaces in another colour: every fragment is a tie.
  Targets targets = again.targets();
  const Pass over{.over = true};
  Painter(render_options(Shader::normal)).render(boxes.view, boxes.camera, targets, over);
  EXPECT_TRUE(same_images(again, first, kColor8));
  // Half of the picture is moved away. There the surfaces win, also over a picture of floats.
  for (const auto& [x, y] : pixels(kWidth / 2, kHeight))
    again.depth(x, y) = std::nextafter(again.depth(x, y), 0.0F);
  Image<Vec4> floats(kWidth, kHeight);
  std::ranges::fill(floats.pixels(), Vec4{0.5F, 0.25F, 0, 1});
  RenderOptions glass = render_options(Shader::flat);
  glass.opacity = 0.5F;
  glass.cull = Cull::back;
  targets.color = floats.view();
  targets.color8 = {};
  Painter(glass).render(boxes.view, boxes.camera, targets, over);
  std::size_t drawn = 0;
  for (const auto& [x, y] : pixels(kWidth, kHeight)) {
    const bool expected = x < kWidth / 2 && first.depth(x, y) > 0;
    drawn += expected;
    const Vec4 c = floats(x, y);
    EXPECT_NEAR(c.x, expected ? 0.4F + 0.25F : 0.5F, 1e-6F) << x << ", " << y;
    EXPECT_NEAR(c.y, expected ? 0.35F + 0.125F : 0.25F, 1e-6F);
    EXPECT_EQ(c.w, 1);
    EXPECT_EQ(again.depth(x, y), first.depth(x, y));
  }
  EXPECT_GT(drawn, 1000U);
}

TEST(OnTerrain, RefusesWhatCannotBeComposed) {
  const Scene box = placed(shapes::boxes(1, 1), at(100, 30, 120, 50));
  const SceneBinding binding(box);
  Image<Rgba8> color(kWidth, kHeight);
  Image<Rgba8> small_color(8, 8);
  Image<float> depth(kWidth, kHeight), small(8, 8);
  const terrain::TerrainTargets targets{.color8 = color, .depth = depth};
  const auto message = [&](const TerrainLook& options, const RenderOptions& how,
                           const terrain::TerrainTargets& to,
                           const std::vector<std::size_t>& facing = {}) {
    return error_message_of([&] {
      SceneOnTerrain(family::make_renderer(how, how))
          .draw({binding.view(), facing}, how, options, {}, to);
    });
  };
  const TerrainLook good = terrain_options();
  EXPECT_EQ(message(good, render_options(), targets), "");
  TerrainLook ring = good;
  ring.projection = terrain::Projection::cylindrical;
  EXPECT_TRUE(holds(message(ring, render_options(), targets), "cylindrical"));
  EXPECT_TRUE(holds(message(good, render_options(Shader::depth), targets), "depth shader"));
  RenderOptions samples = render_options();
  samples.samples = 4;
  EXPECT_TRUE(holds(message(good, samples, targets), "one sample"));
  EXPECT_TRUE(holds(message(good, render_options(), targets, {1}), "the number 1"));
  EXPECT_TRUE(holds(message(good, render_options(), {color, {}}), "need its depth"));
  EXPECT_EQ(message(good, render_options(), {color, small}),
            "the depth target is 8x8 and must be 240x160, as the frame is");
  EXPECT_EQ(message(good, render_options(), {small_color, depth}),
            "the color8 target is 8x8 and must be 240x160, as the frame is");
  EXPECT_TRUE(holds(message(good, render_options(), {color, {&depth(0, 0), kWidth, kHeight, 0}}),
                    "the depth target: rows of 240 pixels overlap"));
  RenderOptions large = render_options();
  large.width = 320;
  EXPECT_EQ(message(good, large, targets),
            "what stands on a terrain is drawn at 320x160, the terrain at 240x160; give "
            "FrameOptions and TerrainOptions the same size");
}

TEST(Sprite, IsAsHighAsOneAndNeedsAPicture) {
  const Scene scene = sprite(Image<Rgba8>(30, 20));
  const Bounds box = bounds(SceneBinding(scene).view());
  EXPECT_EQ(box.min.x, -0.75F);
  EXPECT_EQ(box.max.x, 0.75F);
  EXPECT_EQ(box.min.y, 0);
  EXPECT_EQ(box.max.y, 1);
  EXPECT_THROW((void)sprite({}), Error);
}

}  // namespace
}  // namespace rastrum::test::on_terrain_test
