// What a person changes of a picture of meshes while looking at it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <rastrum/family.hpp>

#include "scene_options.hpp"

namespace rastrum::cli::window {

/// A plane across an axis of the world, which leaves out one side.
struct Section {
  bool on = false;
  double at = 0;      ///< where on the axis
  bool below = true;  ///< keeps what lies below it

  [[nodiscard]] ClipPlane plane(int axis) const {
    const double side = below ? -1 : 1;
    const Vec3d normal{axis == 0 ? side : 0, axis == 1 ? side : 0, axis == 2 ? side : 0};
    return {normal, -side * at};
  }
};

/// What a panel does not show stays as the command line had it.
struct MeshSettings {
  family::Options render;
  AnnotationOptions notes;      ///< effects, axes, and with `scalars` numbers as colours
  std::string map = "viridis";  ///< of `notes.scalars`, as --cmap has it
  /// default, headlight, studio or file; empty: as the command line had
  std::string lights;
  std::vector<Light> file_lights;  ///< of the inputs
  bool adds_file_lights = false;   ///< the command line did
  std::array<Section, 3> sections;
  bool heat_map = false;  ///< fragments at each pixel instead of the picture

  /// `render` with lights and sections, of a picture of this size.
  [[nodiscard]] family::Options frame(int width, int height) const;
};

}  // namespace rastrum::cli::window
