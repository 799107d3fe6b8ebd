// SPDX-License-Identifier: BSD-3-Clause
// Meshes and terrains together: lights and environments over ground, and meshes and sprites that
// stand on it (paper 3's future work). `Renderer` draws these, composed by depth with a picture of
// `TerrainRenderer`. A terrain's world is (x, height, y): x east and y south in cells of the map,
// which is Rastrum's world with +y up and the map's rows along +z.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <rastrum/annotate.hpp>
#include <rastrum/color_map.hpp>
#include <rastrum/held.hpp>
#include <rastrum/light.hpp>
#include <rastrum/overlay.hpp>
#include <rastrum/render.hpp>
#include <rastrum/stop.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain_light.hpp>
#include <rastrum/tone.hpp>

namespace RASTRUM_API rastrum {

/// Lights over ground: like FrameOptions::lights, in the terrain's world, in place of
/// terrain::Light. Ground is matt like surfaces under Shader::lambert (docs/light_rules.md): its
/// display values times the light that the normal gathers. Where `tone` maps light, it is like a
/// surface without reflections under Shader::material: linear light, which is then mapped.
struct GroundLights {
  std::vector<Light> lights{};
  /// For each directional light: the share of it that a cell sees. `accumulated` leaves √(1 / (1 +
  /// n)) of it. Lights with a place and those from all around cast no shadows on ground.
  terrain::Shadows shadows = terrain::Shadows::none;
  double sun_radius_deg = 0.2666;  ///< of a directional light, for soft shadows
  terrain::March march{};          ///< of accumulated ones, and of all shadows of functions
  ToneMapping tone{};
  bool smooth = false;  ///< as terrain::Light::smooth
  /// The camera of Light::of_camera lights: when it moves, the ground is lit again.
  terrain::TerrainCamera camera{};
};

/// The colours of a map under these lights, opaque, as terrain::lit_colors gives them: the same
/// bits for every device, number of threads and instruction set. Cost: the shadows of each
/// directional light, and O(cells · lights). Throws Error{invalid_argument} for lights that
/// check_lights refuses, a tone, an ambient, a sun's radius or a march out of range.
[[nodiscard]] Image<Rgba8> lit_colors(const terrain::HeightMap& map, const GroundLights& lights,
                                      const terrain::ShadowOptions& options = {});

/// A terrain of a function under these lights, lit where it is seen; else as
/// terrain::function_terrain. A device leaves it to the CPU.
[[nodiscard]] terrain::Terrain function_terrain(terrain::HeightFunction function, double low,
                                                double high, const GroundLights& lights,
                                                std::optional<ScalarColors> colors = {});

/// Draws the environments among `lights`, as `tone` shows them, where a finished picture of a
/// terrain has no ground: at an infinite depth. `options` and `camera` are those of the picture
/// (TerrainStats::camera), of any projection. `threads` 0: all. Throws Error{invalid_argument}
/// where there is no environment, or the picture has no depth.
void draw_environment_behind(std::span<const Light> lights, const ToneMapping& tone,
                             const terrain::TerrainOptions& options,
                             const terrain::TerrainCamera& camera,
                             const terrain::TerrainTargets& picture, int threads = 0);

/// The mean colour of these environments around the horizon, to which far ground fades in fog.
/// Throws as draw_environment_behind.
[[nodiscard]] Rgba8 horizon_color(std::span<const Light> lights, const ToneMapping& tone,
                                  const terrain::TerrainCamera& camera = {});

/// overlay::draw_axes over a picture of a terrain: x, height and y. Throws as
/// terrain::world_to_clip.
void draw_terrain_axes(const terrain::TerrainOptions& options, const terrain::TerrainCamera& camera,
                       const terrain::TerrainTargets& picture,
                       overlay::Corner corner = overlay::Corner::bottom_left,
                       const overlay::Look& look = {});
/// overlay::draw_bounds around a map, in cells and in units of which each is so many cells high,
/// hidden by what is nearer where the picture has depth. Throws Error{invalid_argument} for a
/// function; as terrain::world_to_clip.
void draw_terrain_bounds(const terrain::Terrain& map, double cells_a_unit,
                         const terrain::TerrainOptions& options,
                         const terrain::TerrainCamera& camera,
                         const terrain::TerrainTargets& picture, const overlay::Look& look = {});

/// The meaning of heights, for numbers beside a picture.
struct GroundNumbers {
  double cells_a_unit = 1;  ///< how many cells a unit of them is high
  /// How they are coloured (terrain::colors_of_heights); null: they are not.
  const ScalarMapping* mapping = nullptr;
  const ScalarColors* colors = nullptr;
};

/// Throws Error{invalid_argument} for `annotations` that only meshes have: occlusion, dome,
/// silhouettes, edges; for a bar of heights that are not coloured as numbers; else as
/// check(annotations).
void check_ground_annotations(const Annotations& annotations, const GroundNumbers& numbers);
/// Annotations over a picture of a terrain: the box (draw_terrain_bounds), the axes
/// (draw_terrain_axes), the bar of the heights, the words, in this order. `camera`: as it stood
/// (TerrainStats::camera). Throws as check_ground_annotations and as these two.
void draw_ground_annotations(const Annotations& annotations, const terrain::Terrain& ground,
                             const GroundNumbers& numbers, const terrain::TerrainOptions& options,
                             const terrain::TerrainCamera& camera,
                             const terrain::TerrainTargets& picture);

/// Meshes and sprites on a terrain, in its world.
struct TerrainScene {
  SceneView scene{};
  /// Indices of instances that turn about their own +y until their +z looks at the picture's plane:
  /// billboards.
  std::span<const std::size_t> facing{};
};

/// Keeps threads and scratch between frames. Threads and stopping: as Renderer.
class SceneOnTerrain {
 public:
  /// Surfaces nearer than this, in cells along the view, are cut off.
  static constexpr double kNear = 0.125;

  explicit SceneOnTerrain(Renderer renderer);
  ~SceneOnTerrain();
  SceneOnTerrain(SceneOnTerrain&&) noexcept;
  SceneOnTerrain& operator=(SceneOnTerrain&&) noexcept;

  /// Draws into a picture that TerrainRenderer has drawn with these options and this camera, as it
  /// stood (TerrainStats::camera); both have the same size. A pixel of the scene is seen where it
  /// is nearer than the terrain's sample there, `kNear` / z in float32; of equal depths the
  /// terrain's wins. Translucent surfaces are blended over the terrain, in linear light with
  /// Shader::material, as display values where `frame.tone` maps that light first. Its lights and
  /// their shadows are of the scene alone; `frame.environment_behind` draws the environment behind
  /// ground and scene (draw_environment_behind). `picture.depth` must hold the terrain's distances;
  /// it is that of the nearest surface afterwards, whatever its alpha. Classic pictures, rolled
  /// ones and every horizon are met by their matrix (terrain::world_to_clip). Throws
  /// Error{invalid_argument} for the cylindrical projection, Shader::depth, a tone without
  /// Shader::material, an index of `facing` out of range; else as Renderer::render.
  FrameStats draw(const TerrainScene& scene, const FrameOptions& frame,
                  const terrain::TerrainOptions& options, const terrain::TerrainCamera& camera,
                  const terrain::TerrainTargets& picture, StopToken stop = {});

 private:
  struct RASTRUM_INSIDE Impl;
  Held<Owner<Impl>> impl_;
};

}  // namespace rastrum
