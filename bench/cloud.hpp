// SPDX-License-Identifier: BSD-3-Clause
// Random places in front of a camera, the same in every run, for benches of many small things.
#pragma once

#include <cmath>
#include <cstdint>

#include <rastrum/camera.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::bench {

/// Numbers in [0, 1) from a counter (SplitMix64).
class Noise {
 public:
  double next() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15U;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  float between(double a, double b) { return static_cast<float>(a + (b - a) * next()); }

 private:
  std::uint64_t state_ = 1;
};

/// Looks along −z. At distance 1 a unit is half the picture's height.
[[nodiscard]] inline Camera camera_at_origin() {
  Camera camera;
  camera.eye = {0, 0, 0};
  camera.target = {0, 0, -1};
  camera.fov_rad = 2 * std::atan(1.0F);
  camera.near_plane = 0.1F;
  return camera;
}

/// A visible place between the distances 2 and 4.
[[nodiscard]] inline Vec3 place(Noise& noise, double aspect) {
  const double z = 2 + 2 * noise.next();
  return {noise.between(-aspect * z, aspect * z), noise.between(-z, z), static_cast<float>(-z)};
}

}  // namespace rastrum::bench
