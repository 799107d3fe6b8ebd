// SPDX-License-Identifier: BSD-3-Clause
#include "camera.hpp"

#include <numbers>
#include <string>

#include <rastrum/fit.hpp>

namespace rastrum::cli {
namespace {

Camera file_camera(const Scene& scene, int index) {
  if (static_cast<std::size_t>(index) >= scene.cameras.size())
    throw UsageError("--camera",
                     scene.cameras.empty()
                         ? "the inputs have no camera; leave it out for a view that fits"
                         : "the inputs have cameras 0 to " +
                               std::to_string(scene.cameras.size() - 1) + ", not " +
                               std::to_string(index));
  return scene.cameras[static_cast<std::size_t>(index)];
}

/// The camera that sees everything, along −z without a view. A turning scene turns about --up.
Camera fitted_camera(const ViewOptions& o, const SceneView& scene, float fov_rad, Size picture,
                     FitRanks* ranks) {
  const View v = o.has_view() ? view_of(o) : View{};
  Vec3d up = o.up.value_or(Vec3d{0, 1, 0});
  const double aside = length(cross(up, v.direction));  // choose_camera reports 0 without a view
  if (o.fit == Fit::sphere || (!o.has_view() && (o.eye || o.target || aside == 0)))
    return fit_camera(scene, fov_rad, o.orthographic, v.direction, v.up, ranks);
  if (o.has_view() && !(o.turns && o.roll_deg.value_or(0) == 0 && aside > 1e-6)) up = v.up;
  const Camera along{.eye = {},
                     .target = v.direction,
                     .up = up,
                     .fov_rad = fov_rad,
                     .orthographic = o.orthographic};
  return fit_picture(scene, along, picture.width, picture.height,
                     {.turns = o.turns, .ranks = ranks});
}

}  // namespace

Camera choose_camera(const ViewOptions& o, const Scene& scene, const SceneView& view, Size picture,
                     FitRanks* ranks) {
  Camera camera;
  if (o.file_camera) {
    camera = file_camera(scene, *o.file_camera);
  } else {
    const auto fov_rad = static_cast<float>(o.fov_deg.value_or(60) * std::numbers::pi / 180);
    camera = fitted_camera(o, view, fov_rad, picture, ranks);
  }
  if (o.eye) camera.eye = *o.eye;
  if (o.target) camera.target = *o.target;
  if (o.eye && !o.file_camera) place_planes(camera, bounding_sphere(view, ranks));
  if (o.up && !o.has_view()) camera.up = *o.up;
  if (o.fov_deg) camera.fov_rad = static_cast<float>(*o.fov_deg * std::numbers::pi / 180);
  if (o.orthographic_height)
    camera.orthographic_height = static_cast<float>(*o.orthographic_height);
  if (o.near_plane) camera.near_plane = static_cast<float>(*o.near_plane);
  if (o.far_plane) camera.far_plane = static_cast<float>(*o.far_plane);
  if (o.zoom) camera = zoomed(camera, *o.zoom);
  if (camera.eye == camera.target)
    throw UsageError(o.target ? "--target" : "--eye", "eye and target must differ");
  const Vec3d towards = camera.target - camera.eye;
  if (length(cross(camera.up, towards)) == 0)
    throw UsageError("--up", o.up ? "must not be zero or along the view direction"
                                  : "is needed: the camera looks along 0,1,0; try --up 0,0,-1");
  if (!(camera.near_plane < camera.far_plane))
    throw UsageError(o.far_plane ? "--far" : "--near", "the near plane (" +
                                                           std::to_string(camera.near_plane) +
                                                           ") must be nearer than the far plane (" +
                                                           std::to_string(camera.far_plane) + ")");
  return camera;
}

}  // namespace rastrum::cli
