// SPDX-License-Identifier: BSD-3-Clause
// Settings that a person changes while looking at a picture of meshes.
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
  double at = 0;      ///< where along the direction
  bool below = true;  ///< keeps what lies below it

  /// `direction`: of length 1.
  [[nodiscard]] ClipPlane plane(const Vec3d& direction) const;
};

/// One across the way in which somebody looked.
struct ViewSection : Section {
  Vec3d direction{0, 0, -1};
};

/// How far a box reaches along a direction.
[[nodiscard]] ScalarRange reach(const Bounds& box, const Vec3d& direction);
/// Across the way in which the camera looks, through the middle of the box: what is nearer is left
/// out.
[[nodiscard]] ViewSection section_of_view(const Camera& camera, const Bounds& box);

/// A pixel.
inline const std::vector<int> kSampleCounts{1, 4, 8, 16};

/// Settings that no panel shows stay as the command line had them.
struct MeshSettings {
  family::Options render;
  AnnotationOptions notes;      ///< effects, axes, and with `scalars` numbers as colours
  std::string map = "viridis";  ///< of `notes.scalars`, as --cmap has it
  /// default, headlight, studio or file; empty: as the command line had
  std::string lights;
  std::vector<Light> file_lights;   ///< of the inputs
  bool adds_file_lights = false;    ///< the command line did
  std::array<Section, 3> sections;  ///< across x, y, z
  ViewSection view_section;
  bool heat_map = false;  ///< fragments at each pixel instead of the picture

  /// The planes of the sections that are on.
  [[nodiscard]] std::vector<ClipPlane> cuts() const;
  /// `render` with lights and sections, of a picture of this size.
  [[nodiscard]] family::Options frame(int width, int height) const;
};

}  // namespace rastrum::cli::window
