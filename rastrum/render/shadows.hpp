// SPDX-License-Identifier: BSD-3-Clause
// Shadow maps of a frame's lights: the depths that each light sees of the part of the scene in the
// picture, drawn by the frame's own renderer.
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
  /// Makes each pixel of `depth` the greatest of all ranks, which is the map of all parts. All
  /// ranks call it, outside of own().
  virtual void meet(ImageView<float> depth) = 0;
};

/// Whether the light can have shadows: directional lights, and spots that are not too wide.
[[nodiscard]] bool has_shadow(const Light& light);

class Shadows {
 public:
  /// Draws the nearest depths that `camera` sees of the scene, as `look` says.
  using DrawDepth =
      std::function<void(const Camera& camera, const FrameOptions& look, ImageView<float> depth)>;

  /// `account`: counts the maps' memory. It must outlive this.
  explicit Shadows(MemoryAccount& account) : account_(account) {}

  /// One a light of `frame`; empty if no light has shadows. Valid until the next call. Cost:
  /// O(vertices), and drawing each map, at most four a light. `ranks`: those with the rest of the
  /// scene. All ranks call it with the same frame and camera, and get the same result.
  std::span<const raster::LightShadow> draw(const SceneView& scene, const Camera& camera,
                                            const FrameOptions& frame, const DrawDepth& draw_depth,
                                            ShadowRanks* ranks = nullptr);
  /// The bytes that the maps take now.
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  MemoryAccount& account_;
  std::vector<ScratchBuffer<float>> depths_;
  std::vector<raster::LightPicture> pictures_;
  std::vector<raster::LightShadow> shadows_;
};

}  // namespace rastrum
