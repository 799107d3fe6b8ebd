// SPDX-License-Identifier: BSD-3-Clause
// The operations of kernels_simd.cpp one column at a time.
#include <rastrum/terrain/kernels.hpp>

#include <cmath>

namespace rastrum::terrain {
namespace {

void heights_scalar(const Samples& samples, const Slice& slice, std::size_t n,
                    ColumnBlock& b) noexcept {
  const MapView& map = samples.map;
  const int level = map.height_level(slice.level);
  for (std::size_t i = 0; i < n; ++i) {
    const float x = samples.setup.fx + slice.z * b.ux[i], y = samples.setup.fy + slice.z * b.uy[i];
    b.heights[i] = map.height_at(x, y, level);
    b.cells[i] = map.filter == MapFilter::bilinear ? 0 : map.cell_at(x, y, level);
  }
}

template <class Real>
std::size_t occlude_scalar(Real altitude, Real rows, Real horizon, std::size_t n,
                           ColumnBlock& b) noexcept {
  std::size_t visible = 0;
  b.deepest = -std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < n; ++i) {
    const Real row = (altitude - static_cast<Real>(b.heights[i])) * rows + horizon;
    if (!(row < static_cast<Real>(b.hidden[i]))) {
      b.deepest = std::max(b.deepest, b.hidden[i]);
      continue;
    }
    const auto top = static_cast<std::int32_t>(row > 0 ? row : 0);
    b.hidden[i] = top > 0 ? static_cast<float>(top) : -std::numeric_limits<float>::infinity();
    b.deepest = std::max(b.deepest, b.hidden[i]);
    b.mark[visible] = top * static_cast<std::int32_t>(kBlockColumns) + static_cast<int>(i);
    b.cell[visible++] = b.cells[i];
  }
  return visible;
}

void advance_scalar(std::size_t columns, const double* dx, const double* dy, double* x,
                    double* y) noexcept {
  for (std::size_t k = 0; k < kClassicSlices; ++k)
    for (std::size_t i = 0; i < columns; ++i) {
      x[k] += dx[k];
      y[k] += dy[k];
    }
}

void classic_cells_scalar(const ClassicSlices& s, const MapSize& map, std::size_t n,
                          std::int32_t* cells) noexcept {
  const auto cell = [&map](double at, int size) {
    return static_cast<std::int32_t>(
        tiled(static_cast<std::int64_t>(std::floor(at)), size, map.tiling));
  };
  for (std::size_t k = 0; k < kClassicSlices; ++k) {
    double x = s.x[k], y = s.y[k];
    for (std::size_t i = 0; i < n; ++i, x += s.dx[k], y += s.dy[k])
      cells[i * kClassicSlices + k] = cell(y, map.height) * map.width + cell(x, map.width);
  }
}

void fill_scalar(std::uint32_t* marks, int first, int last, std::size_t n, std::uint32_t* above,
                 std::uint32_t* out, std::ptrdiff_t stride, bool) noexcept {
  for (int y = first; y < last; ++y) {
    std::uint32_t* row = marks + static_cast<std::size_t>(y) * kBlockColumns;
    for (std::size_t i = 0; i < n; ++i) {
      above[i] = row[i] != 0 ? row[i] : above[i];
      row[i] = 0;
      out[y * stride + static_cast<std::ptrdiff_t>(i)] = above[i];
    }
  }
}

}  // namespace

constexpr Kernels kScalarKernels{heights_scalar,
                                 colors_one_by_one,
                                 occlude_scalar<float>,
                                 occlude_scalar<double>,
                                 advance_scalar,
                                 classic_cells_scalar,
                                 fill_scalar};

void colors_one_by_one(const Samples& samples, const Slice& slice, std::size_t n,
                       const ColumnBlock& b, Rgba8* colors) noexcept {
  const SetupView& setup = samples.setup;
  for (std::size_t i = 0; i < n; ++i) {
    const auto column = static_cast<std::size_t>(b.mark[i]) % kBlockColumns;
    const float x = setup.fx + slice.z * b.ux[column], y = setup.fy + slice.z * b.uy[column];
    colors[i] = faded(samples.map.color_at(x, y, slice.level), setup.fog, slice.clear);
  }
}

}  // namespace rastrum::terrain
