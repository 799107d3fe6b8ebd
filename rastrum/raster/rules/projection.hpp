// SPDX-License-Identifier: BSD-3-Clause
// Clip space to snapped pixels. The float32 operations and their order are picture rules
// (docs/conventions.md); SIMD files repeat them in lanes.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include <rastrum/config.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

inline constexpr int kSubpixelBits = 8;
inline constexpr int kSubpixels = 1 << kSubpixelBits;
inline constexpr int kHalfPixel = kSubpixels / 2;

/// The guard band in px. Inside, n.8 coordinates need 24 bits and a sign, so float32 has them
/// exactly, and edge values (a product of two differences below 2^25, doubled) stay below 2^51.
inline constexpr float kGuardMinPx = -32768.0F;
inline constexpr float kGuardMaxPx = 65536.0F;

/// NDC [−1, 1]² to pixels [0, W] × [0, H], row 0 at the top.
struct Viewport {
  float half_width = 0, half_height = 0;

  RASTRUM_HD static Viewport of(int width, int height) {
    return {static_cast<float>(width) * 0.5F, static_cast<float>(height) * 0.5F};
  }
};

/// 16 bytes, so that a triangle's corner is one aligned load.
struct alignas(16) ProjectedVertex {
  std::int32_t x_fx8 = 0,
               y_fx8 = 0;  ///< n.8; x = kNeedsClip: no position, y = known outside planes
  float depth = 0;         ///< reversed, z / w
  float inv_w = 0;         ///< 1 / w_clip
};
static_assert(sizeof(ProjectedVertex) == 16);

/// The vertex is behind the near plane, outside the guard band or not finite. Its triangles are
/// clipped.
inline constexpr std::int32_t kNeedsClip = std::numeric_limits<std::int32_t>::min();

/// Ties to even. Exact for |px| ≤ 2^16: px · 256 has at most 24 bits before the point.
RASTRUM_HD inline std::int32_t snap(float px) {
  return static_cast<std::int32_t>(std::nearbyint(px * static_cast<float>(kSubpixels)));
}

RASTRUM_HD inline ProjectedVertex project(Vec4 clip, Viewport viewport) {
  const float inv_w = 1.0F / clip.w;
  const float x = clip.x * inv_w * viewport.half_width + viewport.half_width;
  const float y = viewport.half_height - clip.y * inv_w * viewport.half_height;
  // A NaN anywhere makes it false.
  const bool visible = clip.w > 0 && clip.z <= clip.w && x >= kGuardMinPx && x <= kGuardMaxPx &&
                       y >= kGuardMinPx && y <= kGuardMaxPx;
  // The clipper decides in float64 on depths of −∞ or NaN (a far plane overflowed).
  const float depth = clip.z * inv_w;
  if (!visible || !(depth >= std::numeric_limits<float>::lowest()))
    return {kNeedsClip, 0, 0.0F, 0.0F};
  return {snap(x), snap(y), depth, inv_w};
}

}  // namespace rastrum::raster
