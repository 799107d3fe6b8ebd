// SPDX-License-Identifier: BSD-3-Clause
// Constants of the lit shaders.
#pragma once

#include <cstdint>

#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

inline constexpr Vec3 kDefaultBase{0.8F, 0.7F, 0.6F};
inline constexpr Vec3 kWireColor{0.1F, 0.1F, 0.12F};
inline constexpr float kAmbient = 0.1F, kDiffuse = 0.8F, kSpecular = 0.3F;
/// (0.4, 0.6, 1) / √1.52.
inline constexpr Vec3 kLight{0.32444284F, 0.48666426F, 0.81110710F};

/// A hash of the id (MurmurHash3's finalizer) as an 8-bit colour, never black.
RASTRUM_HD constexpr Vec3 id_color(std::uint64_t id) {
  auto h = static_cast<std::uint32_t>(id ^ (id >> 32));
  h ^= h >> 16;
  h *= 0x85ebca6bU;
  h ^= h >> 13;
  h *= 0xc2b2ae35U;
  h ^= h >> 16;
  const auto channel = [&](int shift) {
    return static_cast<float>((h >> shift & 255U) | 32U) * (1.0F / 255.0F);
  };
  return {channel(0), channel(8), channel(16)};
}

}  // namespace rastrum::raster
