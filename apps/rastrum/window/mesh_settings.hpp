// SPDX-License-Identifier: BSD-3-Clause
// Settings that a person changes in the window.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <rastrum/family.hpp>

#include "parse/scene_options.hpp"

namespace rastrum::cli::window {

/// A plane across a direction, which leaves out one side.
struct Section {
  bool on = false;
  double at = 0;      ///< along the direction
  bool below = true;  ///< keeps what lies below it

  /// `direction`: of length 1.
  [[nodiscard]] ClipPlane plane(const Vec3d& direction) const;
};

/// Across the camera's view when it was switched on.
struct ViewSection : Section {
  Vec3d direction{0, 0, -1};
};

/// The extent of a box along a direction.
[[nodiscard]] ScalarRange reach(const Bounds& box, const Vec3d& direction);
/// Across the camera's view, through the middle of the box: the nearer part is left out.
[[nodiscard]] ViewSection section_of_view(const Camera& camera, const Bounds& box);

/// Per pixel.
inline const std::vector<int> kSampleCounts{1, 4, 8, 16};

/// Settings without a control keep the command line's values.
struct MeshSettings {
  family::Options render;
  AnnotationOptions notes;      ///< effects, axes, and with `scalars` numbers as colours
  std::string map = "viridis";  ///< of `notes.scalars`, as for --cmap
  /// default, headlight, studio or file; empty: as on the command line
  std::string lights;
  std::vector<Light> file_lights;   ///< of the inputs
  bool adds_file_lights = false;    ///< the command line did
  std::array<Section, 3> sections;  ///< across x, y, z
  ViewSection view_section;
  bool heat_map = false;  ///< fragments per pixel instead of the picture

  [[nodiscard]] std::vector<ClipPlane> cuts() const;
  /// `render` with lights and sections.
  [[nodiscard]] family::Options frame(int width, int height) const;
};

}  // namespace rastrum::cli::window
