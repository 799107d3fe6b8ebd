// SPDX-License-Identifier: BSD-3-Clause
// Cameras in others' conventions, against their formulas in float64.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/camera.hpp>
#include <rastrum/error.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/transform.hpp>

#include "tests/support/matrices.hpp"
#include "tests/support/random.hpp"

#include "tests/support/refused.hpp"

namespace rastrum::test::lens_test {
namespace {

constexpr int kWidth = 641, kHeight = 480;

struct Seen {
  double x, y, depth, w;  ///< px from the top left corner, reversed depth
};
/// In float64, as the renderer's float32 rows have it before snapping.
Seen see(const Camera& camera, Vec3d p, int width = kWidth, int height = kHeight) {
  const Clip c = clip_of(world_to_clip(camera, width, height), p);
  return {(c.x / c.w + 1) / 2 * width, (1 - c.y / c.w) / 2 * height, c.z / c.w, c.w};
}

Mat4d random_pose(Random& r, double reach) {
  const Vec3d axis{r.real(-1, 1), r.real(-1, 1), r.real(-1, 1)};
  Mat4d m = rotation(rotation_about(axis, r.real(-3, 3)));
  m.m[0][3] = r.real(-reach, reach);
  m.m[1][3] = r.real(-reach, reach);
  m.m[2][3] = r.real(-reach, reach);
  return m;
}
TEST(Lens, OpenCvSeesAPointWhereItsFormulaSays) {
  Random r(1);
  for (int n = 0; n < 2000; ++n) {
    // Up to coordinates of seven digits.
    const double reach = n % 2 == 0 ? 10 : 5e6;
    const Mat4d pose = random_pose(r, reach);
    const Intrinsics k{r.real(200, 2000), r.real(200, 2000), r.real(-200, 900),
                       r.real(-200, 700), r.real(-50, 50),   n % 3 == 0 ? 0.5 : 0.0};
    const Camera camera = camera_from_opencv(k, pose, kWidth, kHeight, 0.25);
    const Vec3d seen{r.real(-3, 3), r.real(-3, 3), r.real(0.5, 20)};
    const Vec3d world = place_of(inverse(pose).value(), seen);
    const Vec3d p = place_of(pose, world);
    const double u = (k.fx * p.x + k.skew * p.y) / p.z + k.cx, v = k.fy * p.y / p.z + k.cy;
    const Seen s = see(camera, world);
    constexpr double kSnap = 1.0 / 256;
    ASSERT_NEAR(s.x, u + 0.5 - k.first_centre, kSnap) << n;
    ASSERT_NEAR(s.y, v + 0.5 - k.first_centre, kSnap) << n;
    ASSERT_NEAR(s.depth, 0.25 / p.z, 1e-6);
    ASSERT_NEAR(view_distance(camera, static_cast<float>(s.depth)), p.z, 1e-5 * p.z);
    // The axes from the matrix are the pose's, with y and z negated.
    const Mat4d axes = world_to_camera(camera);
    const Vec3d c = place_of(axes, world);
    expect_near(c, {p.x, -p.y, -p.z}, 1e-6);
  }
}

TEST(Lens, OpenCvIsTheCameraOfAFieldOfView) {
  Camera camera{.fov_rad = 1, .near_plane = 0.5F};
  const double f = kHeight / 2.0 / std::tan(0.5);
  Mat4d pose = world_to_camera(camera);
  for (int axis : {1, 2})
    for (double& v : pose.m[axis]) v = -v;
  const Mat4d ours = world_to_clip(camera, kWidth, kHeight);
  const Mat4d others =
      world_to_clip(camera_from_opencv({f, f, (kWidth - 1) / 2.0, (kHeight - 1) / 2.0}, pose,
                                       kWidth, kHeight, 0.5),
                    kWidth, kHeight);
  expect_near(ours, others);
}

TEST(Lens, AnyMatrixIsReadBack) {
  Random r(2);
  for (int n = 0; n < 300; ++n) {
    Camera c{.eye = {r.real(-5, 5), r.real(-5, 5), r.real(-5, 5)}};
    c.target = c.eye + Vec3d{r.real(-1, 1), r.real(-0.5, 0.5), 1};
    c.near_plane = static_cast<float>(r.real(0.1, 1));
    c.orthographic = n % 2 == 0;
    if (c.orthographic || n % 3 == 0) c.far_plane = static_cast<float>(r.real(20, 100));
    const Mat4d clip = world_to_clip(c, kWidth, kHeight);
    const ClipDepth depths[] = {ClipDepth::opengl, ClipDepth::zero_to_one, ClipDepth::reversed};
    const ClipDepth kind = depths[n % 3];
    Mat4d given = clip;
    for (int j = 0; j < 4; ++j) {
      const double z = clip.m[2][j], w = clip.m[3][j];
      if (kind == ClipDepth::opengl) given.m[2][j] = w - 2 * z;
      if (kind == ClipDepth::zero_to_one) given.m[2][j] = w - z;
    }
    const Camera made = camera_from_matrix(given, kind);
    expect_near(*made.matrix, clip);
    const Mat4d wants = world_to_camera(c), has = world_to_camera(made);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) ASSERT_NEAR(has.m[i][j], wants.m[i][j], 1e-9) << n;
    for (const float d : {0.9F, 0.3F, 0.02F})
      ASSERT_NEAR(view_distance(made, d) + (c.orthographic ? double{c.near_plane} : 0.0),
                  view_distance(c, d), 1e-6 * view_distance(c, d));
  }
}

TEST(Lens, ATiltedDepthTellsNoDistance) {
  Camera c;
  c.matrix = world_to_clip(c, 8, 8);
  c.matrix->m[2][0] += 0.1;
  EXPECT_THROW((void)view_distance(c, 0.5F), Error);
}

TEST(Lens, OrthographicByScaleHasItsUnitsAPixel) {
  for (const auto& [width, height] : {std::pair{300, 200}, {100, 700}}) {
    Camera c{.far_plane = 10};
    c = orthographic_by_scale(c, 0.25, width, height);
    EXPECT_NEAR(see(c, {0.25, 0, 0}, width, height).x - see(c, {0, 0, 0}, width, height).x, 1,
                1e-6);
    EXPECT_NEAR(see(c, {0, 0.25, 0}, width, height).y - see(c, {0, 0, 0}, width, height).y, -1,
                1e-6);
  }
}

TEST(Lens, FitsAlongAnyDirection) {
  const std::vector<Vec3> positions{{1, 2, 3}, {3, 2, 3}, {1, 5, 4}};
  const MeshView mesh{.positions = positions};
  const InstanceView instance{mesh};
  const SceneView scene{.instances = {&instance, 1}};
  for (const Vec3d direction : {Vec3d{1, 0, 0}, {0, -3, 0.1}, {-1, 1, 2}}) {
    const Camera c = fit_camera(scene, 1, false, direction, {0, 0, 1});
    const Vec3d looks = normalize(c.target - c.eye), wants = normalize(direction);
    EXPECT_NEAR(dot(looks, wants), 1, 1e-6);
    EXPECT_NEAR(length(c.eye - c.target), length(fit_camera(scene, 1, false).eye - c.target), 1e-5);
    for (const Vec3 p : positions) {
      const Seen s = see(c, p, 100, 100);
      EXPECT_TRUE(s.x > 0 && s.x < 100 && s.y > 0 && s.y < 100 && s.depth < 1 && s.w > 0);
    }
  }
  EXPECT_THROW((void)fit_camera(scene, 1, false, {0, 0, 0}), Error);
  EXPECT_THROW((void)fit_camera(scene, 1, false, {0, 1, 0}), Error);
}

TEST(Lens, InverseUndoes) {
  Random r(3);
  for (int n = 0; n < 200; ++n) {
    Mat4d m;
    for (auto& row : m.m)
      for (double& v : row) v = r.real(-1, 1) * (n % 2 == 0 ? 1 : 1e6);
    const Mat4d one = m * inverse(m).value();
    expect_near(one, Mat4d::identity(), 1e-8);
  }
  Mat4d singular = Mat4d::identity();
  singular.m[2][2] = 0;
  EXPECT_FALSE(inverse(singular));
  singular.m[2][2] = std::nan("");
  EXPECT_FALSE(inverse(singular));
}

TEST(Lens, MatricesOfOthersAreReadInTheirOrder) {
  const float f[16] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
  EXPECT_EQ(matrix_from_rows(f).m[1][2], 7);
  EXPECT_EQ(matrix_from_columns(f).m[1][2], 10);
  const double d[16] = {0, 1};
  EXPECT_EQ(matrix_from_rows(d).m[0][1], 1);
  EXPECT_EQ(matrix_from_columns(d).m[1][0], 1);
}

TEST(Lens, RefusesWhatNoCameraHas) {
  const Intrinsics k{500, 500, 320, 240};
  const Mat4d pose = Mat4d::identity();
  const auto cv = [](Intrinsics i, Mat4d m, int w = 640, double near = 0.1) {
    return [=] { (void)camera_from_opencv(i, m, w, 480, near); };
  };
  expect_refused("fx and fy", cv({0, 500, 1, 1}, pose));
  expect_refused("fx and fy", cv({500, -500, 1, 1}, pose));
  expect_refused("fx and fy", cv({std::nan(""), 500, 1, 1}, pose));
  expect_refused("cx, cy", cv({500, 500, std::nan(""), 1}, pose));
  expect_refused("pixel", cv(k, pose, 0));
  expect_refused("near", cv(k, pose, 640, 0));
  expect_refused("near", cv(k, pose, 640, std::nan("")));
  Mat4d bad = pose;
  bad.m[0][0] = 2;
  expect_refused("rotation", cv(k, bad));
  bad.m[0][0] = -1;
  expect_refused("rotation", cv(k, bad));
  bad = pose;
  bad.m[3][0] = 4;
  expect_refused("column-major", cv(k, bad));
  bad.m[0][3] = std::nan("");
  expect_refused("finite", cv(k, bad));
  bad = {};
  expect_refused("singular", [&] { (void)camera_from_matrix(bad, ClipDepth::opengl); });
  bad.m[0][0] = std::nan("");
  expect_refused("finite", [&] { (void)camera_from_matrix(bad, ClipDepth::opengl); });
  expect_refused("units", [] { (void)orthographic_by_scale({}, 0, 8, 8); });
  expect_refused("units", [] { (void)orthographic_by_scale({}, std::nan(""), 8, 8); });
}

}  // namespace
}  // namespace rastrum::test::lens_test
