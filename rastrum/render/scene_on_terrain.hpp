// Meshes and sprites on a terrain (paper 3's future work): what `Renderer` draws, composed by depth
// with a picture of `TerrainRenderer`. Here the two rooms meet, which know nothing of each other.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/render/render.hpp>
#include <rastrum/terrain/options.hpp>

namespace rastrum {

/// What stands on a terrain. Its world is (x, height, y): x east and y south in cells of the map,
/// which is Rastrum's world with +y up and the map's rows along +z.
struct TerrainScene {
  SceneView scene{};
  /// Indices of instances that turn about their own +y until their +z looks at the picture's plane:
  /// billboards.
  std::span<const std::size_t> facing{};
};

/// Keeps threads and scratch between frames.
class SceneOnTerrain {
 public:
  /// What is nearer than this, in cells along the view, is cut off.
  static constexpr double kNear = 0.125;

  /// The options' size is that of the terrain's pictures. Throws as Renderer.
  explicit SceneOnTerrain(RenderOptions options);

  /// Draws into a picture that TerrainRenderer has drawn with these options and this camera, as it
  /// stood (TerrainStats::camera). A pixel of the scene is seen where it is nearer than the
  /// terrain's sample there, `kNear` / z in float32; of equal depths the terrain's wins. What is
  /// translucent is blended over the terrain, in linear light with Shader::material.
  /// `picture.depth` must hold the terrain's distances; it is that of the nearest surface
  /// afterwards, whatever its alpha. Classic pictures, rolled ones and every horizon are met by
  /// their matrix (terrain/matrix.hpp). Throws Error{invalid_argument} for the cylindrical
  /// projection, Shader::depth, an index of `facing` out of range; else as Renderer::render.
  FrameStats draw(const TerrainScene& scene, const terrain::TerrainOptions& options,
                  const terrain::TerrainCamera& camera, const terrain::TerrainTargets& picture);

 private:
  template <class Row>
  void for_each_row(const Row& row);

  Renderer renderer_;
  std::unique_ptr<parallel::Threads> threads_;  ///< null: serial
  Image<float> depth_;                          ///< reversed
  std::vector<InstanceView> instances_;
};

}  // namespace rastrum
