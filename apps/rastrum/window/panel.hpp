// The panel over the picture: what every subject has, with the subject's own controls inside.
#pragma once

#include <string>
#include <vector>

#include "shell.hpp"

namespace rastrum::cli::window {

class MeshSubject;
class TerrainSubject;

/// Inside an ImGui frame.
void draw_panel(Viewer& viewer, const Controls& controls);
/// Errors and notices alone, where the panel is hidden.
void draw_messages(const Viewer& viewer);

/// A list to choose from; true where `now` has changed.
bool choose_name(const char* label, const std::vector<std::string>& names, std::string& now);

/// The controls of meshes.
void draw_mesh_controls(MeshSubject& subject);

/// The controls of a terrain.
void draw_terrain_controls(TerrainSubject& subject);

}  // namespace rastrum::cli::window
