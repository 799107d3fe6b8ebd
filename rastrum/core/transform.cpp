// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/transform.hpp>

#include <algorithm>
#include <cmath>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/float_scope.hpp>

namespace rastrum {

Quaternion rotation_about(Vec3d axis, double angle_rad) {
  const FloatScope floats;
  const double l = length(axis);
  if (!(l > 0)) return {};
  const auto [sin, cos] = elementary::sin_cos(angle_rad / 2);
  const double s = sin / l;
  return {cos, axis.x * s, axis.y * s, axis.z * s};
}

Quaternion slerp(const Quaternion& a, const Quaternion& b, double t) {
  const FloatScope floats;
  const double cosine = dot(a, b);
  const double sign = cosine < 0 ? -1 : 1;
  const double angle = elementary::acos(std::min(std::abs(cosine), 1.0));
  // For tiny angles the arc is a straight line to the last bits.
  const double sine = elementary::sin(angle);
  const double wa = sine > 1e-9 ? elementary::sin((1 - t) * angle) / sine : 1 - t;
  const double wb = sign * (sine > 1e-9 ? elementary::sin(t * angle) / sine : t);
  return normalize(
      {wa * a.w + wb * b.w, wa * a.x + wb * b.x, wa * a.y + wb * b.y, wa * a.z + wb * b.z});
}

}  // namespace rastrum
