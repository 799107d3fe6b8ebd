// A view in tiles.
#pragma once

#include <cstddef>

#include <rastrum/config.hpp>
#include <rastrum/raster/bin/order.hpp>
#include <rastrum/raster/rules/piece.hpp>

namespace rastrum::raster {

[[nodiscard]] RASTRUM_HD inline Rect intersection(Rect a, Rect b) {
  return {a.x0 > b.x0 ? a.x0 : b.x0, a.y0 > b.y0 ? a.y0 : b.y0, a.x1 < b.x1 ? a.x1 : b.x1,
          a.y1 < b.y1 ? a.y1 : b.y1};
}

/// Tiles of the screen: numbered row by row, walked in any order.
struct TileGrid {
  Rect view;
  int tile_px = kBlockSize;
  BlockOrder order = BlockOrder::row_major;

  [[nodiscard]] RASTRUM_HD int columns() const {
    return (view.x1 - view.x0 + tile_px - 1) / tile_px;
  }
  [[nodiscard]] RASTRUM_HD int rows() const { return (view.y1 - view.y0 + tile_px - 1) / tile_px; }
  [[nodiscard]] RASTRUM_HD std::size_t count() const {
    return static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows());
  }
  /// The tile that is walked as number `position`.
  [[nodiscard]] RASTRUM_HD std::size_t tile_at(std::size_t position) const {
    if (order == BlockOrder::row_major) return position;
    const Cell cell = cell_at(order, position, columns(), rows());
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(columns()) +
           static_cast<std::size_t>(cell.column);
  }
  [[nodiscard]] RASTRUM_HD Rect rect(std::size_t tile) const {
    const auto c = static_cast<std::size_t>(columns());
    const int x0 = view.x0 + static_cast<int>(tile % c) * tile_px;
    const int y0 = view.y0 + static_cast<int>(tile / c) * tile_px;
    return intersection(view, {x0, y0, x0 + tile_px, y0 + tile_px});
  }
};

}  // namespace rastrum::raster
