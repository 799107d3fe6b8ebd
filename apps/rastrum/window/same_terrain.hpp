// SPDX-License-Identifier: BSD-3-Clause
// The picture of a terrain that a window shows, said so that others draw it.
#pragma once

#include <string>

#include "parse/ground_options.hpp"
#include "parse/terrain_options.hpp"
#include "terrain_control.hpp"

namespace rastrum::cli::window {

struct ShownTerrain {
  const TerrainInput& input;
  const TerrainLook& look;      ///< but for what the pose has
  const terrain::Light& light;  ///< but for the sun
  bool sky_dims;
  const GroundShown& shown;   ///< as the command line had it, but for what follows
  const std::string& lights;  ///< sun, headlight, studio; empty: as given
  const FrameOptions& frame;  ///< with these lights
  const TerrainPose& pose;
  int width = 0, height = 0;
};

/// The angle that degrees, as options and Python have them, lead to. Each is its own nearest.
[[nodiscard]] double angle_in_degrees(double rad);
/// The pose with such angles: others cannot be said.
[[nodiscard]] TerrainPose sayable(TerrainPose pose);

/// `rastrum terrain …`, which writes the same bits to `png`; a comment before it names what cannot
/// be said.
[[nodiscard]] std::string terrain_command_line(const ShownTerrain& shown, const std::string& png);
/// The same for Python.
[[nodiscard]] std::string terrain_python(const ShownTerrain& shown, const std::string& png);

}  // namespace rastrum::cli::window
