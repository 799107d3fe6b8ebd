// SPDX-License-Identifier: BSD-3-Clause
// Cameras from other programs' descriptions: lens and pose, composed in float64 in Camera::matrix.
// Axes and distances are later read off it.
#include <rastrum/camera.hpp>

#include <algorithm>
#include <cmath>

#include <rastrum/core/enum.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/vectors.hpp>
#include <rastrum/error.hpp>

namespace rastrum {
namespace {

void require_lens(bool ok, const char* what) {
  if (!ok) throw Error(Errc::invalid_argument, what);
}

bool is_rotation(const Mat4d& m) {
  constexpr double kClose = 1e-6;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (!(std::abs(dot(row_of(m, i), row_of(m, j)) - (i == j ? 1 : 0)) <= kClose)) return false;
  return dot(cross(row_of(m, 0), row_of(m, 1)), row_of(m, 2)) > 0;
}

bool is_finite(const Mat4d& m) {
  return std::all_of(&m.m[0][0], &m.m[0][0] + 16, [](double v) { return std::isfinite(v); });
}

}  // namespace

Mat4d pose_from(const double (&rotation)[9], Vec3d translation) {
  Mat4d m = Mat4d::identity();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m.m[i][j] = rotation[3 * i + j];
  m.m[0][3] = translation.x;
  m.m[1][3] = translation.y;
  m.m[2][3] = translation.z;
  return m;
}

Camera camera_from_opencv(const Intrinsics& k, const Mat4d& world_to_camera, int width, int height,
                          double near_plane) {
  const FloatScope floats;
  require_lens(width >= 1 && height >= 1, "camera: the picture must have at least a pixel");
  require_lens(std::isfinite(k.fx) && std::isfinite(k.fy) && k.fx * k.fy > 0,
               "camera: fx and fy must be finite, not 0 and of one sign");
  require_lens(std::isfinite(k.cx) && std::isfinite(k.cy) && std::isfinite(k.skew) &&
                   std::isfinite(k.first_centre),
               "camera: cx, cy, the skew and the first pixel's centre must be finite");
  require_lens(near_plane > 0 && std::isfinite(near_plane), "camera: near must be > 0 and finite");
  require_lens(is_finite(world_to_camera), "camera: the pose must be finite");
  const auto& bottom = world_to_camera.m[3];
  require_lens(bottom[0] == 0 && bottom[1] == 0 && bottom[2] == 0 && bottom[3] == 1,
               "camera: the last row of the pose must be 0 0 0 1; is it column-major?");
  require_lens(
      is_rotation(world_to_camera),
      "camera: the pose must be a rotation and a translation, from the world to the camera");
  // Ours are the pixels' corners: the centre of the top left one is (0.5, 0.5). w = z, and
  // x = 2 u / W − 1, y = 1 − 2 v / H times w.
  const double cx = k.cx - k.first_centre + 0.5, cy = k.cy - k.first_centre + 0.5;
  Mat4d lens;
  lens.m[0][0] = 2 * k.fx / width;
  lens.m[0][1] = 2 * k.skew / width;
  lens.m[0][2] = 2 * cx / width - 1;
  lens.m[1][1] = -2 * k.fy / height;
  lens.m[1][2] = 1 - 2 * cy / height;
  lens.m[2][3] = near_plane;
  lens.m[3][2] = 1;
  Camera camera;
  camera.matrix = lens * world_to_camera;
  return camera;
}

Camera camera_from_matrix(const Mat4d& world_to_clip, ClipDepth depth) {
  const FloatScope floats;
  require_lens(is_finite(world_to_clip), "camera: its matrix must be finite");
  check_enum(depth, ClipDepth::reversed, "camera: the depth of its clip space");
  Mat4d m = world_to_clip;
  for (int j = 0; j < 4; ++j) {
    const double z = m.m[2][j], w = m.m[3][j];
    if (depth == ClipDepth::opengl) m.m[2][j] = (w - z) / 2;
    if (depth == ClipDepth::zero_to_one) m.m[2][j] = w - z;
  }
  Camera camera;
  camera.matrix = m;
  (void)world_to_camera(camera);  // throws where it is singular
  require_lens(inverse(m).has_value(), "camera: its matrix is singular");
  return camera;
}

Camera orthographic_by_scale(Camera camera, double units, int width, int height) {
  const FloatScope floats;
  require_lens(width >= 1 && height >= 1, "camera: the picture must have at least a pixel");
  const double across = units * std::min(width, height);
  require_lens(across > 0 && std::isfinite(static_cast<float>(across)),
               "camera: the world's units a pixel must be > 0 and finite");
  camera.orthographic = true;
  camera.orthographic_height = static_cast<float>(across);
  camera.matrix.reset();
  return camera;
}

}  // namespace rastrum
