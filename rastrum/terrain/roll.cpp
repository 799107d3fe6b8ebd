// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/terrain/roll.hpp>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/terrain/setup.hpp>

namespace rastrum::terrain {
namespace {

elementary::SinCos turn_by(double angle) {
  auto [sin, cos] = elementary::sin_cos(angle);
  // Rounding leaves sine or cosine of a quarter turn just off 0.
  if (std::abs(cos) < 1e-12) cos = 0;
  if (std::abs(sin) < 1e-12) sin = 0;
  return {sin, cos};
}

}  // namespace

Upright upright_of(const TerrainOptions& options, const TerrainCamera& camera) {
  const elementary::SinCos turn = turn_by(camera.roll_rad);
  const double c = std::abs(turn.cos), s = std::abs(turn.sin);
  const double width = std::ceil(options.width * c + options.height * s - 1e-6);
  const double height = std::ceil(options.width * s + options.height * c - 1e-6);
  if (width > kMaxImageSize || height > kMaxImageSize)
    reject(
        "terrain: rolled by this angle the picture needs an upright one beyond "
        "32768x32768; choose a smaller size");
  Upright u{options, camera};
  u.options.width = static_cast<int>(width);
  u.options.height = static_cast<int>(height);
  u.options.scale_px = scale_px(options);
  const double wider = width / options.width;
  u.options.fov_rad = options.projection == Projection::planar
                          ? 2 * elementary::atan(elementary::tan(options.fov_rad / 2) * wider)
                          : options.fov_rad * wider;
  u.camera.horizon_px += (height - options.height) / 2;
  u.camera.roll_rad = 0;
  return u;
}

Roll::Roll(double roll_rad, int width, int height) : width_(width), height_(height) {
  const elementary::SinCos turn = turn_by(roll_rad);
  cos_ = turn.cos;
  sin_ = turn.sin;
}

}  // namespace rastrum::terrain
