// Affine transforms as matrices that multiply column vectors: `translation(t) * scaling(s)` scales
// first. Rotations are in quaternion.hpp, projections in scene/camera.hpp.
#pragma once

#include <rastrum/core/mat.hpp>
#include <rastrum/core/vec.hpp>

namespace rastrum {

constexpr Mat4d translation(Vec3 by) {
  Mat4d r = Mat4d::identity();
  r.m[0][3] = by.x;
  r.m[1][3] = by.y;
  r.m[2][3] = by.z;
  return r;
}

constexpr Mat4d scaling(Vec3 by) {
  Mat4d r = Mat4d::identity();
  r.m[0][0] = by.x;
  r.m[1][1] = by.y;
  r.m[2][2] = by.z;
  return r;
}

/// p + along (normal · p): planes across `normal` slide along `along`. A shear, which keeps
/// volumes, where the two are at right angles.
constexpr Mat4d shear(Vec3 along, Vec3 normal) {
  const double a[3] = {along.x, along.y, along.z}, n[3] = {normal.x, normal.y, normal.z};
  Mat4d r = Mat4d::identity();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r.m[i][j] += a[i] * n[j];
  return r;
}

/// The mirror image in the plane normal · p = offset · |normal|². `normal` is not 0 and need not be
/// of unit length. Turns fronts into backs (Winding).
constexpr Mat4d reflection(Vec3 normal, double offset = 0) {
  const double n[3] = {normal.x, normal.y, normal.z};
  const double squared = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  Mat4d r = Mat4d::identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) r.m[i][j] -= 2 * n[i] * n[j] / squared;
    r.m[i][3] = 2 * offset * n[i];
  }
  return r;
}

}  // namespace rastrum
