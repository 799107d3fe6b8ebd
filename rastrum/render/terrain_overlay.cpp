// Axes and a box over a picture of a terrain, in its world.
#include <rastrum/on_terrain.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <rastrum/error.hpp>

namespace rastrum {
namespace {

constexpr overlay::AxisNames kNames{"x", "height", "y"};

Camera lens_of(const terrain::TerrainOptions& options, const terrain::TerrainCamera& camera) {
  Camera lens;
  lens.matrix = terrain::world_to_clip(options, camera, SceneOnTerrain::kNear);
  return lens;
}

}  // namespace

void draw_terrain_axes(const terrain::TerrainOptions& options, const terrain::TerrainCamera& camera,
                       const terrain::TerrainTargets& picture, overlay::Corner corner,
                       const overlay::Look& look) {
  check_size(picture.color8, options.width, options.height, "the color8 target");
  overlay::draw_axes({.color8 = picture.color8}, lens_of(options, camera), corner, look, kNames);
}

void draw_terrain_bounds(const terrain::Terrain& map, double cells_a_unit,
                         const terrain::TerrainOptions& options,
                         const terrain::TerrainCamera& camera,
                         const terrain::TerrainTargets& picture, const overlay::Look& look) {
  if (!map.is_map())
    throw Error(Errc::invalid_argument, "a terrain of a function has no ends, so no box around it");
  if (!(std::isfinite(cells_a_unit) && cells_a_unit != 0))
    throw Error(Errc::invalid_argument,
                "the box around a map: a unit of its heights must be some cells high, got " +
                    std::to_string(cells_a_unit));
  check_size(picture.color8, options.width, options.height, "the color8 target");
  check_size(picture.depth, options.width, options.height, "the depth target");
  const auto highest = static_cast<double>(map.highest());
  double lowest = std::numeric_limits<double>::infinity();
  for (const float h : map.heights()->pixels())
    if (std::isfinite(h)) lowest = std::min(lowest, static_cast<double>(h));
  if (!(lowest <= highest)) return;  // holes alone
  Image<float> reversed;
  if (!picture.depth.empty()) {
    reversed = Image<float>(options.width, options.height);
    for (int y = 0; y < options.height; ++y)
      for (int x = 0; x < options.width; ++x)
        reversed(x, y) = terrain::reversed_depth(picture.depth(x, y), SceneOnTerrain::kNear);
  }
  // The world with heights in their own unit.
  Camera lens = lens_of(options, camera);
  Mat4d units = Mat4d::identity();
  units.m[1][1] = cells_a_unit;
  lens.matrix = *lens.matrix * units;
  const auto [low, high] = std::minmax({lowest / cells_a_unit, highest / cells_a_unit});
  overlay::draw_bounds({.color8 = picture.color8}, lens, {0, low, 0},
                       {static_cast<double>(map.heights()->width()), high,
                        static_cast<double>(map.heights()->height())},
                       std::as_const(reversed).view(), look, kNames);
}

}  // namespace rastrum
