// SPDX-License-Identifier: BSD-3-Clause
// Points and directions of the oracles, in long double.
#pragma once

#include <cmath>

namespace rastrum::test {

using Real = long double;

struct Point3 {
  Real x = 0, y = 0, z = 0;
};

inline Point3 operator+(const Point3& a, const Point3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Point3 operator-(const Point3& a, const Point3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Point3 operator*(const Point3& a, Real s) {
  return {a.x * s, a.y * s, a.z * s};
}
inline Real dot(const Point3& a, const Point3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Point3 cross(const Point3& a, const Point3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Real length(const Point3& a) {
  return std::sqrt(dot(a, a));
}
/// Converts any type of point.
template <class Vector>
Point3 widen(const Vector& v) {
  return {v.x, v.y, v.z};
}

}  // namespace rastrum::test
