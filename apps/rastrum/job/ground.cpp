// SPDX-License-Identifier: BSD-3-Clause
#include "ground.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>

#include "parse/arguments.hpp"

namespace rastrum::cli {
namespace {

/// The relief of a map without a scale, as a part of its shorter side. Natural reliefs are a fifth
/// (a volcano at 30 m per cell) to a fiftieth of it.
constexpr double kReliefOfSide = 1.0 / 12;

std::string digits(double value, int n) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, n);
  return {text, end.ptr};
}

struct Relief {
  double low = std::numeric_limits<double>::infinity(), high = -low;
};

/// Ignores heights that are not finite.
Relief relief_of(const Image<float>& heights) {
  Relief r;
  for (const float h : heights.pixels()) {
    if (!std::isfinite(h)) continue;
    r.low = std::min(r.low, static_cast<double>(h));
    r.high = std::max(r.high, static_cast<double>(h));
  }
  return r;
}

GroundLights ground_lights(const TerrainLook& options, const terrain::Light& light,
                           const FrameOptions& frame) {
  GroundLights ground;
  ground.lights = frame.lights;
  ground.shadows = light.shadows;
  ground.sun_radius_deg = light.sun_radius_deg;
  ground.march = light.march;
  ground.tone = frame.tone;
  ground.smooth = options.filter == terrain::MapFilter::bilinear;
  return ground;
}

}  // namespace

LoadedTerrain::LoadedTerrain(const TerrainInput& input) {
  if (input.height.has_value() == !input.function.empty())
    throw UsageError("--height", "give a height map or --function, one of the two");
  if (input.color && !input.height)
    throw UsageError("--color", "needs --height; a function is coloured by its heights");
  if (!input.height) {
    for (const terrain::FunctionInfo& info : terrain::named_functions()) {
      if (info.name != input.function) continue;
      function_ = terrain::named_function(info.name);
      low_ = info.low;
      high_ = info.high;
      return;
    }
    // A single word that is no formula of x and y was meant as a name.
    if (input.function.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789") ==
            std::string::npos &&
        input.function.size() > 1 &&
        input.function.find_first_not_of("0123456789") != std::string::npos)
      (void)terrain::named_function(input.function);
    function_ = terrain::expression_function(input.function);
    const terrain::HeightRange range = terrain::sampled_range(function_);
    low_ = range.low;
    high_ = range.high;
    return;
  }
  io::HeightGrid grid = io::read_heights(*input.height, input.raw_size);
  std::optional<double> scale = input.height_scale;
  if (!scale && !grid.scale_known && !input.classic_scale) {
    const Relief file = relief_of(grid.heights);
    if (file.high > file.low) {
      const int side = std::min(grid.heights.width(), grid.heights.height());
      const std::string chosen = digits(kReliefOfSide * side / (file.high - file.low), 2);
      scale = std::strtod(chosen.c_str(), nullptr);
      scale_note_ = input.height->string() + ": does not say how long a cell is; its heights of " +
                    digits(file.low, 6) + " to " + digits(file.high, 6) +
                    " are drawn with --height-scale " + chosen +
                    ", a twelfth of the map's side (more is steeper)";
    }
  }
  for (float& h : grid.heights.pixels()) {
    // Division by 257 makes whole numbers of 8-bit heights in 16 bits; multiplication might not.
    h = scale ? h * static_cast<float>(*scale)
              : static_cast<float>(static_cast<double>(h) / grid.units_per_cell);
    if (!std::isfinite(h)) h = std::numeric_limits<float>::quiet_NaN();
  }
  cells_a_unit_ = scale ? static_cast<double>(static_cast<float>(*scale)) : 1 / grid.units_per_cell;
  const Relief cells = relief_of(grid.heights);
  low_ = cells.low;
  high_ = cells.high;
  if (!(low_ <= high_))
    throw Error(Errc::unsupported, input.height->string() + ": has no height that is a number");
  map_.heights = std::move(grid.heights);
  painted_ = input.color.has_value();
  if (painted_) map_.colors = io::read_image(*input.color);
}

void LoadedTerrain::show_numbers(const ScalarMapping& mapping, const TerrainLook& o) {
  ScalarRange in_use{low_, high_};
  if (is_map()) {
    std::vector<double> numbers;
    numbers.reserve(map_.heights.pixels().size());
    for (const float h : map_.heights.pixels())
      numbers.push_back(static_cast<double>(h) / cells_a_unit_);
    in_use = finite_range(numbers, mapping.logarithmic);
  }
  numbers_.emplace(mapping, in_use);
  if (!is_map()) return;
  // Filtered heights get finer colours, so that steps stay sharp between cells.
  const int finer = o.filter == terrain::MapFilter::bilinear ? 0 : 1;
  map_.colors = terrain::colors_of_heights(map_.heights.view(), *numbers_, cells_a_unit_, finer,
                                           o.tiling, o.threads);
}

terrain::Terrain LoadedTerrain::lit(terrain::Light light, const TerrainLook& o) const {
  light.hill_shading = !painted_;
  light.smooth = o.filter == terrain::MapFilter::bilinear;
  if (!is_map()) return terrain::function_terrain(function_, low_, high_, light, numbers_);
  terrain::HeightMap map{map_.heights, {}};
  if (light.shadows == terrain::Shadows::none && !light.hill_shading)
    map.colors = map_.colors;
  else
    map.colors = terrain::lit_colors(map_, light, {o.tiling, o.device, o.threads, o.isa});
  return terrain::Terrain(std::move(map));
}

terrain::Terrain LoadedTerrain::lit(const GroundLights& lights, const TerrainLook& o) const {
  if (!is_map()) return function_terrain(function_, low_, high_, lights, numbers_);
  return terrain::Terrain(terrain::HeightMap{
      map_.heights, lit_colors(map_, lights, {o.tiling, o.device, o.threads, o.isa})});
}

terrain::TerrainCamera camera_of(const TerrainSceneArguments& a, const LoadedTerrain& source) {
  terrain::TerrainCamera camera;
  camera.x = a.x.value_or(source.width() / 2.0);
  camera.y = a.y.value_or(source.height() * (800.0 / 1024));
  const double relief = source.highest() - source.lowest();
  camera.altitude =
      a.altitude.value_or(a.options.classic ? 78 : source.highest() + std::max(relief / 10, 1.0));
  camera.angle_rad = a.angle_deg * kDegree;
  camera.horizon_px = a.horizon_px.value_or(a.options.classic ? 100 : a.options.height / 4);
  camera.roll_rad = a.roll_deg * kDegree;
  return camera;
}

LitGround::LitGround(const LoadedTerrain& source, const TerrainLook& options,
                     const terrain::Light& light, const FrameOptions& frame,
                     const terrain::TerrainCamera& camera)
    : source_(source),
      options_(options),
      moves_(std::ranges::any_of(frame.lights, &Light::of_camera)),
      lights_(ground_lights(options, light, frame)),
      lit_(frame.lights.empty() ? source.lit(light, options) : source.lit(at(camera), options)) {}

const terrain::Terrain& LitGround::seen_from(const terrain::TerrainCamera& camera) {
  if (!moves_) return lit_;
  const std::optional<double> clearance = options_.classic ? 10 : options_.ground_clearance;
  const terrain::TerrainCamera stands =
      clearance ? terrain::above_ground(lit_, camera, *clearance, options_.tiling) : camera;
  if (stands != lights_.camera) lit_ = source_.lit(at(stands), options_);
  return lit_;
}

Annotations meant(const GroundOptions& ground, const LoadedTerrain& source, Annotations also) {
  also.bounds = ground.bounds && source.is_map();
  also.axes = ground.axes;
  if (source.numbers() != nullptr) also.bar = bar_words(ground.heights);
  return also;
}

GroundNumbers numbers_of(const GroundOptions& ground, const LoadedTerrain& source) {
  return {source.cells_a_unit(), &ground.heights.mapping, source.numbers()};
}

}  // namespace rastrum::cli
