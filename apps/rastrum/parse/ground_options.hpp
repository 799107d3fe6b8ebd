// SPDX-License-Identifier: BSD-3-Clause
// How `rastrum terrain` shows its ground: lights as for meshes, heights as numbers with their bar,
// axes and a box around the map.
#pragma once

#include <functional>
#include <vector>

#include <rastrum/frame.hpp>
#include <rastrum/render.hpp>
#include <rastrum/terrain.hpp>

#include "annotations.hpp"
#include "arguments.hpp"
#include "light_options.hpp"
#include "scalar_options.hpp"
#include "terrain_options.hpp"

namespace rastrum::cli {

struct GroundOptions {
  ScalarOptions heights;
  bool axes = false, bounds = false;

  [[nodiscard]] bool draws() const { return axes || bounds || heights.bar(); }
};

/// The part of these options that a window shows, and how it was given.
struct GroundShown {
  FrameOptions frame;  ///< lights, their tone, and whether the environment is behind
  GroundOptions ground;
  std::vector<Parser::Given> given;
};

/// Adds --cmap, --bar and their like, --axes and --bounds.
void add_ground_options(Parser app, GroundOptions& ground);

/// Checks what the parser cannot check. Options of how numbers become colours imply `--scalars
/// height`. `given`: whether an option was. Throws UsageError.
void check_ground(GroundOptions& ground, const TerrainSceneArguments& a, const FrameOptions& frame,
                  const LightChoice& choice, bool has_colors,
                  const std::function<bool(const char*)>& given);

}  // namespace rastrum::cli
