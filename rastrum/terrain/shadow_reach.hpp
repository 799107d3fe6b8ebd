// SPDX-License-Identifier: BSD-3-Clause
// How far beyond a map its tiled copies can cast shadows on it: less far than the longest ray,
// because what is far away is high enough only where nothing nearer is. Ranges of heights in square
// tiles decide it.
#pragma once

#include <cstddef>
#include <vector>

#include <rastrum/terrain/shadow_ray.hpp>

namespace rastrum::terrain {

struct HeightTiles {
  static constexpr int kEdge = 16;
  int across = 0, down = 0;
  std::vector<float> lowest, highest;

  void resize(int width, int height) {
    across = (width + kEdge - 1) / kEdge;
    down = (height + kEdge - 1) / kEdge;
    lowest.resize(static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
    highest.resize(lowest.size());
  }
  [[nodiscard]] std::size_t at(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(across) +
           static_cast<std::size_t>(column);
  }
};

/// The lines y = c + s·X of a sweep (shadow_sweep.hpp) on the turned map.
struct SweepLines {
  bool along_x = true, flipped = false;
  int columns = 0, rows = 0;
  double s = 0;    ///< rows per column
  double tau = 0;  ///< height per column
  int first_band = 0, bands = 0;
};

/// Bands that share one reach.
inline constexpr int kReachBands = 32;

/// How many of `blocks` blocks of `block` columns the rays of each kReachBands bands need: all of
/// the map's, then those beyond it except the last ones that shade only cells that nearer blocks
/// already shade. Work O(bands · blocks beyond).
[[nodiscard]] std::vector<int> reach_of(const ShadowCaster& map, const HeightTiles& tiles,
                                        const SweepLines& lines, int block, int blocks);

}  // namespace rastrum::terrain
