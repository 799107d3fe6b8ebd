// SPDX-License-Identifier: BSD-3-Clause
// The camera as options of the commands that draw meshes.
#pragma once

#include <optional>

#include <rastrum/fit.hpp>
#include <rastrum/scene.hpp>

#include "arguments.hpp"

namespace rastrum::cli {

enum class Fit {
  tight,   ///< the scene fills the picture (fit_picture)
  sphere,  ///< a ball around it does (fit_camera): the same camera for any shape of picture
};

/// Options of the camera that were given. Everything else is taken from the fitted camera, or from
/// the file's with `file_camera`. With an eye or a target given, it is taken from the sphere fit.
struct ViewOptions {
  Fit fit = Fit::tight;
  bool fit_given = false;
  bool turns = false;  ///< the scene turns: the tight fit is of all that it sweeps over
  /// Whence the fitted camera looks; with them it stands where it sees everything.
  std::optional<ViewName> view;
  std::optional<double> azimuth_deg, elevation_deg, roll_deg, zoom;
  std::optional<int> file_camera;
  std::optional<Vec3d> eye, target, up;
  std::optional<double> fov_deg, near_plane, far_plane;
  bool orthographic = false;
  std::optional<double> orthographic_height;  ///< none: the fit camera's

  /// Whether annotations may ask for a margin.
  [[nodiscard]] bool leaves_room() const { return !file_camera && !eye && !orthographic_height; }
  [[nodiscard]] bool has_view() const { return view || azimuth_deg || elevation_deg || roll_deg; }
};

/// Adds the options; parsing fills `v`, which must outlive `app`.
void add_camera_options(Parser app, ViewOptions& v);
/// The view that names and angles say. Throws UsageError.
[[nodiscard]] View view_of(const ViewOptions& options);
/// Throws UsageError for values that no camera can have, and for options that leave no room for
/// each other; needs no scene, so it comes first.
void check_view(const ViewOptions& options);

}  // namespace rastrum::cli
