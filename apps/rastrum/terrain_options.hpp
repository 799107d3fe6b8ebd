// The options that say which terrain is drawn, from where and in which light, shared by the
// commands that draw it.
#pragma once

#include <optional>

#include <apps/command_line/parser.hpp>

#include <rastrum/terrain.hpp>
#include <rastrum/terrain_light.hpp>

#include "option.hpp"
#include "terrain_input.hpp"

namespace rastrum::cli {

struct TerrainSceneArguments {
  TerrainInput input;
  TerrainLook options;
  bool filter_given = false, tile_given = false;
  bool sky_dims = true;  ///< with a low sun; one of the caller's own does not
  bool dim_sky = false;  ///< but where that is asked for
  terrain::Light light;
  std::optional<double> x, y, altitude, horizon_px;
  double angle_deg = 0, roll_deg = 0;

  /// The program filters, with the steps that go with it, unless it is told otherwise.
  TerrainSceneArguments() {
    options.filter = terrain::MapFilter::bilinear;
    options.step = 0;
  }
};

/// Each adds a group of options to `app`; parsing fills `a`, which must outlive it.
void add_terrain_inputs(Parser& app, TerrainSceneArguments& a);
void add_terrain_camera(Parser& app, TerrainSceneArguments& a);
void add_terrain_picture(Parser& app, TerrainSceneArguments& a);
void add_terrain_light(Parser& app, TerrainSceneArguments& a);
void add_terrain_machine(Parser& app, TerrainSceneArguments& a);

/// Sets options that were not given and depend on others: the original program (--classic) has no
/// filter and a scale of its own. Called once all options are read.
void settle(TerrainSceneArguments& a);

/// The sky's colour with the sun there.
[[nodiscard]] Rgba8 sky_of(const terrain::TerrainOptions& options, const terrain::Sun& sun,
                           bool dims);

/// The camera, with defaults for what was not given: over the south of the map, looking down on all
/// of it.
[[nodiscard]] terrain::TerrainCamera camera_of(const TerrainSceneArguments& a,
                                               const LoadedTerrain& source);

}  // namespace rastrum::cli
