// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/scene/view_distance.hpp>

#include <cmath>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/error.hpp>

namespace rastrum {
namespace {

/// z and w change only along the camera's axis: a point t ahead of the eye has z = a t + b and w =
/// c t + e.
DistanceByDepth by_rows(const Camera& camera) {
  const Mat4d v = world_to_camera(camera);
  const auto& m = camera.matrix->m;
  // How a row of the matrix changes along an axis of the camera, and its value at the eye.
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
  return {at_eye(2), at_eye(3), c, -a};
}

}  // namespace

DistanceByDepth distance_by_depth(const Camera& camera) {
  const double n = camera.near_plane, f = camera.far_plane;
  if (camera.matrix) return by_rows(camera);
  if (camera.orthographic) return {f, f - n, 0, 1};
  return std::isinf(f) ? DistanceByDepth{n, 0, 1, 0} : DistanceByDepth{n * f, 0, f - n, n};
}

double view_distance(const Camera& camera, float depth) {
  const FloatScope floats;
  // Infinite without a surface, also for cameras whose depth tells no distance.
  if (!(depth > 0)) return std::numeric_limits<double>::infinity();
  return distance_by_depth(camera)(depth);
}

}  // namespace rastrum
