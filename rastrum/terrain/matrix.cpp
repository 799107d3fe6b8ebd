// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/terrain.hpp>

#include <array>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/terrain/setup.hpp>

namespace rastrum::terrain {
namespace {

using Row = std::array<double, 4>;

Row combine(double a, const Row& x, double b, const Row& y) {
  Row r;
  for (std::size_t i = 0; i < 4; ++i) r[i] = a * x[i] + b * y[i];
  return r;
}

}  // namespace

Mat4d world_to_clip(const TerrainOptions& o, const TerrainCamera& c, double near) {
  const FloatScope floats;
  if (o.projection != Projection::planar)
    reject("terrain: the cylindrical projection is no matrix; meshes need the planar one");
  const auto [sin, cos] = elementary::sin_cos(c.angle_rad);
  // A point (x, height, y, 1) relative to the camera: along the view, to its right, below it.
  const Row ahead{-sin, 0, -cos, sin * c.x + cos * c.y};
  const Row right{cos, 0, -sin, -cos * c.x + sin * c.y};
  const Row below{0, -1, 0, c.altitude};
  // Pixels times distance. Classic samples its columns at their left edge and truncates its rows.
  const double across = o.classic ? o.width / 2.0 : o.width / (2 * elementary::tan(o.fov_rad / 2));
  const double half_px = o.classic ? 0.5 : 0;
  Row x_px = combine(across, right, half_px, ahead);  // from the picture's centre
  Row y_px = combine(scale_px(o), below, c.horizon_px - half_px - o.height / 2.0, ahead);
  if (c.roll_rad != 0) {
    const auto [rs, rc] = elementary::sin_cos(c.roll_rad);
    const Row x = combine(rc, x_px, rs, y_px);
    y_px = combine(-rs, x_px, rc, y_px);
    x_px = x;
  }
  Mat4d clip;
  for (std::size_t i = 0; i < 4; ++i) {
    clip.m[0][i] = x_px[i] * 2 / o.width;
    clip.m[1][i] = -y_px[i] * 2 / o.height;
    clip.m[3][i] = ahead[i];
  }
  clip.m[2][3] = near;
  return clip;
}

}  // namespace rastrum::terrain
