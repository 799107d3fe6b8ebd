// The panel over the picture: what every subject has, with the subject's own controls inside.
#pragma once

#include <string>
#include <vector>

#include "shell.hpp"

namespace rastrum::cli::window {

class MeshSubject;
class TerrainSubject;

/// The area that a panel covers, px of the window.
struct Area {
  float x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  [[nodiscard]] bool holds(double x, double y) const {
    return x >= double{x0} && x < double{x1} && y >= double{y0} && y < double{y1};
  }
};

/// Inside an ImGui frame. Returns where the panel is.
Area draw_panel(Viewer& viewer, const Controls& controls);
/// Errors and notices alone, where the panel is hidden.
void draw_messages(const Viewer& viewer);
/// Beside the pointer, what lies under it.
void draw_hovered(const Viewer& viewer);

/// A list to choose from; true where `now` has changed.
bool choose_name(const char* label, const std::vector<std::string>& names, std::string& now);

/// The controls of meshes.
void draw_mesh_controls(MeshSubject& subject);

/// The controls of a terrain.
void draw_terrain_controls(TerrainSubject& subject);

}  // namespace rastrum::cli::window
