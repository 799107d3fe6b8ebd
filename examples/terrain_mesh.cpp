// SPDX-License-Identifier: BSD-3-Clause
// A terrain with a mesh on it: a height map under a sun, drawn without triangles, and a teapot on
// the ground, partly behind a hill. They meet by depth.
#include <cmath>

#include <rastrum/io.hpp>
#include <rastrum/on_terrain.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/transform.hpp>

namespace terrain = rastrum::terrain;

int main() {
  constexpr int kCells = 512;  // along each side
  terrain::HeightMap map{.heights = {kCells, kCells}, .colors = {kCells, kCells}};
  for (int y = 0; y < kCells; ++y)
    for (int x = 0; x < kCells; ++x) {
      const double height =
          16 * std::sin(x / 20.0) * std::cos(y / 27.0) + 5 * std::sin((x + y) / 8.0);
      map.heights(x, y) = static_cast<float>(height);
      map.colors(x, y) =
          height > 12 ? rastrum::Rgba8{150, 140, 120, 255} : rastrum::Rgba8{86, 128, 62, 255};
    }
  const terrain::Light sun{.sun = {.azimuth_deg = 300, .elevation_deg = 30},
                           .shadows = terrain::Shadows::soft,
                           .hill_shading = true};
  map.colors = terrain::lit_colors(map, sun);
  const terrain::Terrain ground(std::move(map));

  terrain::TerrainOptions options;
  options.width = 640;
  options.height = 360;
  options.filter = terrain::MapFilter::bilinear;
  options.step = 0;  // as fine as the picture's rows
  options.fog = {.density = 0.002, .start = 100};
  options.ground_clearance = 14;
  rastrum::Image<rastrum::Rgba8> picture(options.width, options.height);
  rastrum::Image<float> distance(options.width, options.height);
  const terrain::TerrainTargets targets{.color8 = picture, .depth = distance};
  const terrain::TerrainStats stats = terrain::TerrainRenderer().render(
      ground, {.x = 256, .y = 400, .altitude = 0, .horizon_px = 130}, options, targets);

  const rastrum::Mesh teapot = rastrum::shapes::teapot();
  const rastrum::MeshView view = teapot.view();
  const double x = 262, y = 340;  // x is east, y south; the mesh's z
  const rastrum::Mat4d place =
      rastrum::translation({x, terrain::ground_at(ground, x, y, options), y}) *
      rastrum::scaling({8, 8, 8});
  const rastrum::InstanceView instance{
      .geometry = view, .object_to_world = place, .color = rastrum::Vec4{0.8F, 0.35F, 0.2F, 1}};
  // The terrain's camera, lifted from the ground.
  rastrum::SceneOnTerrain(rastrum::Renderer())
      .draw({.scene = {.instances = {&instance, 1}}},
            {.width = options.width, .height = options.height}, options, stats.camera, targets);
  rastrum::io::write_png("terrain_mesh.png", picture);
}
