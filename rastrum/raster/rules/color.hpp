// SPDX-License-Identifier: BSD-3-Clause
// Colours of a block and their conversion to 8 bits.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <rastrum/config.hpp>
#include <rastrum/image.hpp>
#include <rastrum/raster/rules/srgb.hpp>

namespace rastrum::raster {

/// Premultiplied colours of a block, one plane a channel: element 8 · row + column.
struct alignas(64) BlockColors {
  float r[64], g[64], b[64], a[64];

  [[nodiscard]] Vec4 at(int i) const { return {r[i], g[i], b[i], a[i]}; }
  /// Returns whether `c` is opaque.
  bool set(int i, Vec4 c) {
    r[i] = c.x;
    g[i] = c.y;
    b[i] = c.z;
    a[i] = c.w;
    return c.w == 1;
  }
};

struct BlockPixels {
  Rgba8* data = nullptr;
  std::ptrdiff_t stride = 0;
};

/// Ties to even; NaN becomes 0.
RASTRUM_HD inline std::uint8_t quantize(float c) {
  const float clamped = c > 0 ? (c < 1 ? c : 1.0F) : 0.0F;
  return static_cast<std::uint8_t>(std::nearbyint(clamped * 255.0F));
}

RASTRUM_HD inline Vec4 straight_from_premultiplied(Vec4 c) {
  const float scale = c.w > 0 && c.w != 1 ? 1 / c.w : 1.0F;
  return {c.x * scale, c.y * scale, c.z * scale, c.w};
}

RASTRUM_HD inline Rgba8 to_straight_rgba8(Vec4 premultiplied) {
  const Vec4 c = straight_from_premultiplied(premultiplied);
  return {quantize(c.x), quantize(c.y), quantize(c.z), quantize(c.w)};
}

RASTRUM_HD inline Vec4 premultiplied_from_straight(Vec4 c) {
  return {c.x * c.w, c.y * c.w, c.z * c.w, c.w};
}
RASTRUM_HD inline Vec4 straight_from_rgba8(Rgba8 c) {
  return {static_cast<float>(c.r) / 255.0F, static_cast<float>(c.g) / 255.0F,
          static_cast<float>(c.b) / 255.0F, static_cast<float>(c.a) / 255.0F};
}

RASTRUM_HD inline Vec4 display_from_linear(Vec4 premultiplied) {
  const Vec4 c = straight_from_premultiplied(premultiplied);
  return {srgb_from_linear(c.x) * c.w, srgb_from_linear(c.y) * c.w, srgb_from_linear(c.z) * c.w,
          c.w};
}

RASTRUM_HD inline Rgba8 linear_to_straight_rgba8(Vec4 premultiplied) {
  const Vec4 c = straight_from_premultiplied(premultiplied);
  return {quantize(srgb_from_linear(c.x)), quantize(srgb_from_linear(c.y)),
          quantize(srgb_from_linear(c.z)), quantize(c.w)};
}

/// The background of a block's colours.
struct Backdrop {
  Vec4 color{};         ///< premultiplied; in linear light if `linear`
  bool linear = false;  ///< the block's colours are in linear light
  Rgba8 empty{};        ///< where nothing covers the pixel

  /// `straight`: a display value with straight alpha. For colours that are not linear light.
  [[nodiscard]] RASTRUM_HD static Backdrop of(Vec4 straight) {
    const Vec4 color = premultiplied_from_straight(straight);
    return {color, false, to_straight_rgba8(color)};
  }
  /// Premultiplied display value of a covered pixel.
  [[nodiscard]] RASTRUM_HD Vec4 color_over(Vec4 front) const {
    const Vec4 c = over(front);
    return linear ? display_from_linear(c) : c;
  }
  [[nodiscard]] RASTRUM_HD Rgba8 color8_over(Vec4 front) const {
    const Vec4 c = over(front);
    return linear ? linear_to_straight_rgba8(c) : to_straight_rgba8(c);
  }
  /// Premultiplied, in the light of the block's colours.
  [[nodiscard]] RASTRUM_HD Vec4 over(Vec4 front) const { return front + color * (1 - front.w); }
};

}  // namespace rastrum::raster
