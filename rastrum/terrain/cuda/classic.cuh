// SPDX-License-Identifier: BSD-3-Clause
// The original program bit for bit (classic.cpp) on a device. One thread per slice first walks over
// all columns and stores where the teams of fast.cuh begin; a sample of a team adds the rest, fewer
// than kTeamColumns steps. Work O(columns · slices), span O(columns + that of fast.cuh). Takes 16
// bytes per team and slice.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include <rastrum/terrain/cell.hpp>
#include <rastrum/terrain/classic.hpp>
#include <rastrum/terrain/cuda/fast.cuh>
#include <rastrum/terrain/cuda/map.cuh>

namespace rastrum::terrain {

/// `lowest_row`: nothing from there on rises above it.
struct ClassicSlice {
  ClassicLine line;
  double lowest_row;
};

namespace cuda_detail {

struct FindTeamStarts {
  std::span<const ClassicSlice> slices;
  std::size_t columns;
  std::span<double> x, y;  ///< [team][slice]
  RASTRUM_HD void operator()(std::size_t k) const {
    const ClassicLine& line = slices[k].line;
    double at_x = line.x, at_y = line.y;
    for (std::size_t column = 0; column < columns; ++column) {
      if (column % kTeamColumns == 0) {
        x[column / kTeamColumns * slices.size() + k] = at_x;
        y[column / kTeamColumns * slices.size() + k] = at_y;
      }
      at_x += line.dx;
      at_y += line.dy;
    }
  }
};

}  // namespace cuda_detail

struct ClassicWalk {
  std::span<const ClassicSlice> lines;
  std::span<const double> x, y;  ///< [team][slice]
  MapLevels map;
  CeilingView ceiling;
  Tiling tiling;
  double altitude, horizon;
  std::size_t width;
  std::int32_t rows;
  Rgba8 background;

  [[nodiscard]] RASTRUM_HD std::size_t columns() const { return width; }
  [[nodiscard]] RASTRUM_HD std::size_t slices() const { return lines.size(); }
  [[nodiscard]] RASTRUM_HD std::int32_t height() const { return rows; }
  [[nodiscard]] RASTRUM_HD Rgba8 sky() const { return background; }
  [[nodiscard]] RASTRUM_HD std::int32_t first_row(std::size_t column, std::size_t k) const {
    const Position at = position(column, k);
    const ImageView<const float>& heights = map.heights[0];
    const float ground = heights(static_cast<int>(cell_at(at.x, map.width, tiling)),
                                 static_cast<int>(cell_at(at.y, map.height, tiling)));
    const double row = (altitude - static_cast<double>(ground)) * lines[k].line.rows + horizon;
    if (!(row < rows)) return kNoRow;  // also if NaN
    return row > 0 ? static_cast<std::int32_t>(row) : 0;
  }
  [[nodiscard]] RASTRUM_HD Rgba8 color(std::size_t column, std::size_t k) const {
    const Position at = position(column, k);
    const ImageView<const Rgba8>& colors = map.colors[0];
    return colors(texel_at(at.x, map.width, map.color_width, tiling),
                  texel_at(at.y, map.height, map.color_height, tiling));
  }
  [[nodiscard]] RASTRUM_HD float depth(std::size_t k) const {
    return static_cast<float>(lines[k].line.z);
  }
  [[nodiscard]] RASTRUM_HD bool ends(std::int32_t deepest, std::size_t k) const {
    return static_cast<double>(deepest) <= lines[k].lowest_row;
  }
  [[nodiscard]] RASTRUM_HD std::int32_t lowest_row(std::size_t first, std::size_t n,
                                                   std::size_t begin, std::size_t end) const {
    const std::size_t a = first / kTeamColumns * lines.size() + begin;
    const std::size_t b = first / kTeamColumns * lines.size() + end - 1;
    const ClassicLine &near = lines[begin].line, &far = lines[end - 1].line;
    const auto top =
        static_cast<double>(ceiling.over(classic_range(x[a], near.dx, x[b], far.dx, n),
                                         classic_range(y[a], near.dy, y[b], far.dy, n), tiling));
    const double row = (altitude - top) * near.rows, farther = (altitude - top) * far.rows;
    return bound_of_row((farther < row ? farther : row) + horizon, rows);
  }

 private:
  struct Position {
    double x, y;
  };
  [[nodiscard]] RASTRUM_HD Position position(std::size_t column, std::size_t k) const {
    const std::size_t start = column / kTeamColumns * lines.size() + k;
    const ClassicLine& line = lines[k].line;
    Position at{x[start], y[start]};
    for (std::size_t i = column % kTeamColumns; i > 0; --i) {
      at.x += line.dx;
      at.y += line.dy;
    }
    return at;
  }
};

/// `targets` lie on the device. The camera is lifted already. Waits.
[[nodiscard]] inline Counts draw_classic(parallel::Cuda& exec, const DeviceMap& map,
                                         const TerrainOptions& options, const TerrainCamera& camera,
                                         const TerrainTargets& targets) {
  const std::vector<ClassicLine> lines = classic_lines(options, camera);
  const auto highest = static_cast<double>(map.extent().highest);
  std::vector<ClassicSlice> slices(lines.size());
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t k = lines.size(); k-- > 0;) {
    const double row = (camera.altitude - highest) * lines[k].rows + camera.horizon_px;
    lowest = row < lowest ? row : lowest;
    slices[k] = {lines[k], lowest};
  }
  const auto on_device = parallel::upload(exec, slices);
  const std::span<const ClassicSlice> list(on_device.data(), on_device.size());
  const auto columns = static_cast<std::size_t>(options.width);
  const std::size_t teams = (columns + kTeamColumns - 1) / kTeamColumns;
  auto x = parallel::make_buffer<double>(exec, teams * slices.size());
  auto y = parallel::make_buffer<double>(exec, teams * slices.size());
  parallel::for_each_index(
      exec, slices.size(),
      cuda_detail::FindTeamStarts{list, columns, parallel::view_of(x), parallel::view_of(y)});
  return draw_by_teams(exec,
                       ClassicWalk{list,
                                   {x.data(), x.size()},
                                   {y.data(), y.size()},
                                   map.levels(),
                                   map.ceiling(),
                                   options.tiling,
                                   camera.altitude,
                                   camera.horizon_px,
                                   columns,
                                   options.height,
                                   options.sky},
                       targets);
}

}  // namespace rastrum::terrain
