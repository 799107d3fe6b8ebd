// Meshes and sprites on a terrain (paper 3's future work): what `Renderer` draws, composed by depth
// with a picture of `TerrainRenderer`. Here the two rooms meet, which know nothing of each other.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <stop_token>

#include <rastrum/render.hpp>
#include <rastrum/terrain.hpp>

namespace rastrum {

/// What stands on a terrain. Its world is (x, height, y): x east and y south in cells of the map,
/// which is Rastrum's world with +y up and the map's rows along +z.
struct TerrainScene {
  SceneView scene{};
  /// Indices of instances that turn about their own +y until their +z looks at the picture's plane:
  /// billboards.
  std::span<const std::size_t> facing{};
};

/// Keeps threads and scratch between frames. Threads and stopping: as Renderer.
class SceneOnTerrain {
 public:
  /// What is nearer than this, in cells along the view, is cut off.
  static constexpr double kNear = 0.125;

  explicit SceneOnTerrain(Renderer renderer);
  ~SceneOnTerrain();
  SceneOnTerrain(SceneOnTerrain&&) noexcept;
  SceneOnTerrain& operator=(SceneOnTerrain&&) noexcept;

  /// Draws into a picture that TerrainRenderer has drawn with these options and this camera, as it
  /// stood (TerrainStats::camera); both have the same size. A pixel of the scene is seen where it
  /// is nearer than the terrain's sample there, `kNear` / z in float32; of equal depths the
  /// terrain's wins. What is translucent is blended over the terrain, in linear light with
  /// Shader::material. `picture.depth` must hold the terrain's distances; it is that of the nearest
  /// surface afterwards, whatever its alpha. Classic pictures, rolled ones and every horizon are
  /// met by their matrix (terrain::world_to_clip). Throws Error{invalid_argument} for the
  /// cylindrical projection, Shader::depth, an index of `facing` out of range; else as
  /// Renderer::render.
  FrameStats draw(const TerrainScene& scene, const FrameOptions& frame,
                  const terrain::TerrainOptions& options, const terrain::TerrainCamera& camera,
                  const terrain::TerrainTargets& picture, std::stop_token stop = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rastrum
