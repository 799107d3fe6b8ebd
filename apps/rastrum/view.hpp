// From the options of the camera to a camera.
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
  bool turns = false;  ///< the scene turns: the tight fit is of all that it sweeps over
  /// Whence the fitted camera looks; with them it stands where it sees everything.
  std::optional<ViewName> view;
  std::optional<double> azimuth_deg, elevation_deg, roll_deg, zoom;
  std::optional<int> file_camera;
  std::optional<Vec3d> eye, target, up;
  std::optional<double> fov_deg, near_plane, far_plane;
  bool orthographic = false;
  std::optional<double> orthographic_height;  ///< none: the fit camera's

  [[nodiscard]] bool has_view() const { return view || azimuth_deg || elevation_deg || roll_deg; }
};

/// Throws UsageError for values that no camera can have; needs no scene, so it comes first.
void check_view(const ViewOptions& options);

/// The near plane of a camera of one's own is as far from the box as the fit camera's would be.
/// `picture`: its size, which the tight fit fills. Throws UsageError where the file has no such
/// camera or the parts do not fit each other. `ranks`: who has the rest of the scene; what turns is
/// not theirs.
[[nodiscard]] Camera choose_camera(const ViewOptions& options, const Scene& scene,
                                   const SceneView& view, Size picture, FitRanks* ranks = nullptr);

}  // namespace rastrum::cli
