// SPDX-License-Identifier: BSD-3-Clause
// Maps for the tests: random ones, rough or smooth, and real ones from beside the checkout.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <random>
#include <utility>

#include <rastrum/io.hpp>
#include <rastrum/terrain.hpp>

#include "tests/support/directories.hpp"

namespace rastrum::test {

/// Whole heights 0 to 255; `rough` 1 is noise, 0 is waves.
inline terrain::HeightMap random_map(int width, int height, std::mt19937& random,
                                     double rough = 0.2) {
  terrain::HeightMap map{Image<float>(width, height), Image<Rgba8>(width, height)};
  std::uniform_real_distribution<double> unit(0, 1);
  const double a = unit(random) * 6, b = unit(random) * 6, c = 1 + unit(random) * 5,
               d = 1 + unit(random) * 5;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double wave = 0.5 + 0.25 * std::sin(a + 6.283 * c * x / width) +
                          0.25 * std::sin(b + 6.283 * d * y / height);
      const double value = (1 - rough) * wave + rough * unit(random);
      map.heights(x, y) = static_cast<float>(std::clamp(std::floor(value * 256), 0.0, 255.0));
      const auto bits = static_cast<std::uint32_t>(random());
      map.colors(x, y) = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8),
                          static_cast<std::uint8_t>(bits >> 16), 255};
    }
  return map;
}

/// The real map with holes, heights in cells; empty if ../shared/data lacks it.
inline std::optional<Image<float>> saint_helens() {
  const auto file = shared_data("terrain/SainteHelens.dem");
  if (!std::filesystem::exists(file)) return {};
  io::HeightGrid grid = io::read_heights(file);
  for (float& h : grid.heights.pixels()) h /= static_cast<float>(grid.units_per_cell);
  return std::move(grid.heights);
}
inline constexpr const char* kNoRealMap = "terrain/SainteHelens.dem is not there";

}  // namespace rastrum::test
