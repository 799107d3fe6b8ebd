// The sRGB transfer function (IEC 61966-2-1) both ways, without std::pow per pixel.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include <rastrum/core/config.hpp>

namespace rastrum::raster {

/// Display value to linear light, both in [0, 1].
[[nodiscard]] double linear_from_srgb(double display);

/// 8-bit code to [0, 1]: sRGB to linear light, and plain code / 255.
struct DecodeTables {
  std::array<float, 256> srgb, unorm;
};
[[nodiscard]] const DecodeTables& decode_tables();

/// The nearest 8-bit sRGB code of linear light, exactly; outside [0, 1] (and NaN) the nearest end.
[[nodiscard]] std::uint8_t srgb_code(float linear);

/// The curve of srgb_from_linear: x^(1/2.4) as a combination of x, x^(1/2), x^(1/4) and x^(1/8),
/// minimax over [knee, 1] to 3.2e-5 (square roots vectorize, and their bits are IEEE's).
inline constexpr float kSrgbKnee = 0.0031308F, kSrgbSlope = 12.92F;
inline constexpr float kSrgbRoot2 = 0.65398306F, kSrgbRoot4 = 0.68871534F, kSrgbRoot8 = 0.31847525F,
                       kSrgbLinear = 0.020187189F, kSrgbConstant = 0.0040672144F;

/// Linear light to display value, both in [0, 1]; what lies outside is clamped, NaN becomes 0.
RASTRUM_HD inline float srgb_from_linear(float linear) {
  const float x = linear > 0 ? (linear < 1 ? linear : 1.0F) : 0.0F;
  const float s2 = std::sqrt(x);
  const float s4 = std::sqrt(s2);
  const float s8 = std::sqrt(s4);
  const float curve =
      kSrgbRoot2 * s2 + kSrgbRoot4 * s4 - kSrgbRoot8 * s8 - (kSrgbLinear * x + kSrgbConstant);
  return x < kSrgbKnee ? x * kSrgbSlope : curve;
}

}  // namespace rastrum::raster
