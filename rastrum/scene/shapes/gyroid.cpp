// SPDX-License-Identifier: BSD-3-Clause
// The gyroid sin x cos y + sin y cos z + sin z cos x = 0 in the cube [−1, 1]³ by marching cubes, as
// three expansions: crossed grid edges → vertices, crossed cells, cells → triangle corners.
//
// The front faces positive values. A crossed grid edge has one shared vertex. Every edge has two
// triangles, except where the cube's faces cut the surface off.

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <vector>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/parallel/words.hpp>
#include <rastrum/scene/shapes/marching_cubes_table.hpp>
#include <rastrum/scene/shapes/require.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::shapes {
namespace {

/// The field at the points of a grid of cells³ cells. Points are numbered x fastest, z slowest;
/// grid edge 3 p + a runs from point p along axis a.
class Grid {
 public:
  Grid(int cells, double periods) : points_(static_cast<std::size_t>(cells) + 1) {
    for (std::size_t i = 0; i < points_; ++i) {
      coordinate_.push_back(2.0 * static_cast<double>(i) / cells - 1);
      const auto [s, c] = elementary::sin_cos(std::numbers::pi * periods * coordinate_[i]);
      sin_.push_back(s);
      cos_.push_back(c);
    }
  }

  [[nodiscard]] std::size_t points() const { return points_; }  ///< along an axis
  [[nodiscard]] std::size_t cells() const { return points_ - 1; }
  [[nodiscard]] std::size_t point(std::size_t x, std::size_t y, std::size_t z) const {
    return (z * points_ + y) * points_ + x;
  }
  [[nodiscard]] double value(std::size_t x, std::size_t y, std::size_t z) const {
    return sin_[x] * cos_[y] + sin_[y] * cos_[z] + sin_[z] * cos_[x];
  }
  /// Many grid points lie exactly on the surface, where rounding of 1e-16 must not decide the
  /// topology.
  [[nodiscard]] bool inside(std::size_t x, std::size_t y, std::size_t z) const {
    return value(x, y, z) < 1e-9;
  }
  [[nodiscard]] unsigned inside_corners(std::size_t x, std::size_t y, std::size_t z) const {
    unsigned set = 0;
    for (unsigned c = 0; c < 8; ++c)
      set |= unsigned{inside(x + (c & 1U), y + (c >> 1 & 1U), z + (c >> 2))} << c;
    return set;
  }
  [[nodiscard]] Vec3d position(std::size_t x, std::size_t y, std::size_t z) const {
    return {coordinate_[x], coordinate_[y], coordinate_[z]};
  }

 private:
  std::size_t points_;
  std::vector<double> coordinate_, sin_, cos_;
};

struct Cell {
  std::size_t point = 0;  ///< the corner with the smallest coordinates
  unsigned inside = 0;
};

/// Where the surface crosses a grid edge, linearly. It stays off the ends, so that no triangle
/// collapses.
Vec3d crossing(const Grid& grid, std::size_t edge) {
  const std::size_t n = grid.points(), axis = edge % 3, p = edge / 3;
  const std::size_t x = p % n, y = p / n % n, z = p / n / n;
  const std::size_t x1 = x + (axis == 0 ? 1 : 0), y1 = y + (axis == 1 ? 1 : 0),
                    z1 = z + (axis == 2 ? 1 : 0);
  const double from = grid.value(x, y, z), to = grid.value(x1, y1, z1);
  const double t = std::clamp(from / (from - to), 0.01, 0.99);
  return grid.position(x, y, z) * (1 - t) + grid.position(x1, y1, z1) * t;
}

Vec3d gradient(Vec3d p, double scale) {
  const auto [sx, cx] = elementary::sin_cos(scale * p.x);
  const auto [sy, cy] = elementary::sin_cos(scale * p.y);
  const auto [sz, cz] = elementary::sin_cos(scale * p.z);
  return {cx * cy - sz * sx, cy * cz - sx * sy, cz * cx - sy * sz};
}

/// All crossed grid edges, ascending. An edge's place in this list is its vertex.
parallel::Buffer<std::size_t> crossed_edges(parallel::Threads& exec, const Grid& grid) {
  const std::size_t n = grid.points();
  return parallel::expand_masked(
      exec, parallel::counting(n * n), [&](std::size_t) { return 3 * n; },
      [&](std::size_t row, std::size_t j) {
        const std::size_t x = j / 3, y = row % n, z = row / n, axis = j % 3;
        if ((axis == 0 ? x : axis == 1 ? y : z) + 1 == n) return false;
        return grid.inside(x, y, z) != grid.inside(x + (axis == 0 ? 1 : 0), y + (axis == 1 ? 1 : 0),
                                                   z + (axis == 2 ? 1 : 0));
      },
      [&](std::size_t row, std::size_t j) { return 3 * n * row + j; });
}

parallel::Buffer<Cell> crossed_cells(parallel::Threads& exec, const Grid& grid) {
  const std::size_t n = grid.cells();
  return parallel::expand_masked(
      exec, parallel::counting(n * n), [&](std::size_t) { return n; },
      [&](std::size_t row, std::size_t x) {
        const unsigned inside = grid.inside_corners(x, row % n, row / n);
        return inside != 0 && inside != 255;
      },
      [&](std::size_t row, std::size_t x) {
        return Cell{grid.point(x, row % n, row / n), grid.inside_corners(x, row % n, row / n)};
      });
}

}  // namespace

Mesh gyroid(int cells, float periods) {
  const FloatScope floats;
  require_range("gyroid", "cells", cells, 2, 1024);
  require_range("gyroid", "periods", periods, 0.01, cells);
  parallel::Threads exec;
  const Grid grid(cells, double{periods});
  const auto edges = crossed_edges(exec, grid);
  require_size("gyroid", "cells and periods", static_cast<double>(edges.size()));

  Mesh mesh;
  mesh.name = "gyroid";
  mesh.positions.resize(edges.size());
  mesh.normals.values.resize(edges.size());
  parallel::transform(exec, edges, mesh.positions,
                      [&](std::size_t edge) { return static_cast<Vec3>(crossing(grid, edge)); });
  parallel::transform(exec, edges, mesh.normals.values, [&](std::size_t edge) {
    return static_cast<Vec3>(
        normalize(gradient(crossing(grid, edge), std::numbers::pi * double{periods})));
  });

  const auto indices = parallel::expand(
      exec, crossed_cells(exec, grid),
      [](const Cell& cell) { return 3 * kMarchingCubes[cell.inside].count; },
      [&](const Cell& cell, std::size_t j) {
        const int edge = kMarchingCubes[cell.inside].edge[j / 3][j % 3];
        const auto corner = static_cast<std::size_t>(edge_start(edge));
        const std::size_t start = cell.point + grid.point(corner & 1, corner >> 1 & 1, corner >> 2);
        const std::size_t id = 3 * start + static_cast<std::size_t>(edge / 4);
        return static_cast<std::uint32_t>(std::lower_bound(edges.begin(), edges.end(), id) -
                                          edges.begin());
      });
  mesh.indices.assign(indices.begin(), indices.end());
  return mesh;
}

}  // namespace rastrum::shapes
