// float64 vectors: what is computed in double and rounded to float32 once, so that points reached
// along two ways (a seam of a shape, an edge of two patches) get the same bits.
#pragma once

#include <cmath>

#include <rastrum/vec.hpp>

namespace rastrum {

struct Vec3d {
  double x = 0, y = 0, z = 0;

  explicit operator Vec3() const {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
  }
};

constexpr Vec3d widen(Vec3 a) {
  return {a.x, a.y, a.z};
}
constexpr Vec3d operator+(Vec3d a, Vec3d b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vec3d operator-(Vec3d a, Vec3d b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Vec3d operator*(Vec3d a, double s) {
  return {a.x * s, a.y * s, a.z * s};
}
constexpr double dot(Vec3d a, Vec3d b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec3d cross(Vec3d a, Vec3d b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec3d a) {
  return std::sqrt(dot(a, a));
}
/// Requires length(a) > 0.
inline Vec3d unit(Vec3d a) {
  return a * (1 / length(a));
}

}  // namespace rastrum
