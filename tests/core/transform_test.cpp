// SPDX-License-Identifier: BSD-3-Clause
// Transforms and quaternions against their definitions.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <rastrum/transform.hpp>

#include "tests/support/matrices.hpp"
#include "tests/support/random.hpp"

namespace rastrum::test::transform_test {
namespace {

// Not inlined: the SLP vectorizer of GCC 12 (-O3) drops the rounding of double → float → double.
[[gnu::noinline]] Vec3 random_vec(Random& r) {
  const double v[3] = {r.real(-2, 2), r.real(-2, 2), r.real(-2, 2)};
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

/// Rodrigues' formula.
Vec3d rotated(Vec3d p, Vec3d axis, double angle) {
  const Vec3d k = normalize(axis);
  return p * std::cos(angle) + cross(k, p) * std::sin(angle) +
         k * (dot(k, p) * (1 - std::cos(angle)));
}

double determinant(const Mat4d& m) {
  const Vec3d o = place_of(m, {0, 0, 0});
  return dot(cross(place_of(m, {1, 0, 0}) - o, place_of(m, {0, 1, 0}) - o),
             place_of(m, {0, 0, 1}) - o);
}

TEST(Transform, TranslatesAndScales) {
  expect_near(place_of(translation({1, -2, 3}), {5, 7, 9}), {6, 5, 12});
  expect_near(place_of(scaling({2, -3, 0.5F}), {5, 7, 8}), {10, -21, 4});
  // The right factor acts first.
  expect_near(place_of(translation({1, 0, 0}) * scaling({2, 2, 2}), {1, 1, 1}), {3, 2, 2});
}

TEST(Transform, ReflectionIsTheMirrorImage) {
  Random r(1);
  for (int i = 0; i < 200; ++i) {
    const Vec3d normal(random_vec(r)), p(random_vec(r));
    const double offset = r.real(-1, 1);
    const Mat4d m = reflection(normal, offset);
    const Vec3d q = place_of(m, p);
    // The midpoint lies in the plane, and the displacement is along the normal.
    EXPECT_NEAR(dot((p + q) * 0.5, normal), offset * dot(normal, normal), 1e-9);
    expect_near(cross(q - p, normal), {0, 0, 0}, 1e-9);
    expect_near(place_of(m, q), p, 1e-9);
    EXPECT_NEAR(determinant(m), -1, 1e-9);
  }
}

TEST(Transform, ShearSlidesPlanes) {
  Random r(2);
  for (int i = 0; i < 200; ++i) {
    const Vec3d normal(random_vec(r)), along(random_vec(r)), p(random_vec(r));
    expect_near(place_of(shear(along, normal), p), p + along * dot(normal, p), 1e-9);
  }
  EXPECT_NEAR(determinant(shear({0.7F, 0, -0.3F}, {0, 1, 0})), 1, 1e-12);
  expect_near(place_of(shear({0.5F, 0, 0}, {0, 1, 0}), {1, 2, 3}), {2, 2, 3});
}

TEST(Quaternion, RotatesAsRodriguesSays) {
  Random r(3);
  for (int i = 0; i < 500; ++i) {
    const Vec3 axis = random_vec(r);
    const Vec3d p(random_vec(r));
    const double angle = r.real(-7, 7);
    const Mat4d m = rotation(rotation_about(axis, angle));
    expect_near(place_of(m, p), rotated(p, Vec3d(axis), angle));
    EXPECT_NEAR(determinant(m), 1, 1e-12);
  }
  // +90° about +y turns +z to +x.
  expect_near(place_of(rotation(rotation_about({0, 1, 0}, std::numbers::pi / 2)), {0, 0, 1}),
              {1, 0, 0});
  expect_near(place_of(rotation(rotation_about({0, 0, 0}, 1)), {1, 2, 3}), {1, 2, 3});
}

TEST(Quaternion, TheProductIsFirstTheRightOne) {
  Random r(4);
  for (int i = 0; i < 200; ++i) {
    const Quaternion a = rotation_about(random_vec(r), r.real(-3, 3));
    const Quaternion b = rotation_about(random_vec(r), r.real(-3, 3));
    const Vec3d p(random_vec(r));
    expect_near(place_of(rotation(a * b), p), place_of(rotation(a), place_of(rotation(b), p)));
  }
  const Quaternion q = normalize({3, 0, 4, 0});
  EXPECT_NEAR(q.w, 0.6, 1e-15);
  EXPECT_NEAR(q.y, 0.8, 1e-15);
  EXPECT_EQ(normalize({0, 0, 0, 0}).w, 1);
}

TEST(Quaternion, SlerpTurnsAtConstantSpeedTheShorterWay) {
  Random r(5);
  for (int i = 0; i < 300; ++i) {
    const Vec3 axis = random_vec(r);
    const double angle = r.real(0, 3.1), t = r.real(0, 1);
    const Quaternion a = rotation_about(random_vec(r), r.real(-3, 3));
    const Quaternion b = rotation_about(axis, angle) * a;
    const Vec3d p(random_vec(r));
    const Vec3d want = place_of(rotation(rotation_about(axis, angle * t) * a), p);
    expect_near(place_of(rotation(slerp(a, b, t)), p), want, 1e-9);
    // −b is the same rotation as b.
    expect_near(place_of(rotation(slerp(a, {-b.w, -b.x, -b.y, -b.z}, t)), p), want, 1e-9);
  }
  // The ends, and two nearly equal rotations.
  const Quaternion a = rotation_about({1, 2, 3}, 1), b = rotation_about({1, 2, 3}, 1 + 1e-11);
  EXPECT_NEAR(dot(slerp(a, b, 0.5), a), 1, 1e-15);
  const Quaternion c = rotation_about({0, 1, 0}, 2);
  EXPECT_NEAR(dot(slerp(a, c, 0), a), 1, 1e-15);
  EXPECT_NEAR(dot(slerp(a, c, 1), c), 1, 1e-15);
}

}  // namespace
}  // namespace rastrum::test::transform_test
