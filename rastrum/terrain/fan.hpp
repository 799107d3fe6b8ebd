// SPDX-License-Identifier: BSD-3-Clause
// A bound for what neighbouring columns can see between two slices, on any device.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <rastrum/terrain/ceiling.hpp>
#include <rastrum/terrain/samples.hpp>

namespace rastrum::terrain {

/// The range of the directions of columns [first, first + n).
struct Fan {
  float ux0, ux1, uy0, uy1;

  RASTRUM_HD Fan(const SetupView& setup, std::size_t first, std::size_t n)
      : ux0(setup.ux[first]), ux1(ux0), uy0(setup.uy[first]), uy1(uy0) {
    for (std::size_t i = first + 1; i < first + n; ++i) {
      ux0 = lesser(ux0, setup.ux[i]);
      ux1 = greater(ux1, setup.ux[i]);
      uy0 = lesser(uy0, setup.uy[i]);
      uy1 = greater(uy1, setup.uy[i]);
    }
  }

  /// No sample on slices [first, last] lies above this row.
  [[nodiscard]] RASTRUM_HD float lowest_row(const MapSamples& samples, const CeilingView& ceiling,
                                            const Slice& first, const Slice& last) const {
    const SetupView& s = samples.setup;
    const float top = filtered_bound(ceiling.over(cells(ux0, ux1, first.z, last.z, s.fx, s.cell_x),
                                                  cells(uy0, uy1, first.z, last.z, s.fy, s.cell_y),
                                                  samples.map.tiling));
    return lesser(s.row(top, first), s.row(top, last));
  }

 private:
  RASTRUM_HD static float lesser(float a, float b) { return b < a ? b : a; }
  RASTRUM_HD static float greater(float a, float b) { return a < b ? b : a; }

  /// Cells along one axis that samples at distances [z0, z1] read.
  RASTRUM_HD static CellRange cells(float u0, float u1, float z0, float z1, float within,
                                    std::int32_t cell) {
    const float low = within + lesser(z0 * u0, z1 * u0);
    const float high = within + greater(z0 * u1, z1 * u1);
    // One more on each side, for a filter's neighbours.
    return {cell + static_cast<std::int64_t>(std::floor(low)) - 1,
            cell + static_cast<std::int64_t>(std::floor(high)) + 1};
  }
};

}  // namespace rastrum::terrain
