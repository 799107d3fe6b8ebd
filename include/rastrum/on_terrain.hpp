// SPDX-License-Identifier: BSD-3-Clause
// Meshes and terrains together: lights and environments over ground, and meshes and sprites that
// stand on it (paper 3's future work). A `Renderer` draws the meshes and sprites; depth composes
// them with a picture of `TerrainRenderer`. A terrain's world is (x, height, y), with x east and y
// south in cells of the map. This is Rastrum's world with +y up and the map's rows along +z.
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

/// Lights over ground, in place of terrain::Light. They are like FrameOptions::lights, in the
/// terrain's world. Ground is matt like surfaces under Shader::lambert (docs/light_rules.md): its
/// display values times the light that its normal gathers. If `tone` maps light, ground is like a
/// surface without reflections under Shader::material: its light is linear, and is then mapped.
struct GroundLights {
  std::vector<Light> lights{};
  /// How a cell's share of each directional light is found. `accumulated` leaves √(1 / (1 + n)) of
  /// the light, n as in terrain::Shadows. Lights with a place or from all around cast no shadows.
  terrain::Shadows shadows = terrain::Shadows::none;
  double sun_radius_deg = 0.2666;  ///< of directional lights, for `soft`
  terrain::March march{};          ///< for `accumulated`, and for all shadows of functions
  ToneMapping tone{};
  bool smooth = false;  ///< as terrain::Light::smooth
  /// The camera that Light::of_camera lights move with; when it moves, the ground is lit again.
  terrain::TerrainCamera camera{};
};

/// The colours of a map under these lights, opaque, as terrain::lit_colors gives them. The bits are
/// the same for every device, number of threads and instruction set. Cost: the shadows of each
/// directional light, and O(cells · lights). Throws Error{invalid_argument} for a map without
/// cells, lights that check_lights refuses, and a tone, a sun's radius or a march out of range.
[[nodiscard]] Image<Rgba8> lit_colors(const terrain::HeightMap& map, const GroundLights& lights,
                                      const terrain::ShadowOptions& options = {});

/// The terrain of a function under these lights, which light it where it is seen; otherwise as
/// terrain::function_terrain. A device leaves it to the CPU.
[[nodiscard]] terrain::Terrain function_terrain(terrain::HeightFunction function, double low,
                                                double high, const GroundLights& lights,
                                                std::optional<ScalarColors> colors = {});

/// Draws the environments among `lights`, mapped by `tone`, into a finished picture of a terrain
/// where it has no ground: at an infinite depth. `options` and `camera` (TerrainStats::camera) are
/// the picture's, with any projection. `threads` 0: all. Throws Error{invalid_argument} if there is
/// no environment, or the picture has no depth.
void draw_environment_behind(std::span<const Light> lights, const ToneMapping& tone,
                             const terrain::TerrainOptions& options,
                             const terrain::TerrainCamera& camera,
                             const terrain::TerrainTargets& picture, int threads = 0);

/// The mean colour around the horizon of the environments among `lights`: far ground fades to it in
/// fog. Throws as draw_environment_behind.
[[nodiscard]] Rgba8 horizon_color(std::span<const Light> lights, const ToneMapping& tone,
                                  const terrain::TerrainCamera& camera = {});

/// Draws the axes x, height and y over a picture of a terrain, as overlay::draw_axes does. Throws
/// as terrain::world_to_clip.
void draw_terrain_axes(const terrain::TerrainOptions& options, const terrain::TerrainCamera& camera,
                       const terrain::TerrainTargets& picture,
                       overlay::Corner corner = overlay::Corner::bottom_left,
                       const overlay::Look& look = {});
/// Draws the box around a map over its picture, as overlay::draw_bounds does. Its numbers are cells
/// and, for heights, units of which each is `cells_a_unit` cells high. Nearer surfaces hide it
/// where the picture has depth. Throws Error{invalid_argument} for a function; else as
/// terrain::world_to_clip.
void draw_terrain_bounds(const terrain::Terrain& map, double cells_a_unit,
                         const terrain::TerrainOptions& options,
                         const terrain::TerrainCamera& camera,
                         const terrain::TerrainTargets& picture, const overlay::Look& look = {});

/// The meaning of heights, for numbers beside a picture.
struct GroundNumbers {
  double cells_a_unit = 1;  ///< how many cells high a unit is
  /// How heights are coloured (terrain::colors_of_heights); null: not as numbers.
  const ScalarMapping* mapping = nullptr;
  const ScalarColors* colors = nullptr;
};

/// Throws Error{invalid_argument} for `annotations` that only meshes have (occlusion, dome,
/// silhouettes, edges) and for a bar of heights that are not coloured as numbers; else as
/// check(annotations).
void check_ground_annotations(const Annotations& annotations, const GroundNumbers& numbers);
/// Draws annotations over a picture of a terrain, in this order: the box (draw_terrain_bounds), the
/// axes (draw_terrain_axes), the bar of the heights, the words. `camera` is the picture's
/// (TerrainStats::camera). Throws as check_ground_annotations and as these two.
void draw_ground_annotations(const Annotations& annotations, const terrain::Terrain& ground,
                             const GroundNumbers& numbers, const terrain::TerrainOptions& options,
                             const terrain::TerrainCamera& camera,
                             const terrain::TerrainTargets& picture);

/// Meshes and sprites on a terrain, in its world.
struct TerrainScene {
  SceneView scene{};
  /// Indices of billboards: instances that turn about their +y until +z faces the picture's plane.
  std::span<const std::size_t> facing{};
};

/// Draws meshes and sprites on terrains; keeps threads and scratch. Threads and stopping: as
/// Renderer.
class SceneOnTerrain {
 public:
  /// Surfaces nearer than this, in cells along the view, are cut off.
  static constexpr double kNear = 0.125;

  explicit SceneOnTerrain(Renderer renderer);
  ~SceneOnTerrain();
  SceneOnTerrain(SceneOnTerrain&&) noexcept;
  SceneOnTerrain& operator=(SceneOnTerrain&&) noexcept;

  /// Draws `scene` into a picture of the same size that TerrainRenderer has drawn with these
  /// `options`. `camera` is that picture's (TerrainStats::camera). A pixel shows the scene where it
  /// is nearer than the terrain's sample there, by `kNear` / z in float32; of equal depths the
  /// terrain's wins. Translucent surfaces are blended over the terrain: in linear light with
  /// Shader::material, but as display values if `frame.tone` maps that light first. The lights of
  /// `frame` and their shadows are the scene's alone; `frame.environment_behind` draws the
  /// environment behind ground and scene (draw_environment_behind). `picture.depth` must hold the
  /// terrain's distances; afterwards it has that of the nearest surface, whatever its alpha.
  /// Classic and rolled pictures and every horizon are possible (terrain::world_to_clip). Throws
  /// Error{invalid_argument} for the cylindrical projection, Shader::depth, a tone without
  /// Shader::material and an index of `facing` out of range; else as Renderer::render.
  FrameStats draw(const TerrainScene& scene, const FrameOptions& frame,
                  const terrain::TerrainOptions& options, const terrain::TerrainCamera& camera,
                  const terrain::TerrainTargets& picture, StopToken stop = {});

 private:
  struct RASTRUM_INSIDE Impl;
  Held<Owner<Impl>> impl_;
};

}  // namespace rastrum
