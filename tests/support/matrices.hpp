// SPDX-License-Identifier: BSD-3-Clause
// Products with matrices by their definition, and comparisons with a tolerance.
#pragma once

#include <gtest/gtest.h>

#include <rastrum/mat.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::test {

struct Clip {
  double x, y, z, w;
};
/// m · (p, 1).
[[nodiscard]] inline Clip clip_of(const Mat4d& m, Vec3d p) {
  const auto row = [&](int i) {
    return m.m[i][0] * p.x + m.m[i][1] * p.y + m.m[i][2] * p.z + m.m[i][3];
  };
  return {row(0), row(1), row(2), row(3)};
}
[[nodiscard]] inline Vec3d place_of(const Mat4d& m, Vec3d p) {
  const Clip c = clip_of(m, p);
  return {c.x, c.y, c.z};
}

inline void expect_near(Vec3d a, Vec3d b, double within = 1e-12) {
  EXPECT_NEAR(a.x, b.x, within);
  EXPECT_NEAR(a.y, b.y, within);
  EXPECT_NEAR(a.z, b.z, within);
}
inline void expect_near(const Mat4d& a, const Mat4d& b, double within = 1e-12) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) EXPECT_NEAR(a.m[i][j], b.m[i][j], within) << i << ", " << j;
}

}  // namespace rastrum::test
