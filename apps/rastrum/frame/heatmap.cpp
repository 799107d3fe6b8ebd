// SPDX-License-Identifier: BSD-3-Clause
// The ramp has even lightness steps in Oklab (B. Ottosson, "A perceptual color space for image
// processing", 2020), so it also reads in grey.
#include "heatmap.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <rastrum/core/elementary.hpp>

namespace rastrum::cli {
namespace {

std::uint8_t srgb8(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  const double encoded = c <= 0.0031308 ? 12.92 * c : 1.055 * elementary::pow(c, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(encoded * 255));
}

Rgba8 from_oklab(double lightness, double a, double b) {
  const auto cube = [](double v) { return v * v * v; };
  const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
  return {srgb8(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          srgb8(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          srgb8(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s), 255};
}

}  // namespace

const std::array<Rgba8, kRampSize>& heat_ramp() {
  static const auto ramp = [] {
    std::array<Rgba8, kRampSize> colors;
    for (int i = 0; i < kRampSize; ++i) {
      const double t = static_cast<double>(i) / (kRampSize - 1);
      const double lightness = 0.32 + 0.64 * t;
      // From violet by red to yellow.
      const auto [sin, cos] = elementary::sin_cos((290 + 178 * t) / 180 * std::numbers::pi);
      const double chroma = 0.15;
      colors[static_cast<std::size_t>(i)] = from_oklab(lightness, chroma * cos, chroma * sin);
    }
    return colors;
  }();
  return ramp;
}

int ramp_index(std::uint32_t n, std::uint32_t max) {
  if (n <= 1) return 0;
  const double t =
      elementary::log(static_cast<double>(n)) / elementary::log(static_cast<double>(max));
  return static_cast<int>(std::lround(t * (kRampSize - 1)));
}

Heatmap make_heatmap(ImageView<const std::uint32_t> overdraw) {
  Heatmap heatmap{Image<Rgba8>(overdraw.width, overdraw.height)};
  for (int y = 0; y < overdraw.height; ++y)
    for (int x = 0; x < overdraw.width; ++x) {
      heatmap.max = std::max(heatmap.max, overdraw(x, y));
      heatmap.sum += overdraw(x, y);
    }
  for (int y = 0; y < overdraw.height; ++y)
    for (int x = 0; x < overdraw.width; ++x) {
      const std::uint32_t n = overdraw(x, y);
      heatmap.image(x, y) = n == 0
                                ? Rgba8{0, 0, 0, 255}
                                : heat_ramp()[static_cast<std::size_t>(ramp_index(n, heatmap.max))];
    }
  return heatmap;
}

ErrorPicture make_error_picture(ImageView<const Rgba8> color8,
                                ImageView<const std::uint8_t> errors) {
  ErrorPicture picture{Image<Rgba8>(color8.width, color8.height)};
  for (int y = 0; y < color8.height; ++y)
    for (int x = 0; x < color8.width; ++x) {
      const Rgba8 c = color8(x, y);
      // Rec. 709's weights; half of it, so that red stands out.
      const double luma = (0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b) * c.a / 255;
      const auto grey = static_cast<std::uint8_t>(std::lround(luma / 2));
      const bool wrong = errors(x, y) != 0;
      picture.wrong += wrong;
      picture.image(x, y) = wrong ? Rgba8{255, 0, 0, 255} : Rgba8{grey, grey, grey, 255};
    }
  return picture;
}

}  // namespace rastrum::cli
