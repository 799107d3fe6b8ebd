// Shadows of a frame's lights: what each light sees of the scene where the frame looks, drawn by
// the renderer that draws the frame.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <rastrum/core/memory.hpp>
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
  /// Draws the nearest depths that `camera` sees of the scene, as `look` says.
  using DrawDepth =
      std::function<void(const Camera& camera, const FrameOptions& look, ImageView<float> depth)>;

  /// `account`: of what the pictures take. It must outlive this.
  explicit Shadows(MemoryAccount& account) : account_(account) {}

  /// One a light of `frame`; empty where none has any. The result lives until the next call.
  /// O(vertices), and for each picture, at most four a light, what it costs to draw it. `ranks`:
  /// who has the rest of the scene; all call it with the same frame and camera, and have the same
  /// result.
  std::span<const raster::LightShadow> draw(const SceneView& scene, const Camera& camera,
                                            const FrameOptions& frame, const DrawDepth& draw_depth,
                                            ShadowRanks* ranks = nullptr);
  /// That the pictures take now.
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  MemoryAccount& account_;
  std::vector<ScratchBuffer<float>> depths_;
  std::vector<raster::LightPicture> pictures_;
  std::vector<raster::LightShadow> shadows_;
};

}  // namespace rastrum
