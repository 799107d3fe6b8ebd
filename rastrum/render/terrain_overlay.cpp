// SPDX-License-Identifier: BSD-3-Clause
// Draws over a picture of a terrain: axes and a box in its world, a bar of its heights, text.
#include <rastrum/on_terrain.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/core/view_rows.hpp>
#include <rastrum/render/terrain_camera.hpp>

namespace rastrum {
namespace {

constexpr overlay::AxisNames kNames{"x", "height", "y"};

}  // namespace

void draw_terrain_axes(const terrain::TerrainOptions& options, const terrain::TerrainCamera& camera,
                       const terrain::TerrainTargets& picture, overlay::Corner corner,
                       const overlay::Look& look) {
  const FloatScope floats;
  check_size(picture.color8, options.width, options.height, "the color8 target");
  overlay::draw_axes({.color8 = picture.color8}, terrain_lens(options, camera), corner, look,
                     kNames);
}

void draw_terrain_bounds(const terrain::Terrain& map, double cells_a_unit,
                         const terrain::TerrainOptions& options,
                         const terrain::TerrainCamera& camera,
                         const terrain::TerrainTargets& picture, const overlay::Look& look) {
  const FloatScope floats;
  if (!map.is_map()) reject("a terrain of a function has no ends, so no box around it");
  if (!(std::isfinite(cells_a_unit) && cells_a_unit != 0))
    reject("the box around a map: a unit of its heights must be some cells high, got ",
           cells_a_unit);
  check_size(picture.color8, options.width, options.height, "the color8 target");
  check_size(picture.depth, options.width, options.height, "the depth target");
  const auto highest = static_cast<double>(map.highest());
  double lowest = std::numeric_limits<double>::infinity();
  for (const float h : map.heights()->pixels())
    if (std::isfinite(h)) lowest = std::min(lowest, static_cast<double>(h));
  if (!(lowest <= highest)) return;  // only holes
  Image<float> reversed;
  if (!picture.depth.empty()) {
    reversed = Image<float>(options.width, options.height);
    for (int y = 0; y < options.height; ++y)
      for (int x = 0; x < options.width; ++x)
        reversed(x, y) = terrain::reversed_depth(picture.depth(x, y), SceneOnTerrain::kNear);
  }
  // The world with heights in their own unit.
  Camera lens = terrain_lens(options, camera);
  Mat4d units = Mat4d::identity();
  units.m[1][1] = cells_a_unit;
  lens.matrix = *lens.matrix * units;
  const auto [low, high] = std::minmax({lowest / cells_a_unit, highest / cells_a_unit});
  overlay::draw_bounds({.color8 = picture.color8}, lens, {0, low, 0},
                       {static_cast<double>(map.heights()->width()), high,
                        static_cast<double>(map.heights()->height())},
                       std::as_const(reversed).view(), look, kNames);
}

void check_ground_annotations(const Annotations& a, const GroundNumbers& numbers) {
  const char* const of_meshes = a.occlusion     ? "occlusion"
                                : a.dome        ? "dome"
                                : a.silhouettes ? "silhouettes"
                                : a.edges       ? "edges"
                                                : nullptr;
  if (of_meshes != nullptr)
    reject("Annotations::", of_meshes,
           ": is drawn on meshes only; a terrain has bounds, axes, bar, title and captions");
  if (a.bar && (numbers.mapping == nullptr || numbers.colors == nullptr))
    reject("Annotations::bar: needs heights that are coloured as numbers; these are not");
  check(a);
}

void draw_ground_annotations(const Annotations& a, const terrain::Terrain& ground,
                             const GroundNumbers& numbers, const terrain::TerrainOptions& options,
                             const terrain::TerrainCamera& camera,
                             const terrain::TerrainTargets& picture) {
  const FloatScope floats;
  check_ground_annotations(a, numbers);
  // Light letters with a dark rim are readable on sky and on ground.
  const overlay::Look look = look_of(a, {});
  const overlay::Canvas canvas{.color8 = picture.color8};
  if (a.bounds) draw_terrain_bounds(ground, numbers.cells_a_unit, options, camera, picture, look);
  if (a.axes) draw_terrain_axes(options, camera, picture, overlay::Corner::bottom_left, look);
  if (a.bar) draw_bar(*a.bar, *numbers.mapping, *numbers.colors, canvas, look);
  draw_words(a, canvas, look);
}

}  // namespace rastrum
