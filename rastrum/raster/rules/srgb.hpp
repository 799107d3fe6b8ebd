// SPDX-License-Identifier: BSD-3-Clause
// The sRGB transfer function (IEC 61966-2-1) both ways, without std::pow per pixel.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/color.hpp>
#include <rastrum/config.hpp>
#include <rastrum/raster/rules/scalar_lane.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

/// Linear light at 4096 even steps of display values, and one more.
inline constexpr std::size_t kDisplaySteps = 4096;
[[nodiscard]] std::span<const double, kDisplaySteps + 2> display_curve();
/// Linear light of a float32 display value clamped to [0, 1]; NaN gives 0. Interpolates linearly
/// between steps of display_curve(), within 2e-8.
[[nodiscard]] RASTRUM_HD inline float linear_from_display(const double* curve, float display) {
  if (!(display > 0)) return 0;
  const double at = (display < 1 ? double{display} : 1.0) * kDisplaySteps;
  const auto i = static_cast<std::size_t>(at);
  return static_cast<float>(curve[i] + (curve[i + 1] - curve[i]) * (at - static_cast<double>(i)));
}
[[nodiscard]] inline float linear_from_display(float display) {
  return linear_from_display(display_curve().data(), display);
}
[[nodiscard]] RASTRUM_HD inline Vec4 linear_from_display(const double* curve, Vec4 c) {
  return {linear_from_display(curve, c.x), linear_from_display(curve, c.y),
          linear_from_display(curve, c.z), c.w};
}

/// From 8-bit codes to [0, 1]; `unorm` is code / 255.
struct DecodeTables {
  std::array<float, 256> srgb, unorm;
};
[[nodiscard]] const DecodeTables& decode_tables();

/// Codes by a float's exponent and first seven mantissa bits. Such a cell has at most one boundary
/// between codes.
class SrgbCodes {
 public:
  SrgbCodes();
  /// The exact nearest 8-bit sRGB code, branch-free. Outside [0, 1] the nearest end; NaN gives 0.
  [[nodiscard]] std::uint8_t operator()(float linear) const {
    const float x = std::min(1.0F, linear > kLeast ? linear : kLeast);
    const std::uint8_t code = code_[(std::bit_cast<std::uint32_t>(x) >> kShift) - kFirst];
    return static_cast<std::uint8_t>(code + (x >= between_[code] ? 1 : 0));
  }

 private:
  static constexpr int kShift = 16;
  static constexpr float kLeast = 0x1p-13F;  // it and all below have code 0
  static constexpr std::uint32_t kFirst = std::bit_cast<std::uint32_t>(kLeast) >> kShift;
  static constexpr std::size_t kCount = (std::bit_cast<std::uint32_t>(1.0F) >> kShift) + 1 - kFirst;

  std::uint8_t code_[kCount];  ///< at the cell's start
  float between_[256];         ///< [i]: half-way from code i to code i + 1
};
[[nodiscard]] const SrgbCodes& srgb_codes();

/// The curve of srgb_from_linear: x^(1/2.4) as a combination of x, x^(1/2), x^(1/4) and x^(1/8),
/// minimax over [knee, 1] to 3.2e-5. Square roots vectorize, and IEEE fixes their bits.
inline constexpr float kSrgbKnee = 0.0031308F, kSrgbSlope = 12.92F;
inline constexpr float kSrgbRoot2 = 0.65398306F, kSrgbRoot4 = 0.68871534F, kSrgbRoot8 = 0.31847525F,
                       kSrgbLinear = 0.020187189F, kSrgbConstant = 0.0040672144F;

namespace scalar_lane {
#define RASTRUM_LANES RASTRUM_HD inline
#include <rastrum/raster/rules/srgb_curve.inl>
#undef RASTRUM_LANES
}  // namespace scalar_lane
using scalar_lane::srgb_from_linear;

/// 1 stays 1, though the curve misses it by 3e-5, so that white changes no colour.
[[nodiscard]] RASTRUM_HD inline float display_value(float linear) {
  return linear >= 1 ? 1.0F : srgb_from_linear(linear);
}
[[nodiscard]] RASTRUM_HD inline Vec4 display_value(Vec4 c) {
  return {display_value(c.x), display_value(c.y), display_value(c.z), c.w};
}

[[nodiscard]] inline Vec4 converted(Vec4 c, ColorSpace from, ColorSpace to) {
  if (from == to) return c;
  return to == ColorSpace::linear ? linear_from_display(display_curve().data(), c)
                                  : display_value(c);
}

}  // namespace rastrum::raster
