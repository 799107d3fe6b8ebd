// SPDX-License-Identifier: BSD-3-Clause
// The cell of a map, and the texel of its colours, at a point: float64, unfiltered, on any device.
#pragma once

#include <cmath>
#include <cstdint>

#include <rastrum/terrain.hpp>

namespace rastrum::terrain {

[[nodiscard]] RASTRUM_HD inline std::int64_t cell_at(double at, int size, Tiling tiling) {
  // int64 cannot hold all floors. Beyond 2⁵² float64 has no fractions anyway.
  const double floor = std::floor(at);
  const double held = floor < -0x1p52 ? -0x1p52 : floor > 0x1p52 ? 0x1p52 : floor;
  return tiled(static_cast<std::int64_t>(held), size, tiling);
}

/// The texel under a point along one axis. A cell has several, or a part of one.
[[nodiscard]] RASTRUM_HD inline int texel_at(double at, int cells, int texels, Tiling tiling) {
  const std::int64_t cell = cell_at(at, cells, tiling);
  if (texels == cells) return static_cast<int>(cell);
  double within = at - std::floor(at);
  if (tiling == Tiling::mirror && cell != cell_at(at, 2 * cells, Tiling::repeat))
    within = 1 - within;
  if ((tiling == Tiling::clamp || tiling == Tiling::none) && (at < 0 || at >= cells))
    within = at < 0 ? 0 : 1;
  const int texel = static_cast<int>((static_cast<double>(cell) + within) * texels / cells);
  return texel < texels ? texel : texels - 1;
}

}  // namespace rastrum::terrain
