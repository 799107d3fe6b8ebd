// Transforms and quaternions against their definitions.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <rastrum/transform.hpp>

#include "tests/support/random.hpp"

namespace rastrum::test::transform_test {
namespace {

struct P {
  double x, y, z;
};

P operator*(const Mat4d& m, P p) {
  const auto row = [&](int i) {
    return m.m[i][0] * p.x + m.m[i][1] * p.y + m.m[i][2] * p.z + m.m[i][3];
  };
  return {row(0), row(1), row(2)};
}
double dot(P a, P b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
P cross(P a, P b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
P plus(P a, P b, double s = 1) {
  return {a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
}
P times(P a, double s) {
  return {a.x * s, a.y * s, a.z * s};
}
P wide(Vec3 a) {
  return {a.x, a.y, a.z};
}

void expect_near(P a, P b, double tolerance = 1e-12) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

// Not inlined: the SLP vectorizer of GCC 12 (-O3) drops the rounding of double → float → double.
[[gnu::noinline]] Vec3 random_vec(Random& r) {
  const double v[3] = {r.real(-2, 2), r.real(-2, 2), r.real(-2, 2)};
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

/// Rodrigues' formula.
P rotated(P p, P axis, double angle) {
  const P k = times(axis, 1 / std::sqrt(dot(axis, axis)));
  return plus(plus(times(p, std::cos(angle)), cross(k, p), std::sin(angle)), k,
              dot(k, p) * (1 - std::cos(angle)));
}

double determinant(const Mat4d& m) {
  const P x = m * P{1, 0, 0}, y = m * P{0, 1, 0}, z = m * P{0, 0, 1}, o = m * P{0, 0, 0};
  return dot(cross(plus(x, o, -1), plus(y, o, -1)), plus(z, o, -1));
}

TEST(Transform, TranslatesAndScales) {
  expect_near(translation({1, -2, 3}) * P{5, 7, 9}, {6, 5, 12});
  expect_near(scaling({2, -3, 0.5F}) * P{5, 7, 8}, {10, -21, 4});
  // The right factor acts first.
  expect_near(translation({1, 0, 0}) * scaling({2, 2, 2}) * P{1, 1, 1}, {3, 2, 2});
}

TEST(Transform, ReflectionIsTheMirrorImage) {
  Random r(1);
  for (int i = 0; i < 200; ++i) {
    const Vec3 n = random_vec(r);
    const P p = wide(random_vec(r));
    const double offset = r.real(-1, 1);
    const Mat4d m = reflection(n, offset);
    const P q = m * p, normal = wide(n);
    // The middle lies in the plane and the way is along the normal.
    EXPECT_NEAR(dot(times(plus(p, q), 0.5), normal), offset * dot(normal, normal), 1e-9);
    expect_near(cross(plus(q, p, -1), normal), {0, 0, 0}, 1e-9);
    expect_near(m * q, p, 1e-9);
    EXPECT_NEAR(determinant(m), -1, 1e-9);
  }
}

TEST(Transform, ShearSlidesPlanes) {
  Random r(2);
  for (int i = 0; i < 200; ++i) {
    const Vec3 n = random_vec(r), along = random_vec(r);
    const P p = wide(random_vec(r)), a = wide(along), normal = wide(n);
    expect_near(shear(along, n) * p, plus(p, a, dot(normal, p)), 1e-9);
  }
  EXPECT_NEAR(determinant(shear({0.7F, 0, -0.3F}, {0, 1, 0})), 1, 1e-12);
  expect_near(shear({0.5F, 0, 0}, {0, 1, 0}) * P{1, 2, 3}, {2, 2, 3});
}

TEST(Quaternion, RotatesAsRodriguesSays) {
  Random r(3);
  for (int i = 0; i < 500; ++i) {
    const Vec3 axis = random_vec(r);
    const P p = wide(random_vec(r));
    const double angle = r.real(-7, 7);
    const Mat4d m = rotation(rotation_about(axis, angle));
    expect_near(m * p, rotated(p, wide(axis), angle), 1e-12);
    EXPECT_NEAR(determinant(m), 1, 1e-12);
  }
  // +90° about +y turns +z to +x.
  expect_near(rotation(rotation_about({0, 1, 0}, std::numbers::pi / 2)) * P{0, 0, 1}, {1, 0, 0});
  expect_near(rotation(rotation_about({0, 0, 0}, 1)) * P{1, 2, 3}, {1, 2, 3});
}

TEST(Quaternion, TheProductIsFirstTheRightOne) {
  Random r(4);
  for (int i = 0; i < 200; ++i) {
    const Quaternion a = rotation_about(random_vec(r), r.real(-3, 3));
    const Quaternion b = rotation_about(random_vec(r), r.real(-3, 3));
    const P p = wide(random_vec(r));
    expect_near(rotation(a * b) * p, rotation(a) * (rotation(b) * p));
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
    const P p = wide(random_vec(r));
    const P want = rotation(rotation_about(axis, angle * t) * a) * p;
    expect_near(rotation(slerp(a, b, t)) * p, want, 1e-9);
    // −b is the same rotation.
    expect_near(rotation(slerp(a, {-b.w, -b.x, -b.y, -b.z}, t)) * p, want, 1e-9);
  }
  // Ends, and two that are nearly the same.
  const Quaternion a = rotation_about({1, 2, 3}, 1), b = rotation_about({1, 2, 3}, 1 + 1e-11);
  EXPECT_NEAR(dot(slerp(a, b, 0.5), a), 1, 1e-15);
  const Quaternion c = rotation_about({0, 1, 0}, 2);
  EXPECT_NEAR(dot(slerp(a, c, 0), a), 1, 1e-15);
  EXPECT_NEAR(dot(slerp(a, c, 1), c), 1, 1e-15);
}

}  // namespace
}  // namespace rastrum::test::transform_test
