// SPDX-License-Identifier: BSD-3-Clause
// Views by name and angle (fit.hpp).
#include <cmath>

#include <rastrum/core/angle.hpp>
#include <rastrum/core/elementary.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/number_text.hpp>
#include <rastrum/core/vectors.hpp>
#include <rastrum/error.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/scene/tilt.hpp>

namespace rastrum {
namespace {

Vec3d unit_up(Vec3d up) {
  if (const auto unit = direction_of(up)) return *unit;
  throw Error(Errc::invalid_argument, "up: must have a direction");
}

/// v turned about the unit vector `axis`, counter-clockwise seen from its end.
Vec3d about(Vec3d axis, double degrees, Vec3d v) {
  const auto [sin, cos] = sin_cos_degrees(degrees);
  return v * cos + cross(axis, v) * sin + axis * (dot(axis, v) * (1 - cos));
}

}  // namespace

std::vector<std::string_view> view_names() {
  return {"front", "back", "left", "right", "top", "bottom", "iso"};
}

View view_of(ViewName name, Vec3d up) {
  const FloatScope floats;
  const Vec3d u = unit_up(up);
  const Vec3d front = tilted(u, {0, 0, 1}), right = tilted(u, {1, 0, 0});
  switch (name) {
    case ViewName::front:
      return {-front, u};
    case ViewName::back:
      return {front, u};
    case ViewName::right:
      return {-right, u};
    case ViewName::left:
      return {right, u};
    case ViewName::top:
      return {-u, -front};
    case ViewName::bottom:
      return {u, front};
    case ViewName::iso:
      break;
  }
  const double third = 1 / std::sqrt(3.0);
  const Vec3d eye = (front + right + u) * third;
  const Vec3d flat = u - eye * dot(eye, u);
  return {-eye, flat * (1 / length(flat))};
}

View turned(const View& view, const Turn& by, Vec3d up) {
  const FloatScope floats;
  const Vec3d u = unit_up(up);
  if (!std::isfinite(by.azimuth_deg) || !std::isfinite(by.elevation_deg) ||
      !std::isfinite(by.roll_deg))
    throw Error(Errc::invalid_argument, "azimuth, elevation and roll must be finite");
  Vec3d eye = about(u, by.azimuth_deg, -view.direction), above = about(u, by.azimuth_deg, view.up);
  if (by.elevation_deg != 0) {
    const Vec3d right = cross(above, eye);
    eye = about(right, -by.elevation_deg, eye);
    above = about(right, -by.elevation_deg, above);
    // Beyond straight down the world's up points down in the picture.
    if (dot(above, u) < -1e-9 || std::abs(by.elevation_deg) > 180)
      throw Error(Errc::invalid_argument,
                  "an elevation of " + number_text(by.elevation_deg) +
                      " degrees leads beyond where it looks straight down or up");
  }
  return {-eye, about(eye, -by.roll_deg, above)};
}

Camera zoomed(Camera camera, double times) {
  const FloatScope floats;
  if (!(times > 0) || !std::isfinite(times))
    throw Error(Errc::invalid_argument, "zoom: must be greater than 0 and finite");
  if (camera.matrix)
    throw Error(Errc::invalid_argument, "zoom: a camera with a matrix has no field of view");
  check_fov(camera.fov_rad);
  const double half = elementary::tan(double{camera.fov_rad} / 2) / times;
  camera.fov_rad = static_cast<float>(2 * elementary::atan(half));
  camera.orthographic_height = static_cast<float>(double{camera.orthographic_height} / times);
  return camera;
}

}  // namespace rastrum
