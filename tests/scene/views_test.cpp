// SPDX-License-Identifier: BSD-3-Clause
// Views by name and angle: the eye's place, the up direction, and the picture's size.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/fit.hpp>

#include "tests/support/matrices.hpp"

namespace rastrum::test::views_test {
namespace {

void expect_view(const View& v, Vec3d eye, Vec3d up) {
  expect_near(v.direction, -eye, 1e-15);
  expect_near(v.up, up, 1e-15);
}

TEST(Views, HaveTheirNames) {
  expect_view(view_of(ViewName::front), {0, 0, 1}, {0, 1, 0});
  expect_view(view_of(ViewName::back), {0, 0, -1}, {0, 1, 0});
  expect_view(view_of(ViewName::right), {1, 0, 0}, {0, 1, 0});
  expect_view(view_of(ViewName::left), {-1, 0, 0}, {0, 1, 0});
  expect_view(view_of(ViewName::top), {0, 1, 0}, {0, 0, -1});
  expect_view(view_of(ViewName::bottom), {0, -1, 0}, {0, 0, 1});
  EXPECT_EQ(view_names().size(), static_cast<std::size_t>(ViewName::iso) + 1);
  // CAD's axes: the front looks along +y.
  const Vec3d z{0, 0, 2};
  expect_view(view_of(ViewName::front, z), {0, -1, 0}, {0, 0, 1});
  expect_view(view_of(ViewName::right, z), {1, 0, 0}, {0, 0, 1});
  expect_view(view_of(ViewName::top, z), {0, 0, 1}, {0, 1, 0});
  expect_view(view_of(ViewName::front, {0, -1, 0}), {0, 0, -1}, {0, -1, 0});
  const View iso = view_of(ViewName::iso);
  const double third = 1 / std::sqrt(3.0);
  expect_near(iso.direction, {-third, -third, -third}, 1e-15);
  expect_near(iso.up, Vec3d{-1, 2, -1} * (1 / std::sqrt(6.0)), 1e-15);
}

TEST(Views, AreAtRightAnglesAndOfUnitLength) {
  for (const Vec3d up : {Vec3d{0, 1, 0},
                         {0, 0, 1},
                         {1, 0, 0},
                         {0, -1, 0},
                         {1e-7, -1, 2e-7},
                         {1, 2, -3},
                         {-2, -1, 0.5}})
    for (int i = 0; i <= static_cast<int>(ViewName::iso); ++i)
      for (const Turn& by : {Turn{}, Turn{30, 0, 0}, Turn{-70, 0, 45}, Turn{0, 0, 180}}) {
        const View v = turned(view_of(static_cast<ViewName>(i), up), by, up);
        EXPECT_NEAR(length(v.direction), 1, 1e-14);
        EXPECT_NEAR(length(v.up), 1, 1e-14);
        EXPECT_NEAR(dot(v.direction, v.up), 0, 1e-14);
      }
}

TEST(Views, Turn) {
  const View front = view_of(ViewName::front);
  expect_view(turned(front, {90, 0, 0}), {1, 0, 0}, {0, 1, 0});
  expect_view(turned(front, {-90, 0, 0}), {-1, 0, 0}, {0, 1, 0});
  expect_view(turned(front, {0, 90, 0}), {0, 1, 0}, {0, 0, -1});
  expect_view(turned(front, {0, -90, 0}), {0, -1, 0}, {0, 0, 1});
  expect_view(turned(front, {90, 90, 0}), {0, 1, 0}, {-1, 0, 0});
  // The picture turns counter-clockwise: up becomes left.
  expect_view(turned(front, {0, 0, 90}), {0, 0, 1}, {1, 0, 0});
  const View a = turned(front, {0, 30, 0});
  expect_near(a.direction, {0, -0.5, -std::sqrt(0.75)}, 1e-15);
  expect_near(a.up, {0, std::sqrt(0.75), -0.5}, 1e-15);
  EXPECT_THROW((void)turned(front, {0, 91, 0}), Error);
  EXPECT_THROW((void)turned(a, {0, 61, 0}), Error);
  EXPECT_NO_THROW((void)turned(a, {0, 60, 0}));
  EXPECT_THROW((void)turned(front, {std::nan(""), 0, 0}), Error);
  EXPECT_THROW((void)turned(front, {0, 360, 0}), Error);
  EXPECT_THROW((void)view_of(ViewName::iso, {0, 0, 0}), Error);
}

TEST(Views, Zoom) {
  Camera c;
  EXPECT_NEAR(std::tan(double{zoomed(c, 2).fov_rad} / 2), std::tan(double{c.fov_rad} / 2) / 2,
              1e-7);
  EXPECT_EQ(zoomed(c, 4).orthographic_height, 0.5F);
  EXPECT_EQ(zoomed(c, 1).fov_rad, c.fov_rad);
  for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_THROW((void)zoomed(c, bad), Error);
  c.matrix = Mat4d::identity();
  EXPECT_THROW((void)zoomed(c, 2), Error);
}

}  // namespace
}  // namespace rastrum::test::views_test
