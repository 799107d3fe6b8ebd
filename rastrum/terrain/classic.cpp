// SPDX-License-Identifier: BSD-3-Clause
// The original program (Macke's, paper 3, section 2.3), bit for bit: float64 throughout, positions
// accumulated along a slice, 240 rows at every resolution, heights truncated toward zero. Holes
// draw nothing.
//
// On threads, each slice's position at the first column of each block is accumulated first. A block
// accumulates on from there, eight slices side by side.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <rastrum/core/elementary.hpp>
#include <rastrum/parallel/for_each.hpp>
#include <rastrum/stop.hpp>
#include <rastrum/terrain/blocks.hpp>
#include <rastrum/terrain/classic.hpp>
#include <rastrum/terrain/methods.hpp>

namespace rastrum::terrain {

std::vector<ClassicLine> classic_lines(const TerrainOptions& options, const TerrainCamera& camera) {
  std::vector<ClassicLine> lines;
  const auto [sin, cos] = elementary::sin_cos(camera.angle_rad);
  double dz = 1;
  for (double z = 1; z < options.distance; dz += 0.005, z += dz) {
    const double x = -cos * z - sin * z, y = sin * z - cos * z;
    lines.push_back({z, 1 / z * 240, x + camera.x, y + camera.y,
                     (cos * z - sin * z - x) / options.width,
                     (-sin * z - cos * z - y) / options.width});
  }
  return lines;
}

namespace {

/// The lines as arrays, padded to whole groups with lines that go nowhere.
struct Table {
  std::vector<double> dx, dy, x, y;
  std::vector<double> lowest_row;
  std::size_t slices = 0;  ///< of a block, in x and y

  Table(parallel::Threads& exec, const Kernels& kernels, const std::vector<ClassicLine>& lines,
        const Blocks& blocks, double altitude, double horizon, double highest)
      : slices((lines.size() + kClassicSlices - 1) / kClassicSlices * kClassicSlices) {
    dx.resize(slices);
    dy.resize(slices);
    x.resize(slices * blocks.count);
    y.resize(slices * blocks.count);
    lowest_row.resize(lines.size());
    double lowest = std::numeric_limits<double>::infinity();
    for (std::size_t k = lines.size(); k-- > 0;) {
      const ClassicLine& line = lines[k];
      dx[k] = line.dx;
      dy[k] = line.dy;
      x[k] = line.x;
      y[k] = line.y;
      lowest = std::min(lowest, (altitude - highest) * line.rows + horizon);
      lowest_row[k] = lowest;
    }
    parallel::for_each_index(exec, slices / kClassicSlices, [&](std::size_t group) {
      const std::size_t k = group * kClassicSlices;
      for (std::size_t b = 1; b < blocks.count; ++b) {
        double* to_x = x.data() + b * slices + k;
        double* to_y = y.data() + b * slices + k;
        std::copy_n(to_x - slices, kClassicSlices, to_x);
        std::copy_n(to_y - slices, kClassicSlices, to_y);
        kernels.advance(blocks.size(b - 1), dx.data() + k, dy.data() + k, to_x, to_y);
      }
    });
  }

  /// No height on slices [first, last] of a block of n columns exceeds it.
  [[nodiscard]] double highest(const Ceiling& ceiling, Tiling tiling, const double* block_x,
                               const double* block_y, std::size_t first, std::size_t last,
                               std::size_t n) const {
    const auto cells = [&](const double* at, const std::vector<double>& step) {
      return classic_range(at[first], step[first], at[last], step[last], n);
    };
    return static_cast<double>(ceiling.over(cells(block_x, dx), cells(block_y, dy), tiling));
  }
};

}  // namespace

Counts draw_classic(parallel::Threads& exec, Isa isa, BlockPool& pool, const Terrain& terrain,
                    const Ceiling& ceiling, const TerrainOptions& options,
                    const TerrainCamera& camera, const TerrainTargets& targets) {
  const std::vector<ClassicLine> lines = classic_lines(options, camera);
  const Blocks blocks(options.width, targets);
  const Table table(exec, kernels(isa), lines, blocks, camera.altitude, camera.horizon_px,
                    static_cast<double>(terrain.highest()));
  const Image<float>& heights = *terrain.heights();
  const Image<Rgba8>& colors = *terrain.colors();
  const auto power_of_two = [](int n) { return (n & (n - 1)) == 0; };
  const double reach =
      std::max(std::abs(camera.x), std::abs(camera.y)) + 2 * options.distance + kBlockColumns;
  const MapSize map{heights.width(), heights.height(), options.tiling,
                    options.tiling == Tiling::repeat && power_of_two(heights.width()) &&
                        power_of_two(heights.height()) && reach < 0x1p31};
  const bool direct = heights.width() == colors.width() && heights.height() == colors.height();

  return draw_blocks(
      exec, isa, pool, options.sky, targets, blocks, options.height,
      [&](const Kernels& kernels, std::size_t b, BlockMarks& marks) {
        const std::size_t n = blocks.size(b);
        const double* x = table.x.data() + b * table.slices;
        const double* y = table.y.data() + b * table.slices;
        alignas(64) std::int32_t cells[kBlockColumns * kClassicSlices];
        ColumnBlock block;
        block.restart(n, options.height);
        Counts counts;
        for (std::size_t k = 0; k < lines.size(); ++k) {
          if (static_cast<double>(block.deepest) <= table.lowest_row[k]) break;
          const std::size_t lane = k % kClassicSlices;
          if (lane == 0) {
            if (stop_requested()) break;  // as in fast.cpp
            const std::size_t last = std::min(k + kClassicSlices, lines.size()) - 1;
            const double top = table.highest(ceiling, options.tiling, x, y, k, last, n);
            const double row = std::min((camera.altitude - top) * lines[k].rows,
                                        (camera.altitude - top) * lines[last].rows);
            if (static_cast<double>(block.deepest) <= row + camera.horizon_px) {
              k = last;
              continue;
            }
            kernels.classic_cells({x + k, y + k, table.dx.data() + k, table.dy.data() + k}, map, n,
                                  cells);
          }
          for (std::size_t i = 0; i < n; ++i) {
            block.cells[i] = cells[i * kClassicSlices + lane];
            block.heights[i] = heights.pixels()[static_cast<std::size_t>(block.cells[i])];
          }
          counts.samples += n;
          const std::size_t visible =
              kernels.occlude64(camera.altitude, lines[k].rows, camera.horizon_px, n, block);
          if (visible == 0) continue;
          counts.visible += visible;
          marks.put_depth(block, visible, static_cast<float>(lines[k].z));
          if (direct) {
            marks.put_cells(block, visible, colors.pixels().data());
            continue;
          }
          Rgba8 seen[kBlockColumns];
          for (std::size_t i = 0; i < visible; ++i) {
            const auto column = static_cast<std::size_t>(block.mark[i]) % kBlockColumns;
            double px = x[k], py = y[k];
            for (std::size_t c = 0; c < column; ++c) {
              px += table.dx[k];
              py += table.dy[k];
            }
            seen[i] = terrain.color_at(px, py, options.tiling);
          }
          marks.put_colors(block, visible, seen);
        }
        return counts;
      });
}

}  // namespace rastrum::terrain
