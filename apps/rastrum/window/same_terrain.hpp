// SPDX-License-Identifier: BSD-3-Clause
// The picture of a terrain's window as text.
#pragma once

#include <string>

#include "parse/ground_options.hpp"
#include "parse/terrain_options.hpp"
#include "terrain_control.hpp"

namespace rastrum::cli::window {

struct ShownTerrain {
  const TerrainInput& input;
  const TerrainLook& look;      ///< except the pose's values
  const terrain::Light& light;  ///< except the sun
  bool sky_dims;
  const GroundShown& shown;   ///< of the command line, except what follows
  const std::string& lights;  ///< sun, headlight, studio; empty: as given
  const FrameOptions& frame;  ///< with these lights
  const TerrainPose& pose;
  int width = 0, height = 0;
};

/// The angle of the degrees that options and Python use; applied again, it stays.
[[nodiscard]] double angle_in_degrees(double rad);
/// The pose with such angles; others have no text.
[[nodiscard]] TerrainPose sayable(TerrainPose pose);

/// `rastrum terrain …`, which writes the same bits to `png`, after a comment about what it cannot
/// express.
[[nodiscard]] std::string terrain_command_line(const ShownTerrain& shown, const std::string& png);
[[nodiscard]] std::string terrain_python(const ShownTerrain& shown, const std::string& png);

}  // namespace rastrum::cli::window
