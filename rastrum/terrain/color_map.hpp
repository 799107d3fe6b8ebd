// SPDX-License-Identifier: BSD-3-Clause
// Colours for heights that have none, and hill shading.
#pragma once

#include <cmath>
#include <cstddef>

#include <rastrum/config.hpp>
#include <rastrum/image.hpp>
#include <rastrum/terrain_light.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::terrain {

/// From lowland (t = 0) to snow (t = 1), clamped; NaN is 0. The lightness of the hypsometric hues
/// rises evenly (CIE L* from 30 to 97): equal steps of height look equal, also printed in grey.
[[nodiscard]] RASTRUM_HD inline Rgba8 height_color(double t) {
  // Display values at equal steps of t, found by walking L* = 30 + 67 t in CIE Lab.
  constexpr std::size_t kHues = 8;
  constexpr double kHypsometric[kHues][3] = {{36, 79, 56},    {61, 100, 60},   {94, 121, 68},
                                             {139, 138, 82},  {181, 157, 105}, {208, 181, 143},
                                             {224, 210, 191}, {247, 247, 246}};
  const double at = (t > 0 ? (t < 1 ? t : 1.0) : 0.0) * (kHues - 1);
  const auto whole = static_cast<std::size_t>(at);
  const std::size_t i = whole < kHues - 2 ? whole : kHues - 2;
  const double f = at - static_cast<double>(i);
  const auto channel = [&](std::size_t c) {
    return static_cast<std::uint8_t>(
        std::lround(kHypsometric[i][c] + f * (kHypsometric[i + 1][c] - kHypsometric[i][c])));
  };
  return {channel(0), channel(1), channel(2), 255};
}

/// Colours between the lowest and the highest height; holes are black.
[[nodiscard]] Image<Rgba8> colors_by_height(ImageView<const float> heights);

/// The unit vector to the sun: east, south, up.
struct ToSun {
  float x = 0, y = 0, z = 1;
  static ToSun of(const Sun& sun);
  /// The share of the sun's light that a slope reflects: ambient + (1 − ambient) · max(0, cosine
  /// between the normal and the sun). `dx`, `dy`: slope to the east and to the south.
  [[nodiscard]] RASTRUM_HD float shade(float dx, float dy, float ambient) const {
    const float cosine = (z - dx * x - dy * y) / std::sqrt(1 + dx * dx + dy * dy);
    return ambient + (1 - ambient) * (cosine > 0 ? cosine : 0);
  }
};

/// Central differences within the tiled map. A hole beside a cell counts as the cell's own height.
struct Slopes {
  ImageView<const float> heights;
  Tiling tiling = Tiling::repeat;

  /// Slope to the east and to the south, at a cell that is no hole.
  [[nodiscard]] Vec2 at(int x, int y) const;
};

/// ToSun::shade of each cell; 0 in holes.
[[nodiscard]] Image<float> hill_shading(ImageView<const float> heights, const Sun& sun,
                                        float ambient, Tiling tiling);

[[nodiscard]] Rgba8 shown(Vec4 display);

}  // namespace rastrum::terrain
