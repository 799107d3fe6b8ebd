// SPDX-License-Identifier: BSD-3-Clause
// Shadow maps of a frame's lights: the depths that each light sees of the scene's visible part. The
// frame's renderer draws them.
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

/// Ranks with parts of one scene, which merge their shadow maps.
class ShadowRanks : public FitRanks {
 public:
  /// Makes each pixel of `depth` the greatest of all ranks, the map of all parts. All ranks call
  /// it, outside of own().
  virtual void meet(ImageView<float> depth) = 0;
};

/// Whether the light can have shadows: directional ones, and spots that are not too wide.
[[nodiscard]] bool has_shadow(const Light& light);

class Shadows {
 public:
  /// Draws the nearest depths of the scene that `camera` sees, as `look` says.
  using DrawDepth =
      std::function<void(const Camera& camera, const FrameOptions& look, ImageView<float> depth)>;

  /// `account` counts the maps' memory and must outlive this.
  explicit Shadows(MemoryAccount& account) : account_(account) {}

  /// One shadow per light of `frame`; empty if none has shadows. Valid until the next call. Cost:
  /// O(vertices), and at most four maps per light. `ranks` have the rest of the scene: all call
  /// this with the same frame and camera, and get the same result.
  std::span<const raster::LightShadow> draw(const SceneView& scene, const Camera& camera,
                                            const FrameOptions& frame, const DrawDepth& draw_depth,
                                            ShadowRanks* ranks = nullptr);
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  MemoryAccount& account_;
  std::vector<ScratchBuffer<float>> depths_;
  std::vector<raster::LightPicture> pictures_;
  std::vector<raster::LightShadow> shadows_;
};

}  // namespace rastrum
