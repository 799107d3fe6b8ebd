// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <rastrum/config.hpp>
#include <rastrum/raster/rules/piece.hpp>

namespace rastrum::raster {

[[nodiscard]] RASTRUM_HD inline Rect intersection(Rect a, Rect b) {
  return {a.x0 > b.x0 ? a.x0 : b.x0, a.y0 > b.y0 ? a.y0 : b.y0, a.x1 < b.x1 ? a.x1 : b.x1,
          a.y1 < b.y1 ? a.y1 : b.y1};
}

/// Numbered row by row.
struct TileGrid {
  Rect view;
  int tile_px = kBlockSize;

  [[nodiscard]] RASTRUM_HD int columns() const {
    return (view.x1 - view.x0 + tile_px - 1) / tile_px;
  }
  [[nodiscard]] RASTRUM_HD int rows() const { return (view.y1 - view.y0 + tile_px - 1) / tile_px; }
  [[nodiscard]] RASTRUM_HD std::size_t count() const {
    return static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows());
  }
  [[nodiscard]] RASTRUM_HD Rect rect(std::size_t tile) const {
    const auto c = static_cast<std::size_t>(columns());
    const int x0 = view.x0 + static_cast<int>(tile % c) * tile_px;
    const int y0 = view.y0 + static_cast<int>(tile / c) * tile_px;
    return intersection(view, {x0, y0, x0 + tile_px, y0 + tile_px});
  }
};

}  // namespace rastrum::raster
