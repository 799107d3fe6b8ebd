// SPDX-License-Identifier: BSD-3-Clause
// The order in which the cells of a grid are walked: tiles of a frame, bins of a box, tiles of a
// bin. It changes which memory is near in time, but no pixel.
#pragma once

#include <bit>
#include <cstddef>

#include <papers/axes/names.hpp>
#include <rastrum/config.hpp>
#include <rastrum/raster/bin/tile_grid.hpp>
#include <rastrum/tuning.hpp>

namespace rastrum::family {

struct Cell {
  int column, row;
};

/// The cell at `position` of the walk; requires position < columns · rows. Morton order is that of
/// the enclosing power-of-two square without the cells outside of the grid. Each quadrant's share
/// of the grid is a rectangle, so its cells are counted without walking them. O(1) in rows, O(log
/// cells) in Morton order.
[[nodiscard]] RASTRUM_HD constexpr Cell cell_at(BlockOrder order, std::size_t position, int columns,
                                                int rows) {
  if (order == BlockOrder::row_major) {
    const auto c = static_cast<std::size_t>(columns);
    return {static_cast<int>(position % c), static_cast<int>(position / c)};
  }
  const auto inside = [](int cells, int first, int size) {
    const int n = cells - first;
    return static_cast<std::size_t>(n < 0 ? 0 : (n < size ? n : size));
  };
  Cell cell{0, 0};
  const auto longer = static_cast<unsigned>(columns > rows ? columns : rows);
  for (int size = static_cast<int>(std::bit_ceil(longer) / 2); size > 0; size /= 2)
    for (int quadrant = 0; quadrant < 4; ++quadrant) {
      const Cell first{cell.column + quadrant % 2 * size, cell.row + quadrant / 2 * size};
      const std::size_t cells = inside(columns, first.column, size) * inside(rows, first.row, size);
      if (position < cells) {
        cell = first;
        break;
      }
      position -= cells;
    }
  return cell;
}

/// The number of the tile at `position` of the walk.
[[nodiscard]] RASTRUM_HD inline std::size_t tile_at(BlockOrder order, std::size_t position,
                                                    const TileGrid& grid) {
  if (order == BlockOrder::row_major) return position;
  const Cell cell = cell_at(order, position, grid.columns(), grid.rows());
  return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(grid.columns()) +
         static_cast<std::size_t>(cell.column);
}

}  // namespace rastrum::family
