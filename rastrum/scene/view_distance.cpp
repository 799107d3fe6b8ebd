#include <rastrum/camera.hpp>

#include <cmath>
#include <limits>

#include <rastrum/error.hpp>

namespace rastrum {
namespace {

/// z and w change along the axis alone: of what lies t ahead of the eye z = a t + b and w = c t +
/// e.
double distance_by_rows(const Camera& camera, double depth) {
  const Mat4d v = world_to_camera(camera);
  const auto& m = camera.matrix->m;
  // What a row is at the eye, and how it changes along an axis of the camera.
  const auto along = [&](int row, int axis) {
    return m[row][0] * v.m[axis][0] + m[row][1] * v.m[axis][1] + m[row][2] * v.m[axis][2];
  };
  const auto at_eye = [&](int row) {
    double value = m[row][3];
    for (int axis = 0; axis < 3; ++axis) value -= along(row, axis) * v.m[axis][3];
    return value;
  };
  const double a = -along(2, 2), c = -along(3, 2);
  for (int axis = 0; axis < 2; ++axis)
    if (std::abs(along(2, axis)) > 1e-9 * std::abs(a) + 1e-9 * std::abs(c))
      throw Error(
          Errc::invalid_argument,
          "camera: the planes of equal depth of its matrix are not across its axis, so that "
          "depth alone tells no distance");
  return (at_eye(2) - depth * at_eye(3)) / (depth * c - a);
}

}  // namespace

double view_distance(const Camera& camera, float depth) {
  if (!(depth > 0)) return std::numeric_limits<double>::infinity();
  const double d = depth, n = camera.near_plane, f = camera.far_plane;
  if (camera.matrix) return distance_by_rows(camera, d);
  if (camera.orthographic) return f - d * (f - n);
  return std::isinf(f) ? n / d : n * f / (d * (f - n) + n);
}

}  // namespace rastrum
