// SPDX-License-Identifier: BSD-3-Clause
// The picture that a window shows, said so that others draw it: for a shell and for Python.
#pragma once

#include <string>

#include <rastrum/camera.hpp>

#include "mesh_settings.hpp"

namespace rastrum::cli::window {

struct ShownPicture {
  const SceneArguments& arguments;  ///< as the command line had them
  const MeshSettings& settings;
  const Camera& camera;
  int width = 0, height = 0;
};

/// `rastrum render …`, which writes the same bits to `png`. Options of which the window knows
/// nothing are repeated as they were given.
[[nodiscard]] std::string command_line(const ShownPicture& shown, const std::string& png);
/// The same for Python; options that it has no words for are named in a comment.
[[nodiscard]] std::string python_lines(const ShownPicture& shown, const std::string& png);

}  // namespace rastrum::cli::window
