// SPDX-License-Identifier: BSD-3-Clause
// Which terrain is drawn, from where and in which light, as options.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <apps/command_line/choose.hpp>

#include <rastrum/io.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain_light.hpp>

#include "arguments.hpp"

namespace rastrum::cli {

inline const Choices<terrain::MapFilter> kFilters{{"none", terrain::MapFilter::none},
                                                  {"bilinear", terrain::MapFilter::bilinear},
                                                  {"mip", terrain::MapFilter::mip}};
inline const Choices<terrain::Tiling> kTilings{{"repeat", terrain::Tiling::repeat},
                                               {"mirror", terrain::Tiling::mirror},
                                               {"clamp", terrain::Tiling::clamp},
                                               {"none", terrain::Tiling::none}};
inline const Choices<terrain::Projection> kProjections{
    {"planar", terrain::Projection::planar}, {"cylindrical", terrain::Projection::cylindrical}};
inline const Choices<terrain::Shadows> kShadows{{"none", terrain::Shadows::none},
                                                {"accumulated", terrain::Shadows::accumulated},
                                                {"sharp", terrain::Shadows::sharp},
                                                {"soft", terrain::Shadows::soft}};

/// A picture depends on these beside terrain, light and camera.
struct TerrainLook : terrain::TerrainOptions, terrain::TerrainRendererOptions {};

struct TerrainInput {
  std::optional<std::filesystem::path> height, color;
  io::RawSize raw_size;                ///< size and byte order of raw heights
  std::optional<double> height_scale;  ///< none: the file's own, or one that suits its heights
  /// Without a unit in the file: the original program's (1/257 of a cell for 16 bits, else a cell)
  /// instead of one that suits the heights.
  bool classic_scale = false;
  std::string function;  ///< a name or an expression, if there is no file
};

/// `none` for files that end at their edge (io::ends_at_edge).
[[nodiscard]] terrain::Tiling suited_tiling(const TerrainInput& input);

struct TerrainSceneArguments {
  TerrainInput input;
  TerrainLook options;
  bool filter_given = false, tile_given = false;
  bool sky_dims = true;  ///< with a low sun, unless the colour was given
  bool dim_sky = false;  ///< even then
  terrain::Light light;
  std::optional<double> x, y, altitude, horizon_px;
  double angle_deg = 0, roll_deg = 0;

  /// The program filters by default, with the steps that go with it.
  TerrainSceneArguments() {
    options.filter = terrain::MapFilter::bilinear;
    options.step = 0;
  }
};

/// Parsing fills `a`, which must outlive `app`.
void add_terrain_inputs(Parser app, TerrainSceneArguments& a);
void add_terrain_camera(Parser app, TerrainSceneArguments& a);
void add_terrain_picture(Parser app, TerrainSceneArguments& a);
void add_terrain_light(Parser app, TerrainSceneArguments& a);
void add_terrain_machine(Parser app, TerrainSceneArguments& a);

/// Sets options that were not given and depend on others: the original program (--classic) has no
/// filter and its own scale. Call it once all options are read.
void settle(TerrainSceneArguments& a);

/// The sky's colour with the sun there.
[[nodiscard]] Rgba8 sky_of(const terrain::TerrainOptions& options, const terrain::Sun& sun,
                           bool dims);

}  // namespace rastrum::cli
