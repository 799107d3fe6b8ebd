// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/camera.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/matrices.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::camera_test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A camera that looks from (3, −2, 5) in an arbitrary direction.
Camera oblique() {
  return Camera{.eye = {3, -2, 5},
                .target = {-1, 4, 2},
                .up = {0.2F, 1, -0.3F},
                .near_plane = 0.5F,
                .far_plane = 20};
}

/// The world point at camera coordinates (right, up, distance in front of the eye).
Clip project(const Camera& c, int width, int height, double right, double up, double distance) {
  const Mat4d v = world_to_camera(c);
  // The inverse of a rigid motion: world = Rᵀ (p − t).
  const double p[3] = {right - v.m[0][3], up - v.m[1][3], -distance - v.m[2][3]};
  const auto world = [&](int i) { return v.m[0][i] * p[0] + v.m[1][i] * p[1] + v.m[2][i] * p[2]; };
  return clip_of(world_to_clip(c, width, height), {world(0), world(1), world(2)});
}

TEST(Camera, IsARigidMotionThatPutsTheTargetAhead) {
  const Camera c = oblique();
  const Mat4d v = world_to_camera(c);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      double d = 0;
      for (int k = 0; k < 3; ++k) d += v.m[i][k] * v.m[j][k];
      EXPECT_NEAR(d, i == j ? 1 : 0, 1e-12);
    }
  const auto& m = v.m;
  const double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                             m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  EXPECT_NEAR(determinant, 1, 1e-12);
  expect_near(place_of(v, c.eye), {0, 0, 0});
  expect_near(place_of(v, c.target), {0, 0, -std::sqrt(16.0 + 36.0 + 9.0)});
  // `up` appears upward, not to the side.
  const Vec3d up = place_of(v, c.eye + c.up);
  EXPECT_NEAR(up.x, 0, 1e-6);
  EXPECT_GT(up.y, 0);
}

TEST(Camera, AlongMinusZIsTheIdentityButForTheShift) {
  Camera c{.eye = {1, 2, 3}, .target = {1, 2, 0}};
  expect_near(world_to_camera(c), {{{1, 0, 0, -1}, {0, 1, 0, -2}, {0, 0, 1, -3}, {0, 0, 0, 1}}}, 0);
}

TEST(Camera, NearHasDepthOneAndFarZero) {
  Camera c = oblique();
  for (const bool orthographic : {false, true}) {
    c.orthographic = orthographic;
    const Clip near = project(c, 640, 480, 0.1, -0.2, 0.5);
    EXPECT_NEAR(near.z / near.w, 1, 1e-7);
    const Clip far = project(c, 640, 480, 1, 2, 20);
    EXPECT_NEAR(far.z / far.w, 0, 1e-7);
    const Clip between = project(c, 640, 480, 1, 2, 7);
    EXPECT_GT(between.z / between.w, 0);
    EXPECT_LT(between.z / between.w, 1);
    EXPECT_NEAR(between.w, orthographic ? 1 : 7, 1e-6);
  }
}

TEST(Camera, InfiniteFarGivesNearOverDistance) {
  Camera c = oblique();
  c.far_plane = kInfinity;
  for (const double distance : {0.5, 1.0, 10.0, 1e6}) {
    const Clip p = project(c, 640, 480, 0.3, 0.1, distance);
    EXPECT_NEAR(p.z / p.w, 0.5 / distance, 1e-6 * (0.5 / distance));
  }
}

TEST(Camera, FieldOfViewSpansTheSmallerSide) {
  Camera c = oblique();
  c.fov_rad = 1.2F;
  const double reach = 7 * std::tan(0.6);
  for (const auto& [w, h] : {std::pair{800, 400}, {400, 800}, {500, 500}}) {
    const double sx = w > h ? static_cast<double>(w) / h : 1;
    const double sy = h > w ? static_cast<double>(h) / w : 1;
    const Clip p = project(c, w, h, reach * sx, -reach * sy, 7);
    EXPECT_NEAR(p.x / p.w, 1, 1e-6);
    EXPECT_NEAR(p.y / p.w, -1, 1e-6);
    c.orthographic = true;
    c.orthographic_height = 6;
    const Clip q = project(c, w, h, 3 * sx, -3 * sy, 7);
    EXPECT_NEAR(q.x / q.w, 1, 1e-6);
    EXPECT_NEAR(q.y / q.w, -1, 1e-6);
    c.orthographic = false;
  }
}

TEST(Camera, OrthographicNearMayLieBehindTheEye) {
  Camera c = oblique();
  c.orthographic = true;
  c.near_plane = -3;
  const Clip p = project(c, 100, 100, 0, 0, -3);
  EXPECT_NEAR(p.z / p.w, 1, 1e-7);
}

TEST(Camera, InvalidParametersAreNamed) {
  const auto expect = [](const char* part, const std::function<void(Camera&)>& change) {
    Camera c = oblique();
    change(c);
    expect_refused(part, [&] { static_cast<void>(world_to_clip(c, 640, 480)); });
  };
  expect("near", [](Camera& c) { c.near_plane = 0; });
  expect("near", [](Camera& c) { c.near_plane = -1; });
  expect("near", [](Camera& c) { c.near_plane = kNan; });
  expect("near", [](Camera& c) { c.near_plane = kInfinity; });
  expect("far", [](Camera& c) { c.far_plane = 0.5F; });
  expect("far", [](Camera& c) { c.far_plane = kNan; });
  expect("field of view", [](Camera& c) { c.fov_rad = 0; });
  expect("field of view", [](Camera& c) { c.fov_rad = 3.2F; });
  expect("field of view, in radians", [](Camera& c) { c.fov_rad = 60; });
  expect("field of view", [](Camera& c) { c.fov_rad = kNan; });
  expect("eye and target", [](Camera& c) { c.target = c.eye; });
  expect("eye and target", [](Camera& c) { c.eye.y = kNan; });
  expect("eye and target", [](Camera& c) { c.target.x = kInfinity; });
  expect("up", [](Camera& c) { c.up = {0, 0, 0}; });
  expect("up", [](Camera& c) { c.up = c.target - c.eye; });
  expect("up", [](Camera& c) { c.up.z = kNan; });
  const auto flat = [&](const char* part, float height, float far) {
    expect(part, [&](Camera& c) {
      c.orthographic = true;
      c.orthographic_height = height;
      c.far_plane = far;
    });
  };
  flat("orthographic height", 0, 20);
  flat("orthographic height", kInfinity, 20);
  flat("far", 2, kInfinity);
}

}  // namespace
}  // namespace rastrum::test::camera_test
