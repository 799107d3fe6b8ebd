// SPDX-License-Identifier: BSD-3-Clause
// The environments of a frame, as seen behind meshes and ground.
#pragma once

#include <algorithm>
#include <span>
#include <variant>

#include <rastrum/camera.hpp>
#include <rastrum/light.hpp>
#include <rastrum/raster/shade/light_set.hpp>
#include <rastrum/render/tone_pass.hpp>
#include <rastrum/tone.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {

[[nodiscard]] inline bool has_environment(std::span<const Light> lights) {
  return std::ranges::any_of(lights, [](const Light& light) {
    return std::holds_alternative<EnvironmentLight>(light.kind);
  });
}

/// `lights` are checked, must outlive this, and light a scene seen through `camera`.
class Around {
 public:
  Around(std::span<const Light> lights, const ToneMapping& tone, const Camera& camera, int width,
         int height)
      : lights_(lights, {}, camera, width, height), curve_(tone) {}

  /// Linear light from direction `d` of the world, of any length.
  [[nodiscard]] Vec3 light(Vec3 d) const {
    Vec3 sum;
    for (const raster::Surrounding& s : lights_.set().surroundings) sum = sum + s.at(d, 0);
    return sum;
  }
  [[nodiscard]] Vec3 shown(Vec3 light) const { return curve_(light); }

 private:
  raster::FrameLights lights_;
  ToneCurve curve_;
};

}  // namespace rastrum
