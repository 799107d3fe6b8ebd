// Shadows of a frame's lights: what each light sees of the scene, drawn by a renderer of its own.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <rastrum/image.hpp>
#include <rastrum/raster/shade/light_set.hpp>
#include <rastrum/render.hpp>

namespace rastrum {

class Shadows {
 public:
  /// One a light of `frame`; empty where none has any. `options`: of the renderer that draws the
  /// frame. The result lives until the next call. O(vertices + triangles + kShadowSize²) a light.
  std::span<const raster::LightShadow> draw(const SceneView& scene, const Camera& camera,
                                            const FrameOptions& frame,
                                            const RendererOptions& options);

 private:
  std::unique_ptr<Renderer> renderer_;
  std::vector<Image<float>> depths_;
  std::vector<raster::LightShadow> shadows_;
};

/// Columns and rows of a light's picture.
inline constexpr int kShadowSize = 2048;

}  // namespace rastrum
