// SPDX-License-Identifier: BSD-3-Clause
// The light of a terrain that is a function, on any device, from heights about a point and along
// the march to the sun. The host asks for many heights at once (light.cpp), a device for one at a
// time.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <rastrum/config.hpp>
#include <rastrum/image.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain/color_map.hpp>
#include <rastrum/terrain/function_values.hpp>
#include <rastrum/terrain_light.hpp>

namespace rastrum::terrain {

[[nodiscard]] RASTRUM_HD inline Rgba8 lit(Rgba8 color, float factor) {
  const auto channel = [&](std::uint8_t c) {
    const float v = static_cast<float>(c) * factor + 0.5F;
    return static_cast<std::uint8_t>(v > 0 ? (v < 255 ? v : 255.0F) : 0.0F);
  };
  return {channel(color.r), channel(color.g), channel(color.b), 255};
}

/// A sample of the march, relative to the point.
struct FunctionStep {
  double x, y, climb;
};

/// Slopes are differences over this many cells to each side.
inline constexpr double kSlopeStep = 1;

struct FunctionLight {
  double low = 0, scale = 0;  ///< a height's place in the colours is (height − low) · scale
  bool hill_shading = false;
  Shadows shadows = Shadows::none;
  float ambient = 0.45F;
  ToSun to_sun{};

  /// The share of light that a slope reflects, by the heights kSlopeStep to each side.
  [[nodiscard]] RASTRUM_HD float slope(float west, float east, float north, float south) const {
    if (!hill_shading) return 1;
    return to_sun.shade((east - west) / static_cast<float>(2 * kSlopeStep),
                        (south - north) / static_cast<float>(2 * kSlopeStep), ambient);
  }
  [[nodiscard]] RASTRUM_HD static bool hides(float height, float own, const FunctionStep& step) {
    return own + static_cast<float>(step.climb) < height;
  }
  /// The share that is left where `hidden` samples hide the sun.
  [[nodiscard]] RASTRUM_HD float shadowed(float factor, int hidden) const {
    if (shadows == Shadows::none) return factor;
    if (shadows == Shadows::accumulated)
      return factor * std::sqrt(1 / (1 + static_cast<float>(hidden)));
    const float least = ambient < factor ? ambient : factor;
    if (shadows == Shadows::sharp) return hidden != 0 ? least : factor;
    constexpr float kWholeShadow = 8;
    const float part = static_cast<float>(hidden) / kWholeShadow;
    return factor + (least - factor) * (part < 1 ? part : 1.0F);
  }
  [[nodiscard]] RASTRUM_HD Rgba8 color(float height, float factor) const {
    return lit(height_color((static_cast<double>(height) - low) * scale), factor);
  }
};

/// For kernels: `steps` must lie in the memory of the kernel's device.
struct FunctionView {
  NamedFunction function = NamedFunction::cosines;
  FunctionLight light;
  std::span<const FunctionStep> steps;

  [[nodiscard]] RASTRUM_HD float height(double x, double y) const {
    return height_of(function, x, y);
  }
  [[nodiscard]] RASTRUM_HD Rgba8 color(double x, double y) const {
    const float own = height(x, y);
    float factor = 1;
    if (light.hill_shading)
      factor = light.slope(height(x - kSlopeStep, y), height(x + kSlopeStep, y),
                           height(x, y - kSlopeStep), height(x, y + kSlopeStep));
    int hidden = 0;
    for (const FunctionStep& step : steps) {
      hidden += FunctionLight::hides(height(x + step.x, y + step.y), own, step) ? 1 : 0;
      if (hidden != 0 && light.shadows == Shadows::sharp) break;
    }
    return light.color(own, light.shadowed(factor, hidden));
  }
};

/// Its steps lie in the host's memory and live as long as the terrain. None for a map, or for a
/// caller's own function or surface.
[[nodiscard]] std::optional<FunctionView> function_view(const Terrain& terrain);

}  // namespace rastrum::terrain
