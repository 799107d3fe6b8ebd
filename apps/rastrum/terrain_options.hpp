// The options that say which terrain is drawn, from where and in which light, shared by the
// commands that draw it.
#pragma once

#include <optional>

#include <apps/command_line/parser.hpp>

#include <rastrum/terrain/light.hpp>
#include <rastrum/terrain/options.hpp>

#include "option.hpp"
#include "terrain_input.hpp"

namespace rastrum::cli {

struct TerrainSceneArguments {
  TerrainInput input;
  terrain::TerrainOptions options;
  terrain::Light light;
  std::optional<double> x, y, altitude, horizon_px;
  double angle_deg = 0, roll_deg = 0;
};

/// Each adds a group of options to `app`; parsing fills `a`, which must outlive it.
void add_terrain_inputs(Parser& app, TerrainSceneArguments& a);
void add_terrain_camera(Parser& app, TerrainSceneArguments& a);
void add_terrain_picture(Parser& app, TerrainSceneArguments& a);
void add_terrain_light(Parser& app, TerrainSceneArguments& a);
void add_terrain_machine(Parser& app, TerrainSceneArguments& a);

/// Where one stands who did not say: over the south of the map, looking down on all of it.
[[nodiscard]] terrain::TerrainCamera camera_of(const TerrainSceneArguments& a,
                                               const LoadedTerrain& source);

}  // namespace rastrum::cli
