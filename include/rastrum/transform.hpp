// SPDX-License-Identifier: BSD-3-Clause
// Transforms: affine matrices that multiply column vectors, so that `translation(t) * scaling(s)`
// scales first, and rotations as unit quaternions. Projections are in camera.hpp.
#pragma once

#include <cmath>

#include <rastrum/mat.hpp>
#include <rastrum/vec.hpp>

namespace RASTRUM_API rastrum {

constexpr Mat4d translation(Vec3d by) {
  Mat4d r = Mat4d::identity();
  r.m[0][3] = by.x;
  r.m[1][3] = by.y;
  r.m[2][3] = by.z;
  return r;
}

constexpr Mat4d scaling(Vec3d by) {
  Mat4d r = Mat4d::identity();
  r.m[0][0] = by.x;
  r.m[1][1] = by.y;
  r.m[2][2] = by.z;
  return r;
}

/// Maps p to p + along (normal · p): planes across `normal` slide along `along`. If the two are at
/// right angles, it is a shear, which keeps volumes.
constexpr Mat4d shear(Vec3d along, Vec3d normal) {
  const double a[3] = {along.x, along.y, along.z}, n[3] = {normal.x, normal.y, normal.z};
  Mat4d r = Mat4d::identity();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r.m[i][j] += a[i] * n[j];
  return r;
}

/// Mirrors in the plane normal · p = offset · |normal|². `normal` is not 0 and need not be of unit
/// length. Turns fronts into backs (Winding).
constexpr Mat4d reflection(Vec3d normal, double offset = 0) {
  const double n[3] = {normal.x, normal.y, normal.z};
  const double squared = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  Mat4d r = Mat4d::identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) r.m[i][j] -= 2 * n[i] * n[j] / squared;
    r.m[i][3] = 2 * offset * n[i];
  }
  return r;
}

// Unit quaternions: rotations without a preferred axis, which can be interpolated (Shoemake,
// "Animating rotation with quaternion curves", 1985), in float64 like the matrices.

/// w + x i + y j + z k. A rotation by θ about the unit axis a is (cos θ/2, a sin θ/2).
struct Quaternion {
  double w = 1, x = 0, y = 0, z = 0;
};

/// The product: first b's rotation, then a's.
constexpr Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
constexpr double dot(const Quaternion& a, const Quaternion& b) {
  return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
}
/// The unit quaternion along `q`; the identity where its length is 0.
inline Quaternion normalize(const Quaternion& q) {
  const double length = std::sqrt(dot(q, q));
  if (!(length > 0)) return {};
  return {q.w / length, q.x / length, q.y / length, q.z / length};
}

/// The right-handed rotation about `axis`, of any length; the identity where it is 0.
[[nodiscard]] Quaternion rotation_about(Vec3d axis, double angle_rad);

/// The matrix of the rotation `q`, which must be of unit length.
constexpr Mat4d rotation(const Quaternion& q) {
  Mat4d r = Mat4d::identity();
  const double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const double xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  const double wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  r.m[0][0] = 1 - 2 * (yy + zz);
  r.m[0][1] = 2 * (xy - wz);
  r.m[0][2] = 2 * (xz + wy);
  r.m[1][0] = 2 * (xy + wz);
  r.m[1][1] = 1 - 2 * (xx + zz);
  r.m[1][2] = 2 * (yz - wx);
  r.m[2][0] = 2 * (xz - wy);
  r.m[2][1] = 2 * (yz + wx);
  r.m[2][2] = 1 - 2 * (xx + yy);
  return r;
}

/// The rotation between a (t = 0) and b (t = 1), at constant angular speed, the shorter way round.
[[nodiscard]] Quaternion slerp(const Quaternion& a, const Quaternion& b, double t);

}  // namespace rastrum
