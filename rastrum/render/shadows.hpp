// Shadows of a frame's lights: what each light sees of the scene, drawn by a renderer of its own.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <rastrum/fit.hpp>
#include <rastrum/image.hpp>
#include <rastrum/raster/shade/light_set.hpp>
#include <rastrum/render.hpp>

namespace rastrum {

/// Who has parts of one scene, and what each has drawn of what a light sees.
class ShadowRanks : public FitRanks {
 public:
  /// `depth` becomes the greatest of all ranks at each pixel: what the light sees of all parts.
  /// All ranks call it, outside of own().
  virtual void meet(ImageView<float> depth) = 0;
};

/// Whether it is drawn by draw(): of directional lights and spots that are not too wide.
[[nodiscard]] bool has_shadow(const Light& light);

class Shadows {
 public:
  /// One a light of `frame`; empty where none has any. `options`: of the renderer that draws the
  /// frame. The result lives until the next call. O(vertices + triangles + kShadowSize²) a light.
  /// `ranks`: who has the rest of the scene; all call it with the same frame and camera, and have
  /// the same result.
  std::span<const raster::LightShadow> draw(const SceneView& scene, const Camera& camera,
                                            const FrameOptions& frame,
                                            const RendererOptions& options,
                                            ShadowRanks* ranks = nullptr);

 private:
  std::unique_ptr<Renderer> renderer_;
  std::vector<Image<float>> depths_;
  std::vector<raster::LightShadow> shadows_;
};

/// Columns and rows of a light's picture.
inline constexpr int kShadowSize = 2048;

}  // namespace rastrum
