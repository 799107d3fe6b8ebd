// SPDX-License-Identifier: BSD-3-Clause
// Random numbers of procedural shapes. Own, because the standard library's distributions differ
// between implementations and a shape must be the same everywhere. Source: SplitMix64 (Steele, Lea,
// Flood, "Fast splittable pseudorandom number generators", 2014).
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include <rastrum/vec.hpp>

#include <rastrum/core/elementary.hpp>

namespace rastrum::shapes {

class Random {
 public:
  /// A `stream` per item (strand, triangle) makes items independent of each other.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0)
      : state_(mix(seed) + mix(stream ^ 0x6A09E667F3BCC909U)) {}

  std::uint64_t bits() { return mix(state_ += 0x9E3779B97F4A7C15U); }

  /// Uniform in [low, high), 53 random bits.
  double uniform(double low = 0, double high = 1) {
    return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
  }

  /// Uniform on the unit sphere (Archimedes: height and longitude are independent and uniform).
  Vec3d unit_vector() {
    const double z = uniform(-1, 1);
    const double phi = uniform(0, 2 * std::numbers::pi);
    const double r = std::sqrt(1 - z * z);
    const auto [sin, cos] = elementary::sin_cos(phi);
    return {r * cos, r * sin, z};
  }

 private:
  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

}  // namespace rastrum::shapes
