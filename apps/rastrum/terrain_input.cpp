#include "terrain_input.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <rastrum/core/error.hpp>
#include <rastrum/io/io.hpp>

#include "arguments.hpp"

namespace rastrum::cli {

LoadedTerrain::LoadedTerrain(const TerrainInput& input) {
  if (input.height.has_value() == !input.function.empty())
    throw UsageError("--height", "give a height map or --function, one of the two");
  if (input.color && !input.height)
    throw UsageError("--color", "functions have colours by their height; it goes with --height");
  if (!input.height) {
    for (const terrain::FunctionInfo& info : terrain::named_functions()) {
      if (info.name != input.function) continue;
      function_ = terrain::named_function(info.name);
      low_ = info.low;
      high_ = info.high;
      return;
    }
    // What is one word and no formula of x and y was meant as a name.
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
  const auto scale = static_cast<float>(input.height_scale.value_or(1 / grid.units_per_cell));
  low_ = std::numeric_limits<double>::infinity();
  high_ = -low_;
  for (float& h : grid.heights.pixels()) {
    // Division by 257 makes whole numbers of 8-bit heights in 16 bits; multiplication need not.
    h = input.height_scale ? h * scale
                           : static_cast<float>(static_cast<double>(h) / grid.units_per_cell);
    if (!std::isfinite(h)) {
      h = std::numeric_limits<float>::quiet_NaN();
      continue;
    }
    low_ = std::min(low_, static_cast<double>(h));
    high_ = std::max(high_, static_cast<double>(h));
  }
  if (!(low_ <= high_))
    throw Error(Errc::unsupported, input.height->string() + ": has no height that is a number");
  map_.heights = std::move(grid.heights);
  if (input.color) map_.colors = io::read_image(*input.color);
}

terrain::Terrain LoadedTerrain::lit(terrain::Light light,
                                    const terrain::ShadowOptions& options) const {
  light.hill_shading = map_.colors.empty();
  if (!is_map()) return terrain::function_terrain(function_, low_, high_, light);
  terrain::HeightMap map{map_.heights, {}};
  if (light.shadows == terrain::Shadows::none && !light.hill_shading)
    map.colors = map_.colors;
  else
    map.colors = terrain::lit_colors(map_, light, options);
  return terrain::Terrain(std::move(map));
}

}  // namespace rastrum::cli
