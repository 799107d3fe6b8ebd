// SPDX-License-Identifier: BSD-3-Clause
// Picks what is under a pixel: the same bits as the images of the whole frame.
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/picked.hpp"
#include "tests/support/random.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::pick_test {
namespace {

constexpr int kW = 150, kH = 100;  // several bins, cut at the edges

TEST(Pick, IsWhatTheImagesOfTheWholeFrameHold) {
  int seen = 0, empty = 0;
  const int scenes = share_of(1000, 30);
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(scenes); ++seed) {
    const GeneratedScene g = generate(seed, kW, kH);
    const SceneView scene = g.view();
    FrameOptions frame{.width = kW, .height = kH};
    if (seed % 4 == 1) frame.samples = 4;
    if (seed % 4 == 2) frame.opacity = 0.5F;
    if (seed % 4 == 3) frame.shader = Shader::depth;
    Renderer renderer({.device = seed % 8 == 0 ? Device::serial : Device::threads, .threads = 1});
    const Frame s = draw(renderer, scene, g.camera, frame, kSurfaces);
    Random r(seed);
    for (int n = 0; n < 6; ++n) {
      const int x = r.integer(0, kW - 1), y = r.integer(0, kH - 1);
      SCOPED_TRACE(g.kind + " " + std::to_string(seed) + " at " + std::to_string(x) + ", " +
                   std::to_string(y));
      const std::optional<Pick> p = renderer.pick(scene, g.camera, frame, x, y);
      ASSERT_EQ(p.has_value(), s.ids(x, y) >= 0);
      if (!p) {
        ++empty;
        continue;
      }
      ++seen;
      ASSERT_NO_FATAL_FAILURE(expect_picked(*p, s, x, y));
      // locate() gives the same.
      const Located at = locate(scene, p->id);
      ASSERT_EQ(at.instance, p->instance);
      ASSERT_EQ(at.primitive, p->primitive);
      const Barycentrics again = barycentrics(scene, g.camera, kW, kH, p->id, x, y);
      ASSERT_EQ(std::memcmp(&again, &p->barycentrics, sizeof again), 0);
      ASSERT_EQ(position(scene, at, again), p->position);
    }
  }
  EXPECT_GT(seen, scenes);
  EXPECT_GT(empty, scenes / 2);
}

TEST(Pick, PositionsProjectToTheirPixels) {
  int compared = 0;
  for (const bool orthographic : {false, true}) {
    const Mesh teapot = shapes::teapot(6);
    const OneInstance scene(teapot.view());
    Camera camera{
        .eye = {3, 2, 4}, .orthographic = orthographic, .orthographic_height = 4, .far_plane = 20};
    for (const bool by_matrix : {false, true}) {
      if (by_matrix)
        camera = camera_from_matrix(world_to_clip(camera, kW, kH), ClipDepth::reversed);
      const Frame s =
          draw({.threads = 1}, scene.view(), camera, {.width = kW, .height = kH}, kSurfaces);
      for (int y = 0; y < kH; ++y)
        for (int x = 0; x < kW; ++x) {
          if (s.ids(x, y) < 0) continue;
          const Vec3 p = s.positions(x, y);
          const ProjectedPoint at =
              project(camera, kW, kH, std::vector<Vec3d>{{p.x, p.y, p.z}}).at(0);
          ASSERT_NEAR(at.x, x + 0.5, 0.01);
          ASSERT_NEAR(at.y, y + 0.5, 0.01);
          ASSERT_NEAR(at.view_depth, s.view_depth(x, y), 1e-4);
          ASSERT_TRUE(is_seen(at, s.view_depth));
          ++compared;
        }
    }
  }
  EXPECT_GT(compared, 4000);
}

TEST(Pick, PointsAreSeenUnlessASurfaceHidesThem) {
  // A wall in the lower half of the picture, one unit before the points.
  Mesh wall;
  wall.positions = {{-9, -9, 1}, {9, -9, 1}, {9, 0, 1}, {-9, 0, 1}};
  wall.indices = {0, 1, 2, 0, 2, 3};
  const OneInstance scene(wall.view());
  const Camera camera{.eye = {0, 0, 5}};
  for (const float nothing : {0.0F, std::numeric_limits<float>::infinity()}) {
    FrameOptions frame{.width = kW, .height = kH};
    frame.no_distance = nothing;
    const Frame s = draw({.threads = 1}, scene.view(), camera, frame, kSurfaces);
    const std::vector<Vec3d> points{{0, 0.5, 0},  {0, -0.5, 0}, {0, -0.5, 1}, {0, -0.5, 2},
                                    {0, 0.01, 0}, {0, -40, 1},  {0, 0, 5},    {0, 0, 9}};
    const bool seen[] = {true, false, true, true, true, false, false, false};
    const std::vector<ProjectedPoint> at = project(camera, kW, kH, points);
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_EQ(is_seen(at[i], s.view_depth), seen[i]) << i;
    EXPECT_EQ(at[0].x, kW / 2.0);
    EXPECT_LT(at[0].y, kH / 2.0);
    EXPECT_EQ(at[0].view_depth, 5);
    EXPECT_TRUE(std::isnan(at[6].x) && std::isnan(at[7].y));
    EXPECT_EQ(at[7].view_depth, -4);
  }
  expect_refused("field of view", [] { (void)project(Camera{.fov_rad = 4}, kW, kH, {}); });
}

TEST(Pick, RefusesWhatIsNotThere) {
  const std::vector<Vec3> positions{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  const std::vector<std::uint32_t> indices{0, 1, 7};
  OneInstance instance(MeshView{.positions = positions});
  const SceneView scene = instance.view();
  const FrameOptions frame{.width = 20, .height = 10};
  Renderer renderer({.threads = 1});
  expect_refused("(20, 3) lies outside", [&] { (void)renderer.pick(scene, {}, frame, 20, 3); });
  expect_refused("(2, -1) lies outside", [&] { (void)renderer.pick(scene, {}, frame, 2, -1); });
  expect_refused("primitive 1 is out of range", [&] { (void)locate(scene, 1); });
  instance.show(MeshView{.positions = positions, .indices = indices});
  expect_refused("out of range", [&] { (void)renderer.pick(scene, {}, frame, 2, 1); });
  expect_refused("out of range", [&] { (void)barycentrics(scene, {}, 20, 10, 0, 2, 1); });
}

}  // namespace
}  // namespace rastrum::test::pick_test
