// SPDX-License-Identifier: BSD-3-Clause
// Isolines (docs/scalar_rules.md): their width in pixels does not depend on the distance. They
// appear on meshes, along lines and along the axes of cylinders, cones and tubes, but not on
// constant numbers.
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/camera.hpp>
#include <rastrum/raster/rules/quadric_surface.hpp>
#include <rastrum/render.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::isolines_test {

constexpr int kSize = 101;

/// White with black lines 3 px wide.
ScalarMapping lines_at(std::vector<double> levels) {
  return ScalarMapping{.map = {"white", {{1, 1, 1, 1}}, false},
                       .range = ScalarRange{0, 1},
                       .isolines = std::move(levels),
                       .isoline_px = 3};
}

/// Views the square in perspective, as if it lay back.
Camera camera_from_below() {
  return Camera{
      .eye = {0.5, -0.5, 0.4}, .target = {0.5, 0.5, 0}, .fov_rad = 0.8F, .near_plane = 0.01F};
}

Frame draw(const GeometryView& geometry, const ScalarMapping& mapping, const Camera& camera) {
  const OneInstance instance(geometry);
  SceneView scene = instance.view();
  scene.scalar_mappings = {&mapping, 1};
  return test::draw({.threads = 1}, scene, camera,
                    {.width = kSize, .height = kSize, .shader = Shader::flat},
                    kColor | kIds | kAlbedo);
}

/// How much of an isoline a row of pixels has.
double darkness(const Frame& p, int y) {
  double sum = 0;
  for (int x = 0; x < kSize; ++x)
    if (p.ids(x, y) >= 0) sum += 1 - double{p.color(x, y).x};
  return sum;
}

const std::vector<float> kAcross{0, 1, 1, 0};

TEST(Isolines, AreAsWideAtEveryDistance) {
  MeshView square{.positions = kSquare, .indices = kTwoTriangles, .scalars = {kAcross}};
  const ScalarMapping mapping = lines_at({0.5});
  const Frame p = draw(square, mapping, square_camera());
  for (int y = 2; y < 99; ++y) {
    ASSERT_NEAR(darkness(p, y), 3, 1e-4) << y;
    ASSERT_EQ(p.color(50, y).x, 0);
  }
  const Frame back = draw(square, mapping, camera_from_below());
  int rows = 0;
  for (int y = 0; y < kSize; ++y) {
    if (back.ids(50, y) < 0) continue;
    ++rows;
    ASSERT_GT(back.color(44, y).x, 0.99) << y;
    ASSERT_EQ(back.color(50, y).x, 0) << y;
  }
  EXPECT_GT(rows, 20);
}

const std::vector<Vec3> kAxis{{0.1F, 0.5F, 0}, {0.9F, 0.5F, 0}};
const std::vector<float> kAlongAxis{2, 6};
const std::vector<float> kRadii{0.2F, 0.05F};

TEST(Isolines, CrossLinesAndTheAxesOfCylindersConesAndTubes) {
  const ScalarMapping mapping = lines_at({4.5});
  const auto check = [&](const char* name, const GeometryView& geometry, int row, int column = 60) {
    SCOPED_TRACE(name);
    const Frame p = draw(geometry, mapping, square_camera());
    ASSERT_GE(p.ids(column, row), 0);
    EXPECT_NEAR(darkness(p, row), 3, 1e-4);
    EXPECT_EQ(p.color(column, row).x, 0);
    EXPECT_EQ(p.albedo(column, row).x, 0);
    EXPECT_EQ(p.color(50, row).x, 1);
    EXPECT_EQ(p.albedo(50, row).x, 1);
  };
  check("lines", LinesView{.positions = kAxis, .line_width = 9, .scalars = kAlongAxis}, 52);
  const CylindersView cylinders{.positions = kAxis, .radius = 0.1F, .scalars = kAlongAxis};
  check("cylinders", cylinders, 50);
  check("cylinders, off the middle", cylinders, 57);
  check("cones", CylindersView{.positions = kAxis, .radii = kRadii, .scalars = kAlongAxis}, 50);
  check("tubes", TubesView{.positions = kAxis, .radius = 0.1F, .scalars = kAlongAxis}, 55);
  // A number's circle is where its place's ball touches the tube: 0.106 · 0.15 / 0.8 farther.
  check("tubes of two radii", TubesView{.positions = kAxis, .radii = kRadii, .scalars = kAlongAxis},
        50, 62);
}

TEST(Isolines, AreNotWhereThereIsOneNumber) {
  const std::vector<float> same{4.5F, 4.5F};
  const ScalarMapping mapping = lines_at({4.5});
  const std::vector<Vec3> up{{0, 0, 1}, {0, 0, 1}};
  const auto check = [&](const char* name, const GeometryView& geometry) {
    SCOPED_TRACE(name);
    const Frame p = draw(geometry, mapping, square_camera());
    ASSERT_GE(p.ids(10, 50), 0);
    for (int y = 0; y < kSize; ++y) ASSERT_EQ(darkness(p, y), 0) << y;
  };
  check("points", PointsView{.positions = kAxis, .point_size = 9, .scalars = same});
  check("lines", LinesView{.positions = kAxis, .line_width = 5, .scalars = same});
  check("spheres", SpheresView{.centers = kAxis, .radius = 0.1F, .scalars = same});
  check("discs", DiscsView{.centers = kAxis, .normals = up, .radius = 0.1F, .scalars = same});
  check("cylinders", CylindersView{.positions = kAxis, .radius = 0.1F, .scalars = same});
  check("tubes", TubesView{.positions = kAxis, .radius = 0.1F, .scalars = same});
  // Nor is there a line on the flat end, which has the number of the level everywhere.
  const std::vector<Vec3> towards{{0.1F, 0.5F, -0.5F}, {0.1F, 0.5F, 0}};
  const std::vector<float> to_level{2, 4.5F};
  check("an end", CylindersView{.positions = towards, .radius = 0.1F, .scalars = to_level});
}

/// Compares with differences of point_on beside the pixel, in perspective and under a shearing
/// matrix.
TEST(Isolines, KnowHowThePlaceOnTheAxisChanges) {
  Camera camera{.eye = {1.5, 2, 3}, .target = {0, 0, 0}, .fov_rad = 0.7F, .near_plane = 0.5F};
  Mat4d to_world = Mat4d::identity();
  to_world.m[0][1] = 0.3;
  to_world.m[2][0] = -0.2;
  const Mat4d to_clip = world_to_clip(camera, kSize, kSize) * to_world;
  const raster::Viewport viewport = raster::Viewport::of(kSize, kSize);
  Random random(7);
  int seen = 0, flat = 0;
  for (int k = 0; k < 60; ++k) {
    std::vector<Vec3> ends;
    std::vector<float> radii;
    const auto real = [&](double a, double b) { return random.real32(a, b); };
    for (int i = 0; i < 2; ++i) {
      ends.push_back({real(-0.8, 0.8), real(-0.8, 0.8), real(-0.8, 0.8)});
      radii.push_back(real(0.1, 0.3));
    }
    const raster::QuadricGeometry kinds[] = {
        CylindersView{.positions = ends, .radii = radii},
        CylindersView{.positions = ends, .radii = radii, .caps = false},
        TubesView{.positions = ends, .radii = radii}};
    const raster::QuadricStage stage(kinds[k % 3], to_clip);
    raster::QuadricSurface surface;
    if (!surface.find(stage, 0, viewport)) continue;
    for (int y = 1; y < kSize; y += 3)
      for (int x = 1; x < kSize; x += 3)
        for (const bool away : {false, true}) {
          const auto along = [&](double dx, double dy, bool& there) {
            raster::QuadricSurface::Place at = surface.at(x, y);
            at.dx += dx;
            at.dy += dy;
            const raster::scalar_wide::Surface side = surface.side(away, at);
            there &= side.covered;
            return raster::point_on(surface.shape, surface.point(at, side.e)).along;
          };
          const raster::QuadricSurface::Place at = surface.at(x, y);
          const raster::scalar_wide::Surface side = surface.side(away, at);
          if (!side.covered) continue;
          const raster::RayFrame::Point h = surface.point(at, side.e);
          const double found = surface.along_per_px(h, raster::point_on(surface.shape, h));
          constexpr double kStep = 1e-3;
          bool there = true;
          const double left = along(-kStep, 0, there), right = along(kStep, 0, there);
          const double above = along(0, -kStep, there), below = along(0, kStep, there);
          if (!there) continue;
          const double middle = along(0, 0, there);
          // Where an end meets a side, and near silhouettes, differences are meaningless.
          const double bent =
              std::abs(left + right - 2 * middle) + std::abs(above + below - 2 * middle);
          const double expected = std::hypot(right - left, below - above) / (2 * kStep);
          if (bent > 1e-6 * expected * 2 * kStep + 1e-9) continue;
          ++seen;
          flat += found == 0 ? 1 : 0;
          ASSERT_NEAR(found, expected, 1e-5 * expected + 1e-7) << k << ": " << x << ", " << y;
        }
  }
  EXPECT_GT(seen, 1000);
  EXPECT_GT(flat, 100);
}

}  // namespace rastrum::test::isolines_test
