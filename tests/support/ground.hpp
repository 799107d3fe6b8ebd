// SPDX-License-Identifier: BSD-3-Clause
// Terrain and environments for the tests of its light.
#pragma once

#include <cstdint>
#include <limits>
#include <numbers>

#include <rastrum/core/elementary.hpp>
#include <rastrum/environment.hpp>
#include <rastrum/terrain.hpp>

#include "tests/support/pixels.hpp"

namespace rastrum::test::ground {

inline constexpr int kMap = 48;

[[nodiscard]] inline double wave(double x, double y) {
  return 6 + 5 * elementary::sin(x * 0.31) * elementary::cos(y * 0.23) + 0.04 * x;
}

/// Round hills with one hole; each cell has its own colour.
[[nodiscard]] inline terrain::HeightMap hills() {
  terrain::HeightMap map{Image<float>(kMap, kMap), Image<Rgba8>(kMap, kMap)};
  for (const auto& [x, y] : pixels(kMap, kMap)) {
    map.heights(x, y) = static_cast<float>(wave(x, y));
    map.colors(x, y) = {static_cast<std::uint8_t>(90 + 3 * x),
                        static_cast<std::uint8_t>(60 + 2 * y), 120, 255};
  }
  map.heights(20, 30) = std::numeric_limits<float>::quiet_NaN();
  return map;
}

/// Red grows to the east, green upwards, blue to the south. Made once because it is slow; with 128
/// rows it takes sixteen times as long.
template <int kRows = 32>
[[nodiscard]] inline const Environment& directions() {
  static const Environment environment([] {
    Image<Vec3> picture(2 * kRows, kRows);
    for (const auto& [x, y] : pixels(2 * kRows, kRows)) {
      const auto [flat, up] = elementary::sin_cos((y + 0.5) / kRows * std::numbers::pi);
      // 0: −z, π/2: +x
      const auto [east, north] =
          elementary::sin_cos(((x + 0.5) / (2 * kRows) - 0.5) * 2 * std::numbers::pi);
      picture(x, y) =
          Vec3(Vec3d{0.5 + 0.5 * flat * east, 0.5 + 0.5 * up, 0.5 - 0.5 * flat * north});
    }
    return picture;
  }()
                                           .view());
  return environment;
}

[[nodiscard]] inline const Environment& blue_sky() {
  static const Environment environment(builtin_environment(BuiltinEnvironment::sky).view());
  return environment;
}

}  // namespace rastrum::test::ground
