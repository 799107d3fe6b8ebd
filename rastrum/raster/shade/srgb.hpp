// The sRGB transfer function (IEC 61966-2-1) both ways, without std::pow per pixel.
#pragma once

#include <array>
#include <cstdint>

#include <rastrum/config.hpp>
#include <rastrum/raster/kernels/scalar_lane.hpp>

namespace rastrum::raster {

/// Linear light of a float32 display value: of a table of 4096 steps, linearly between, within
/// 2e-8.
[[nodiscard]] float linear_from_display(float display);

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

namespace scalar_lane {
#define RASTRUM_LANES RASTRUM_HD inline
#include <rastrum/raster/shade/srgb_curve-inl.hpp>
#undef RASTRUM_LANES
}  // namespace scalar_lane
using scalar_lane::srgb_from_linear;

}  // namespace rastrum::raster
