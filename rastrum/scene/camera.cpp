// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/camera.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/vectors.hpp>
#include <rastrum/error.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {
namespace {

/// Throws Error{invalid_argument} with `what` if `a` has none.
Vec3d direction(Vec3d a, const char* what) {
  if (const auto unit = direction_of(a)) return *unit;
  throw Error(Errc::invalid_argument, what);
}

void require(bool ok, const char* what) {
  if (!ok) throw Error(Errc::invalid_argument, what);
}

Mat4d camera_to_clip(const Camera& c, int width, int height) {
  const double n = c.near_plane;
  const double f = c.far_plane;
  require(std::isfinite(n) && f > n, "camera: near must be finite and less than far");
  const double smaller = std::min(width, height);
  const double sx = smaller / width;
  const double sy = smaller / height;
  Mat4d p;
  if (c.orthographic) {
    require(c.orthographic_height > 0 && std::isfinite(c.orthographic_height),
            "camera: the orthographic height must be > 0 and finite");
    require(std::isfinite(f), "camera: an orthographic camera needs a finite far plane");
    p.m[0][0] = 2 / static_cast<double>(c.orthographic_height) * sx;
    p.m[1][1] = 2 / static_cast<double>(c.orthographic_height) * sy;
    p.m[2][2] = 1 / (f - n);
    p.m[2][3] = f / (f - n);
    p.m[3][3] = 1;
    return p;
  }
  require(n > 0, "camera: near must be > 0 for a perspective camera");
  check_fov(c.fov_rad);
  const double cot = 1 / elementary::tan(static_cast<double>(c.fov_rad) / 2);
  p.m[0][0] = cot * sx;
  p.m[1][1] = cot * sy;
  const bool infinite = std::isinf(f);
  p.m[2][2] = infinite ? 0 : n / (f - n);
  p.m[2][3] = infinite ? n : n * f / (f - n);
  p.m[3][2] = -1;
  return p;
}

Mat4d rigid(Vec3d right, Vec3d up, Vec3d back, Vec3d eye) {
  Mat4d v = Mat4d::identity();
  const Vec3d axes[3] = {right, up, back};
  for (int i = 0; i < 3; ++i) {
    v.m[i][0] = axes[i].x;
    v.m[i][1] = axes[i].y;
    v.m[i][2] = axes[i].z;
    v.m[i][3] = -dot(axes[i], eye);
  }
  return v;
}

/// World to camera space, by the rows of a matrix to clip space.
Mat4d axes_of(const Mat4d& m) {
  constexpr const char* kSingular = "camera: its matrix is singular";
  const Vec3d x = row_of(m, 0), y = row_of(m, 1), z = row_of(m, 2), w = row_of(m, 3);
  const bool perspective = dot(w, w) > 0;
  // A parallel projection looks along the direction in which x and y stay. Depth grows towards the
  // eye.
  Vec3d back = direction(perspective ? -w : cross(x, y), kSingular);
  if (!perspective && dot(back, z) < 0) back = -back;
  const Vec3d up = direction(y - back * dot(y, back), kSingular);
  // The eye is where x, y and w are 0, or in the middle of a parallel projection's near plane (z =
  // w).
  const Vec3d last = perspective ? w : z;
  const double known[3] = {-m.m[0][3], -m.m[1][3],
                           perspective ? -m.m[3][3] : m.m[3][3] - m.m[2][3]};
  const double volume = dot(cross(x, y), last);
  const Vec3d eye =
      (cross(y, last) * known[0] + cross(last, x) * known[1] + cross(x, y) * known[2]) *
      (1 / volume);
  require(is_finite(eye), kSingular);
  return rigid(cross(up, back), up, back, eye);
}

}  // namespace

void check_fov(float fov_rad) {
  // Written so that a NaN fails.
  require(fov_rad > 0 && fov_rad < 3.14159F,
          "camera: the field of view, in radians, must lie between 0 and pi (180 degrees)");
}

Mat4d world_to_camera(const Camera& c) {
  const FloatScope floats;
  if (c.matrix) return axes_of(*c.matrix);
  const Vec3d back =
      direction(c.eye - c.target, "camera: eye and target must be finite and differ");
  const Vec3d right = direction(
      cross(c.up, back), "camera: up must be finite, not zero and not along the view direction");
  return rigid(right, cross(back, right), back, c.eye);
}

Mat4d world_to_clip(const Camera& camera, int width, int height) {
  const FloatScope floats;
  if (camera.matrix) return *camera.matrix;
  return camera_to_clip(camera, width, height) * world_to_camera(camera);
}

std::vector<ProjectedPoint> project(const Camera& camera, int width, int height,
                                    std::span<const Vec3d> points) {
  const FloatScope floats;
  const Mat4d to_clip = world_to_clip(camera, width, height), to_camera = world_to_camera(camera);
  std::vector<ProjectedPoint> seen;
  seen.reserve(points.size());
  for (const Vec3d& p : points) {
    const auto row = [&](const Mat4d& m, int i) {
      return m.m[i][0] * p.x + m.m[i][1] * p.y + m.m[i][2] * p.z + m.m[i][3];
    };
    ProjectedPoint& at = seen.emplace_back();
    const double w = row(to_clip, 3);
    const bool ahead = w > 0;
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    at.x = ahead ? (row(to_clip, 0) / w + 1) * width / 2 : kNan;
    at.y = ahead ? (1 - row(to_clip, 1) / w) * height / 2 : kNan;
    at.view_depth = -row(to_camera, 2);
  }
  return seen;
}

}  // namespace rastrum
