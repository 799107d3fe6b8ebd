// SPDX-License-Identifier: BSD-3-Clause
// The slices of the original program, on any device.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <rastrum/terrain.hpp>
#include <rastrum/terrain/ceiling.hpp>

namespace rastrum::terrain {

/// Where a slice begins, and its step from column to column.
struct ClassicLine {
  double z, rows, x, y, dx, dy;
};

/// Near to far; distances accumulate as in the original. O(slices).
[[nodiscard]] std::vector<ClassicLine> classic_lines(const TerrainOptions& options,
                                                     const TerrainCamera& camera);

/// The cells along one axis that n columns reach on slices that begin between a and b.
[[nodiscard]] RASTRUM_HD inline CellRange classic_range(double a, double step_a, double b,
                                                        double step_b, std::size_t n) {
  const double c = a + step_a * static_cast<double>(n), d = b + step_b * static_cast<double>(n);
  const auto lesser = [](double p, double q) { return q < p ? q : p; };
  const auto greater = [](double p, double q) { return p < q ? q : p; };
  // One more on each side, for the rounding of accumulated positions.
  return {static_cast<std::int64_t>(std::floor(lesser(lesser(a, b), lesser(c, d)))) - 1,
          static_cast<std::int64_t>(std::floor(greater(greater(a, b), greater(c, d)))) + 1};
}

}  // namespace rastrum::terrain
