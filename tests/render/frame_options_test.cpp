// SPDX-License-Identifier: BSD-3-Clause
// A renderer draws frames of any size and look, each as a renderer made for it alone. Without the
// family it draws the family's default.
#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/family.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/terrain.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::frame_options_test {
namespace {

Frame drawn(Renderer& renderer, const Fitted& scene, const FrameOptions& frame) {
  return draw(renderer, scene.view, scene.camera, frame, kColor8 | kDepth);
}

std::vector<FrameOptions> looks() {
  return {{.width = 96, .height = 64},
          {.width = 640, .height = 480, .background = {0.2F, 0.4F, 0.6F, 1}},
          {.width = 33, .height = 17, .shader = Shader::normal, .cull = Cull::back},
          {.width = 320, .height = 200, .opacity = 0.4F},
          {.width = 320, .height = 200, .shader = Shader::depth},
          {.width = 64, .height = 64, .opacity = 0.4F, .samples = 8},
          {.width = 700, .height = 40, .shader = Shader::id},
          {.width = 96, .height = 64}};
}

TEST(FrameOptions, AreEachFramesOwn) {
  const Fitted scene(shapes::torus_knot());
  for (const RendererOptions& by :
       {RendererOptions{.threads = 3}, RendererOptions{.memory_limit = 16U << 20, .threads = 1},
        RendererOptions{.device = Device::serial}}) {
    Renderer renderer(by);
    for (const FrameOptions& frame : looks()) {
      Renderer fresh(by);
      const Frame expected = drawn(fresh, scene, frame), got = drawn(renderer, scene, frame);
      EXPECT_TRUE(same_images(got, expected)) << frame.width << " x " << frame.height;
      EXPECT_EQ(got.stats.shader, expected.stats.shader);
      if (by.memory_limit != 0) {
        EXPECT_LE(got.stats.peak_bytes, by.memory_limit);
        // Scratch of earlier frames is given back. Tested with one thread, because several share
        // the work unpredictably.
        EXPECT_LE(got.stats.peak_bytes, expected.stats.peak_bytes + (std::uint64_t{1} << 20));
      }
    }
  }
}

TEST(FrameOptions, AreCheckedBeforeAndByEachFrame) {
  const Fitted scene(shapes::boxes(1));
  Renderer renderer({.threads = 1});
  const FrameOptions bad[] = {{.width = 0}, {.opacity = 2}, {.samples = 3}};
  for (const FrameOptions& frame : bad) {
    EXPECT_THROW(check(frame), Error);
    EXPECT_THROW(renderer.render(scene.view, {}, frame, {}), Error);
    EXPECT_THROW(renderer.draw({}, frame, {}), Error);
  }
}

TEST(Renderer, IsTheFamilysDefault) {
  const Fitted scene(shapes::torus_knot());
  Renderer plain({.threads = 2});
  Renderer of_family = family::make_renderer({.threads = 2}, {});
  for (const FrameOptions& frame : looks()) {
    const Frame a = drawn(plain, scene, frame), b = drawn(of_family, scene, frame);
    EXPECT_TRUE(same_images(a, b));
    EXPECT_EQ(a.stats.rasterizer, b.stats.rasterizer);
    EXPECT_EQ(a.stats.visibility, b.stats.visibility);
    EXPECT_EQ(a.stats.why, b.stats.why);
    EXPECT_EQ(a.stats.counters, b.stats.counters);
  }
}

TEST(Renderer, DrawsMethodsOfTransparencyThatAreAdded) {
  const Fitted scene(shapes::boxes(2));
  FrameOptions frame{.width = 16, .height = 16, .opacity = 0.5F, .transparency = family::wboit()};
  for (const Device device : {Device::threads, Device::serial}) {
    Renderer renderer({.device = device, .threads = 1});
    EXPECT_GT(drawn(renderer, scene, frame).stats.pixels_covered, 0U);
  }
  frame.transparency.added = nullptr;
  EXPECT_THROW(check(frame), Error);
}

TEST(TerrainOptions, AreEachFramesOwn) {
  Image<float> heights(64, 64);
  for (const auto& [x, y] : pixels(64, 64))
    heights(x, y) = static_cast<float>((x * 7 + y * 5) % 23);
  const terrain::Terrain ground(terrain::HeightMap{heights, {}});
  terrain::TerrainRenderer renderer({.threads = 2});
  const terrain::TerrainOptions frames[] = {
      {.width = 80, .height = 50, .distance = 100},
      {.width = 200,
       .height = 30,
       .distance = 60,
       .step = 0,
       .filter = terrain::MapFilter::bilinear},
      {.width = 31, .height = 90, .distance = 90, .filter = terrain::MapFilter::mip},
      {.width = 64, .height = 64, .distance = 80, .classic = true},
      {.width = 80, .height = 50, .distance = 100, .added = &family::terrain_words()}};
  for (const terrain::TerrainOptions& frame : frames) {
    const auto draw = [&](terrain::TerrainRenderer& by) {
      Image<Rgba8> color(frame.width, frame.height);
      const terrain::TerrainStats stats = by.render(
          ground, {.x = 30, .y = 40, .altitude = 26, .horizon_px = 0}, frame, {.color8 = color});
      EXPECT_GT(stats.visible, 100U);
      return color;
    };
    terrain::TerrainRenderer fresh({.threads = 2});
    EXPECT_TRUE(std::ranges::equal(draw(renderer).pixels(), draw(fresh).pixels()));
  }
  EXPECT_THROW(renderer.render(ground, {}, {.width = 0}, {}), Error);
}

}  // namespace
}  // namespace rastrum::test::frame_options_test
