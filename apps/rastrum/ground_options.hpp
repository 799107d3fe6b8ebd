// How `rastrum terrain` shows its ground beside the sun: lights as meshes have them, heights as
// numbers with their bar, axes and a box around the map.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <rastrum/frame.hpp>
#include <rastrum/on_terrain.hpp>
#include <rastrum/render.hpp>
#include <rastrum/terrain.hpp>

#include "annotations.hpp"
#include "light_options.hpp"
#include "option.hpp"
#include "scalar_options.hpp"
#include "terrain_input.hpp"
#include "terrain_options.hpp"

namespace rastrum::cli {

struct GroundOptions {
  ScalarOptions heights;
  bool axes = false, bounds = false;

  [[nodiscard]] bool draws() const { return axes || bounds || heights.bar(); }
};

/// What a window shows of it, and how it was said.
struct GroundShown {
  FrameOptions frame;  ///< lights, their tone, and whether the environment is behind
  GroundOptions ground;
  std::vector<Parser::Given> given;
};

/// Adds --lights, --light, --tone, --exposure and --environment-behind, which fill `frame`: that of
/// what stands on the ground has the same.
void add_ground_lights(Parser& app, FrameOptions& frame, LightChoice& choice);
/// Adds --cmap, --bar and their like, --axes and --bounds.
void add_ground_options(Parser& app, GroundOptions& ground);

/// What the parser cannot see by itself; the numbers of a terrain become those of `--scalars
/// height`. `given`: whether an option was. Throws UsageError.
void check_ground(GroundOptions& ground, const TerrainSceneArguments& a, const FrameOptions& frame,
                  const LightChoice& choice, bool has_colors,
                  const std::function<bool(const char*)>& given);

/// The bar, the axes and the box over a finished picture, whose depth hides the box.
void draw_ground_annotations(const GroundOptions& ground, const LoadedTerrain& source,
                             const terrain::Terrain& terrain,
                             const terrain::TerrainOptions& options,
                             const terrain::TerrainCamera& camera,
                             const terrain::TerrainTargets& picture, const overlay::Look& look);

}  // namespace rastrum::cli
