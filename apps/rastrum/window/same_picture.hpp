// SPDX-License-Identifier: BSD-3-Clause
// A window's picture as text for a shell and for Python.
#pragma once

#include <string>

#include <rastrum/camera.hpp>

#include "mesh_settings.hpp"

namespace rastrum::cli::window {

struct ShownPicture {
  const SceneArguments& arguments;  ///< of the command line
  const MeshSettings& settings;
  const Camera& camera;
  int width = 0, height = 0;
};

/// `rastrum render …`, which writes the same bits to `png`. Repeats options that the window does
/// not know.
[[nodiscard]] std::string command_line(const ShownPicture& shown, const std::string& png);
/// For Python; a comment names options that it lacks.
[[nodiscard]] std::string python_lines(const ShownPicture& shown, const std::string& png);

}  // namespace rastrum::cli::window
