// SPDX-License-Identifier: BSD-3-Clause
#include "camera_options.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/error.hpp>

namespace rastrum::cli {
void add_camera_options(Parser app, ViewOptions& v) {
  app = app.under("Camera (--fit decides what you do not give)");
  add(app, "--fit", "[NAME]",
      "show the whole scene, as without any of these options; tight: the scene fills the picture; "
      "sphere: a ball around it does (default: tight)",
      [&v](const std::string& s) {
        v.fit_given = true;
        if (s.empty()) return;
        if (s != "tight" && s != "sphere")
          throw UsageError("--fit", "expected tight or sphere, got '" + s +
                                        "'; an INPUT stands before --fit, not behind it");
        v.fit = s == "sphere" ? Fit::sphere : Fit::tight;
      })
      ->expected(0, 1);
  add(app, "--view", "NAME",
      "where the eye stands: " + joined(view_names()) +
          "; +y or --up points upward (default: iso; front for view, and for render with "
          "--azimuth, --elevation or --roll)",
      [&v](const std::string& s) {
        const std::vector<std::string_view> names = view_names();
        const auto found = std::ranges::find(names, s);
        if (found == names.end())
          throw UsageError("--view", "expected " + joined(names) + ", got '" + s + "'");
        v.view = static_cast<ViewName>(found - names.begin());
      });
  add_number(app, "--azimuth", "DEG", "move the eye around the scene, to the right", v.azimuth_deg);
  add_number(app, "--elevation", "DEG", "move the eye around the scene, upward", v.elevation_deg);
  add_number(app, "--roll", "DEG", "turn the picture counter-clockwise", v.roll_deg);
  add_number_that(app, "--zoom", "TIMES", "show everything so many times as large", v.zoom,
                  is_above_zero, "must be greater than 0");
  add_integer(app, "--camera", "N", "take the N-th camera of the files, from 0", v.file_camera, 0,
              std::numeric_limits<int>::max());
  add_vec3(app, "--eye", "X,Y,Z", "where the camera stands", v.eye);
  add_vec3(app, "--target", "X,Y,Z", "what the camera looks at", v.target);
  add(app, "--up", "X,Y,Z",
      "which direction is up in the picture; x, y and z are possible, too (default: 0,1,0)",
      [&v](const std::string& s) {
        v.up = s == "x"   ? Vec3d{1, 0, 0}
               : s == "y" ? Vec3d{0, 1, 0}
               : s == "z" ? Vec3d{0, 0, 1}
                          : parse_vec3("--up", s);
      });
  add_number_that(
      app, "--fov", "DEG",
      "field of view across the smaller side (default: 60; 30 if no option tells about the camera)",
      v.fov_deg, [](double degrees) { return degrees > 0 && degrees < 180; },
      "must lie between 0 and 180 degrees");
  add_number(app, "--near", "N", "distance of the near plane (default: just before the scene)",
             v.near_plane);
  add(app, "--far", "F|inf",
      "distance of the far plane (default: inf; orthographic: behind the scene)",
      [&v](const std::string& s) {
        v.far_plane =
            s == "inf" ? std::numeric_limits<double>::infinity() : parse_number("--far", s);
      });
  add(app, "--orthographic", "HEIGHT|fit",
      "use a parallel projection, HEIGHT world units across the smaller side; fit: as many as the "
      "scene needs",
      [&v](const std::string& s) {
        v.orthographic = true;
        if (s != "fit")
          v.orthographic_height = parse_number_that("--orthographic", s, is_above_zero,
                                                    "the height must be greater than 0");
      });
}

View view_of(const ViewOptions& o) {
  const Vec3d up = o.up.value_or(Vec3d{0, 1, 0});
  if (length(up) == 0) throw UsageError("--up", "must not be zero");
  try {
    return turned(rastrum::view_of(o.view.value_or(ViewName::front), up),
                  {o.azimuth_deg.value_or(0), o.elevation_deg.value_or(0), o.roll_deg.value_or(0)},
                  up);
  } catch (const Error& e) {
    throw UsageError("--elevation", e.what());
  }
}

void check_view(const ViewOptions& o) {
  if (o.fit_given && (o.eye || o.target || o.file_camera)) {
    const std::string other = o.eye ? "--eye" : o.target ? "--target" : "--camera";
    throw UsageError("--fit", "shows the whole scene, but " + other +
                                  " places the camera: leave one of them out");
  }
  if (o.has_view() && (o.eye || o.target || o.file_camera))
    throw UsageError(o.view            ? "--view"
                     : o.azimuth_deg   ? "--azimuth"
                     : o.elevation_deg ? "--elevation"
                                       : "--roll",
                     "turns the camera of --fit, but --eye, --target and --camera place the "
                     "camera: leave one of them out");
  if (o.file_camera && o.orthographic)
    throw UsageError("--orthographic",
                     "the camera of a file has its own projection: leave out this or --camera");
  if (o.has_view()) (void)view_of(o);
  if (o.near_plane && !o.orthographic && !o.file_camera && !(*o.near_plane > 0))
    throw UsageError("--near", "must be greater than 0 for a perspective camera");
  if (o.near_plane && o.far_plane && !(*o.near_plane < *o.far_plane))
    throw UsageError("--far", "must be greater than --near");
  if (o.far_plane && o.orthographic && !std::isfinite(*o.far_plane))
    throw UsageError("--far", "must be finite for an orthographic camera");
}

}  // namespace rastrum::cli
