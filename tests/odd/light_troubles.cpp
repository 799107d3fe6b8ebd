// SPDX-License-Identifier: BSD-3-Clause
// Lights, shadows, and the planes of cameras that have none.
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/core/memory.hpp>
#include <rastrum/error.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/image.hpp>
#include <rastrum/light.hpp>
#include <rastrum/primitives.hpp>
#include <rastrum/render.hpp>
#include <rastrum/render/shadows.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/surfaces.hpp>
#include <rastrum/transform.hpp>

#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::light_troubles {
namespace {

/// A box of 0.3 in the middle of a square floor, both of triangles.
struct BoxOnFloor {
  std::vector<Vec3> floor, box;

  explicit BoxOnFloor(float edge) {
    const float h = edge / 2;
    floor = {{-h, 0, -h}, {-h, 0, h}, {h, 0, h}, {-h, 0, -h}, {h, 0, h}, {h, 0, -h}};
    const auto corner = [](int k) {
      return Vec3{(k & 1) != 0 ? 0.15F : -0.15F, (k & 2) != 0 ? 0.3F : 0.0F,
                  (k & 4) != 0 ? 0.15F : -0.15F};
    };
    constexpr std::array<std::array<int, 4>, 6> kFaces{
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}}};
    for (const auto& f : kFaces)
      for (const int k : {0, 1, 2, 0, 2, 3}) box.push_back(corner(f[static_cast<std::size_t>(k)]));
  }
  [[nodiscard]] KeptInstances instances() const {
    return {MeshView{.positions = floor}, MeshView{.positions = box}};
  }
};

Camera close_by(bool orthographic) {
  Camera camera{.eye = {0.7, 0.8, 1.2}, .target = {0, 0.1, 0}};
  if (orthographic) {
    camera.orthographic = true;
    camera.orthographic_height = 1.6F;
    camera.far_plane = 500;
  }
  return camera;
}

/// How many pixels of the floor are darker for what stands in the way of `light`.
int shadowed(float edge, const Camera& camera, const Light& light, Vec3d origin = {}) {
  const BoxOnFloor scene(edge);
  auto instances = scene.instances();
  for (InstanceView& i : instances) i.object_to_world = translation(origin);
  FrameOptions frame{.width = 128, .height = 128, .shader = Shader::lambert, .lights = {light}};
  Image<Vec4> open(128, 128), dark(128, 128);
  Image<std::int64_t> which(128, 128);
  Renderer renderer(RendererOptions{.threads = 1});
  renderer.render({instances}, camera, frame, {.color = open});
  frame.shadows = true;
  renderer.render({instances}, camera, frame, {.color = dark, .instances = which});
  int count = 0;
  for (std::size_t i = 0; i < which.pixels().size(); ++i)
    count += which.pixels()[i] == 0 && dark.pixels()[i].x < 0.5F * open.pixels()[i].x;
  return count;
}

/// Compares with a floor that is as large as the picture sees, whose map is fine under any rule.
void expect_the_shadow(const Camera& camera, const Light& light) {
  const int small = shadowed(2, camera, light);
  EXPECT_GT(small, 200);
  for (const float edge : {20.0F, 200.0F, 2000.0F})
    EXPECT_NEAR(shadowed(edge, camera, light), small, small / 8) << "a floor of " << edge;
}

// A box of 0.3 on floors of 2, 20, 200 and 2000, seen from 1.6. Right: the same shadow on all:
// the map covers what the picture sees (docs/light_rules.md).
TEST(OddShadows, OverALargeFloor) {
  expect_the_shadow(close_by(false), {.kind = DirectionalLight{{1, -1.2F, 0.4F}}});
}
// The same, seen by an orthographic camera. Right: the same shadow.
TEST(OddShadows, InAParallelView) {
  expect_the_shadow(close_by(true), {.kind = DirectionalLight{{1, -1.2F, 0.4F}}});
}
// The same under a spot 240 away whose cone is a hundred times wider. Right: the same shadow.
TEST(OddShadows, OfAHighSpot) {
  // A metre is a pixel or two of its cone, 200 m above.
  Light spot{.kind = SpotLight{{-120, 200, -60}, {120, -200, 60}}, .intensity = 60000};
  expect_the_shadow(close_by(false), spot);
}
// A box 0.05 below a spot over a floor of 2000. Right: its shadow is there, however near the
// box is to the light.
TEST(OddShadows, CloseToASpot) {
  const Light spot{.kind = SpotLight{{0.0, 0.35, 0.0}, {0, -1, 0}, 1e9F, 1.0F, 1.2F},
                   .intensity = 0.3F};
  const int small = shadowed(2, close_by(false), spot);
  EXPECT_GT(small, 300);
  EXPECT_NEAR(shadowed(2000, close_by(false), spot), small, small / 8);
}

// The same 60 million away: float32 positions, whose origin is the instance's matrix. Right:
// the same shadow: matrices of lights are float64 and begin near the scene.
TEST(OddShadows, FarFromTheOrigin) {
  const Vec3d origin{6e7, -3e7, 2e7};
  Camera there = close_by(false);
  there.eye = there.eye + origin;
  there.target = there.target + origin;
  const Light sun{.kind = DirectionalLight{{1, -1.2F, 0.4F}}};
  EXPECT_NEAR(shadowed(20, there, sun, origin), shadowed(20, close_by(false), sun), 10);
}

// Boxes of 3, 12 and 45 at 25, 100 and 400 from an eye 20 high. Right: each has a shadow.
TEST(OddShadows, ToTheHorizon) {
  const BoxOnFloor scene(2000);
  KeptInstances instances{MeshView{.positions = scene.floor}};
  for (const auto& [z, size] : {std::pair{-25.0, 10.0}, {-100.0, 40.0}, {-400.0, 150.0}}) {
    InstanceView& box = instances.add(MeshView{.positions = scene.box});
    box.object_to_world.m[0][0] = box.object_to_world.m[1][1] = box.object_to_world.m[2][2] = size;
    box.object_to_world.m[2][3] = z;
  }
  Camera camera{.eye = {0, 20, 0}, .target = {0, 13, -15}};
  FrameOptions frame{.width = 192,
                     .height = 128,
                     .shader = Shader::lambert,
                     .lights = {{.kind = DirectionalLight{{-0.3F, -0.4F, 1}}}}};
  Image<Vec4> open(192, 128), dark(192, 128);
  Image<Vec3> places(192, 128);
  Image<std::int64_t> which(192, 128);
  Renderer renderer(RendererOptions{.threads = 1});
  renderer.render({instances}, camera, frame, {.color = open});
  frame.shadows = true;
  renderer.render({instances}, camera, frame,
                  {.color = dark, .instances = which, .positions = places});
  int counts[3] = {};
  for (std::size_t i = 0; i < which.pixels().size(); ++i)
    if (which.pixels()[i] == 0 && dark.pixels()[i].x < 0.5F * open.pixels()[i].x) {
      const float z = -places.pixels()[i].z;
      ++counts[z < 45 ? 0 : z < 200 ? 1 : 2];
    }
  for (const int n : counts) EXPECT_GT(n, 12);
}

/// Pixels that a ball covers, seen by a camera.
int covered(const SceneView& scene, const Camera& camera) {
  FrameOptions frame{.width = 200, .height = 200};
  Image<std::int64_t> ids(200, 200);
  Renderer(RendererOptions{.threads = 1}).render(scene, camera, frame, {.ids = ids});
  int count = 0;
  for (const std::int64_t id : ids.pixels()) count += id >= 0;
  return count;
}

// A camera that moves by less than a texel a picture. Right: no shadow swims: texels lie on
// multiples of a power of two.
TEST(OddShadows, AlongAPath) {
  const BoxOnFloor scene(200);
  const auto instances = scene.instances();
  FrameOptions frame{.width = 320,
                     .height = 240,
                     .lights = {{.kind = DirectionalLight{{1, -1.2F, 0.4F}}}},
                     .shadows = true};
  MemoryAccount memory;
  Shadows shadows(memory);
  std::set<double> texels;
  for (int i = 0; i < 100; ++i) {
    Camera camera = close_by(false);
    camera.eye = camera.eye + Vec3d{0.0037 * i, 0.0011 * i, -0.0053 * i};
    const auto drawn = shadows.draw({instances}, camera, frame, [](auto&&...) {});
    ASSERT_EQ(drawn.size(), 1U);
    ASSERT_FALSE(drawn[0].empty());
    for (const raster::LightPicture& p : drawn[0]) {
      texels.insert(p.texel);
      int exponent = 0;
      EXPECT_EQ(std::frexp(p.texel, &exponent), 0.5);
      // The world's origin is at a corner of four texels.
      const double column = (p.world_to_clip.m[0][3] + 1) * p.depth.width / 2;
      const double row = (p.world_to_clip.m[1][3] + 1) * p.depth.height / 2;
      EXPECT_NEAR(column, std::round(column), 1e-6);
      EXPECT_NEAR(row, std::round(row), 1e-6);
    }
  }
  EXPECT_LE(texels.size(), 8U);
}

// A ball of 0.001 on ground of 20, seen from 0.01. Right: it is seen: a near plane that nobody
// sets is at most 1/100 of the way to the target.
TEST(OddNearPlane, BesideWhatOneLooksAt) {
  const BoxOnFloor ground(20);
  const std::vector<Vec3> centre{{3, 0.001F, 2}};
  const KeptInstances instances{MeshView{.positions = ground.floor},
                                SpheresView{.centers = centre, .radius = 0.001F}};
  const SceneView scene{instances};
  Camera camera{.target = {3, 0.001, 2}};
  camera.eye = camera.target + Vec3d{0, 0.006, 0.008};
  place_planes(camera, bounding_sphere(scene));
  EXPECT_LE(camera.near_plane, 0.0001F);
  FrameOptions frame{.width = 200, .height = 200};
  Image<std::int64_t> which(200, 200);
  Renderer(RendererOptions{.threads = 1}).render(scene, camera, frame, {.instances = which});
  int count = 0;
  for (const std::int64_t i : which.pixels()) count += i == 1;
  // 0.1 of the distance: 0.174 / 1.155 of half the picture.
  EXPECT_NEAR(count, 950, 40);
}

// Eight lights with shadow maps of 2048 across, a limit of 16 MiB. Right: the maps count in
// peak_bytes and in the limit, as all memory does.
TEST(OddShadows, WithinTheMemoryLimit) {
  const BoxOnFloor scene(20);
  const auto instances = scene.instances();
  FrameOptions frame{.width = 64, .height = 64, .shader = Shader::lambert};
  frame.lights.assign(8, {.kind = DirectionalLight{{1, -1.2F, 0.4F}}});
  const auto peak = [&](int size, std::uint64_t limit) {
    frame.shadows = size != 0;
    frame.shadow_size = size;
    Image<Vec4> color(64, 64);
    Renderer renderer(RendererOptions{.memory_limit = limit, .threads = 1});
    return renderer.render({instances}, close_by(true), frame, {.color = color}).peak_bytes;
  };
  // Eight pictures of at least 1024 x 512 numbers of 4 bytes.
  const std::uint64_t held = std::uint64_t{8} * 1024 * 512 * 4;
  EXPECT_GE(peak(2048, 0), peak(0, 0) + held);
  constexpr std::uint64_t kLimit = 256 << 20;
  EXPECT_LE(peak(2048, kLimit), kLimit);
  // The pictures alone are larger.
  expect_refused("", Errc::out_of_memory, [&] { (void)peak(2048, 16 << 20); });
}

// A ball of radius 1 at 5 and 60 million. Right: it fills fit_camera's picture, and its box is
// 2 wide: all of it is in float64.
TEST(OddFit, FarFromTheOrigin) {
  int at_home = 0;
  for (const double x : {0.0, 5e6, 6e7}) {
    const std::vector<Vec3d> centre{{x, -x / 2, x / 3}};
    const OneInstance ball(SpheresView{.centers = centre, .radius = 1});
    const SceneView scene = ball.view();
    const int n = covered(scene, fit_camera(scene, 0.8F, false));
    if (x == 0) at_home = n;
    EXPECT_GT(n, 10000) << x;
    EXPECT_NEAR(n, at_home, 40) << x;
    const Bounds box = bounds(scene);
    EXPECT_NEAR(box.max.x - box.min.x, 2, 1e-6) << x;
    EXPECT_NEAR((box.max.y + box.min.y) / 2, -x / 2, 1e-6) << x;
  }
}

}  // namespace

}  // namespace rastrum::test::light_troubles
