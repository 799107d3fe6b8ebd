// SPDX-License-Identifier: BSD-3-Clause
// Several threads share a Renderer, TerrainRenderer or SceneOnTerrain: each call is a frame of its
// own, with the picture of an unshared renderer.
#include <cmath>
#include <latch>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/on_terrain.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/terrain.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::one_renderer_test {
namespace {

constexpr int kCallers = 4, kFrames = 6;

/// Calls f(caller, frame) on kCallers threads at once, kFrames times each.
template <class F>
void from_all_callers(const F& f) {
  std::latch all_there(kCallers);
  std::vector<std::thread> callers;
  for (int caller = 0; caller < kCallers; ++caller)
    callers.emplace_back([&, caller] {
      all_there.arrive_and_wait();
      for (int frame = 0; frame < kFrames; ++frame) f(caller, frame);
    });
  for (std::thread& t : callers) t.join();
}

TEST(OneRenderer, DrawsForSeveralThreads) {
  // The scenes differ in size, so that scratch grows; the last one is translucent.
  std::vector<Scene> scenes{single(shapes::sphere(8, 16)), single(shapes::teapot(8)),
                            single(shapes::soup(3000, 0.02F, 0.4F)), single(shapes::boxes(4))};
  scenes.back().meshes[0].colors.values.assign(scenes.back().meshes[0].positions.size(),
                                               {0.2F, 0.5F, 1, 0.5F});
  for (const Device device : {Device::threads, Device::serial}) {
    RenderOptions o({.width = 120, .height = 90}, {.device = device, .threads = 2});
    std::vector<Frame> alone;
    for (const Scene& scene : scenes)
      alone.push_back(draw(o, scene, fit_camera(SceneBinding(scene).view(), 1, false)));
    Painter renderer(o);
    from_all_callers([&](int caller, int frame) {
      const auto which = static_cast<std::size_t>(caller + frame) % scenes.size();
      const Fitted scene(scenes[which], 1);
      const Frame f = draw(renderer, scene.view, scene.camera);
      EXPECT_TRUE(same_frames(f, alone[which])) << which;
    });
  }
}

constexpr int kSide = 96;

terrain::Terrain hills(double steepness) {
  constexpr int kMap = 1024;
  terrain::HeightMap map{Image<float>(kMap, kMap), Image<Rgba8>(kMap, kMap)};
  for (const auto& [x, y] : pixels(kMap, kMap)) {
    map.heights(x, y) = static_cast<float>(
        std::floor(30 + 30 * std::sin(x * 0.1 * steepness) * std::cos(y * 0.14)));
    map.colors(x, y) = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 60, 255};
  }
  return terrain::Terrain(std::move(map));
}

TerrainLook terrain_options() {
  TerrainLook o({.width = kSide, .height = kSide, .distance = 200}, {.threads = 2});
  o.filter = terrain::MapFilter::mip;  // each map has a pyramid, which takes time to make
  return o;
}
constexpr terrain::TerrainCamera kCamera{.x = 50, .y = 90, .altitude = 80, .horizon_px = 30};

struct Ground : Frame {
  Ground() : Frame(kSide, kSide, kColor8 | kDepth) {}
  [[nodiscard]] terrain::TerrainTargets targets() { return {color8.view(), depth.view()}; }
};

TEST(OneTerrainRenderer, DrawsForSeveralThreads) {
  // Two maps, whose pyramids replace each other.
  const terrain::Terrain maps[] = {hills(1), hills(3)};
  Ground alone[2];
  for (int i = 0; i < 2; ++i)
    TerrainPainter(terrain_options()).render(maps[i], kCamera, alone[i].targets());
  EXPECT_FALSE(same_images(alone[0], alone[1], kColor8));
  TerrainPainter renderer(terrain_options());
  from_all_callers([&](int caller, int frame) {
    const int which = (caller + frame) % 2;
    Ground ground;
    renderer.render(maps[which], kCamera, ground.targets());
    EXPECT_TRUE(same_images(ground, alone[which]));
  });
}

TEST(OneSceneOnTerrain, DrawsForSeveralThreads) {
  Ground bare;
  TerrainPainter(terrain_options()).render(hills(1), kCamera, bare.targets());
  RenderOptions o({.width = kSide, .height = kSide}, {.threads = 2});
  std::vector<Scene> scenes{single(shapes::sphere(8, 16)), single(shapes::boxes(4))};
  for (Scene& scene : scenes)
    for (int i = 0; i < 3; ++i) {
      scene.instances[0].object_to_world.m[i][i] = 15;
      scene.instances[0].object_to_world.m[i][3] = i == 0 ? 50 : i == 1 ? 70 : 50;
    }
  const auto add = [&](SceneOnTerrain& painter, std::size_t which) {
    Ground ground = bare;
    const SceneBinding binding(scenes[which]);
    painter.draw({.scene = binding.view()}, o, terrain_options(), kCamera, ground.targets());
    return ground;
  };
  std::vector<Ground> alone;
  for (std::size_t i = 0; i < 2; ++i) {
    SceneOnTerrain painter(family::make_renderer(o, o));
    alone.push_back(add(painter, i));
    EXPECT_FALSE(same_images(alone[i], bare, kColor8));
  }
  SceneOnTerrain painter(family::make_renderer(o, o));
  from_all_callers([&](int caller, int frame) {
    const auto which = static_cast<std::size_t>(caller + frame) % 2;
    EXPECT_TRUE(same_images(add(painter, which), alone[which]));
  });
}

}  // namespace
}  // namespace rastrum::test::one_renderer_test
