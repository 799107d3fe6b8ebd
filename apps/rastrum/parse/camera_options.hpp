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
  sphere,  ///< a ball around it does (fit_camera): one camera for any shape of picture
};

/// The given options. Other values come from the fitted camera, or from the file's with
/// `file_camera`; with an eye or a target from the sphere fit.
struct ViewOptions {
  Fit fit = Fit::tight;
  bool fit_given = false;
  bool turns = false;  ///< the tight fit is of all that the turning scene sweeps over
  /// The direction of the fitted camera, which stands where it sees everything.
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

/// Parsing fills `v`, which must outlive `app`.
void add_camera_options(Parser app, ViewOptions& v);
/// Throws UsageError.
[[nodiscard]] View view_of(const ViewOptions& options);
/// Throws UsageError for impossible values, and for options that exclude each other. Needs no
/// scene, so it comes first.
void check_view(const ViewOptions& options);

}  // namespace rastrum::cli
