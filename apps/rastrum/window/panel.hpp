// SPDX-License-Identifier: BSD-3-Clause
// The panel over the picture, with the subject's own controls inside.
#pragma once

#include <string>
#include <vector>

#include <apps/command_line/choose.hpp>

#include "shell.hpp"

namespace rastrum::cli::window {

class MeshSubject;
class TerrainSubject;

/// In px of the window.
struct Area {
  float x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  [[nodiscard]] bool holds(double x, double y) const {
    return x >= double{x0} && x < double{x1} && y >= double{y0} && y < double{y1};
  }
};

/// Inside an ImGui frame. Returns the panel's area.
Area draw_panel(Viewer& viewer, const Controls& controls);
/// Errors and notices, for a hidden panel.
void draw_messages(const Viewer& viewer);
/// Describes beside the pointer what lies under it.
void draw_hovered(const Viewer& viewer);

/// A list to choose from; true if `now` has changed.
bool choose_name(const char* label, const std::vector<std::string>& names, std::string& now);

/// With `none` before the names, for an empty `value`.
bool choose_name_or_none(const char* label, const std::string& none, std::vector<std::string> names,
                         std::string& value);
/// With the words of an option.
template <class T>
bool choose_value(const char* label, const Choices<T>& choices, T& value) {
  std::vector<std::string> names;
  for (const auto& choice : choices) names.emplace_back(choice.first);
  std::string now = word_of(choices, value);
  if (!choose_name(label, names, now)) return false;
  value = choose(label, now, choices);
  return true;
}

void draw_mesh_controls(MeshSubject& subject);
void draw_terrain_controls(TerrainSubject& subject);

}  // namespace rastrum::cli::window
