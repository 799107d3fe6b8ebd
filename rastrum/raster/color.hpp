// Colours of a block and their way to 8 bits.
#pragma once

#include <cmath>
#include <cstdint>

#include <rastrum/core/image.hpp>

namespace rastrum::raster {

/// Colours of a block, one plane a channel: element 8 · row + column. Premultiplied.
struct alignas(64) BlockColors {
  float r[64], g[64], b[64], a[64];

  /// Sets element i; returns whether `c` is opaque.
  bool set(int i, Vec4 c) {
    r[i] = c.x;
    g[i] = c.y;
    b[i] = c.z;
    a[i] = c.w;
    return c.w == 1;
  }
};

/// [0, 1] to 0 … 255, nearest, ties to even; NaN becomes 0.
inline std::uint8_t quantize(float c) {
  const float clamped = c > 0 ? (c < 1 ? c : 1.0F) : 0.0F;
  return static_cast<std::uint8_t>(std::nearbyint(clamped * 255.0F));
}

inline Rgba8 to_straight_rgba8(Vec4 premultiplied) {
  const float a = premultiplied.w;
  const float scale = a > 0 && a != 1 ? 1 / a : 1.0F;
  return {quantize(premultiplied.x * scale), quantize(premultiplied.y * scale),
          quantize(premultiplied.z * scale), quantize(a)};
}

}  // namespace rastrum::raster
