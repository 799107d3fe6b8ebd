// SPDX-License-Identifier: BSD-3-Clause
// How far beyond a map what its tiling repeats there can cast shadows on it. Not as far as the
// longest ray: what is far away is high enough only where nothing nearer is. Ranges of heights in
// square tiles tell, without a look at single cells.
#pragma once

#include <cstddef>
#include <vector>

#include <rastrum/terrain/shadow_ray.hpp>

namespace rastrum::terrain {

/// Least and greatest heights of a map in squares of kEdge × kEdge cells.
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

/// Where the lines y = c + s·X of a sweep (shadow_sweep.hpp) run, on the map as it is turned.
struct SweepLines {
  bool along_x = true, flipped = false;
  int columns = 0, rows = 0;
  double s = 0;    ///< rows a column
  double tau = 0;  ///< height a column
  int first_band = 0, bands = 0;
};

/// Bands that are asked about together.
inline constexpr int kReachBands = 32;

/// For each kReachBands bands, how many of `blocks` blocks of `block` columns their rays need: all
/// that the map has, and of those beyond all but those at the end that hide the sun only from cells
/// from which nearer ones hide it. Work O(bands · blocks beyond).
[[nodiscard]] std::vector<int> reach_of(const ShadowCaster& map, const HeightTiles& tiles,
                                        const SweepLines& lines, int block, int blocks);

}  // namespace rastrum::terrain
