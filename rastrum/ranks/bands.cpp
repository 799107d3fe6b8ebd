// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/ranks/bands.hpp>

#include <algorithm>

#include <rastrum/ranks/fragments.hpp>
#include <rastrum/raster/kernels/kernels.hpp>

namespace rastrum::ranks {

using raster::kBinSize;
using raster::Rect;

std::vector<Rect> bands_of(int width, int height, std::span<const BinFragments> bins,
                           std::size_t ranks, std::uint64_t bytes) {
  const int columns = (width + kBinSize - 1) / kBinSize, rows = (height + kBinSize - 1) / kBinSize;
  // A rank holds its own fragments twice, by block and packed, and its share of all.
  const auto bytes_of = [&](const BinFragments& b) {
    return (2 * b.most + (b.all + ranks - 1) / ranks) * kFragmentBytes;
  };
  const auto rect_of = [&](int x0, int y0, int x1, int y1) {
    return Rect{x0 * kBinSize, y0 * kBinSize, std::min(x1 * kBinSize, width),
                std::min(y1 * kBinSize, height)};
  };
  std::vector<Rect> bands;
  int first = 0;  // of the rows that are not yet in a band
  std::uint64_t held = 0;
  const auto end_band = [&](int row) {
    if (held > 0) bands.push_back(rect_of(0, first, columns, row));
    first = row;
    held = 0;
  };
  for (int y = 0; y < rows; ++y) {
    const auto row = bins.subspan(static_cast<std::size_t>(y) * static_cast<std::size_t>(columns),
                                  static_cast<std::size_t>(columns));
    std::uint64_t of_row = 0;
    for (const BinFragments& b : row) of_row += bytes_of(b);
    if (of_row == 0) {
      if (held == 0) first = y + 1;
      continue;
    }
    if (held + of_row > bytes) end_band(y);
    held += of_row;
    if (of_row <= bytes) continue;
    held = 0;
    int begin = 0;
    for (int x = 0; x < columns; ++x) {
      const std::uint64_t of_bin = bytes_of(row[static_cast<std::size_t>(x)]);
      if (held > 0 && held + of_bin > bytes) {
        bands.push_back(rect_of(begin, y, x, y + 1));
        held = 0;
      }
      if (held == 0) begin = x;
      held += of_bin;
    }
    if (held > 0) bands.push_back(rect_of(begin, y, columns, y + 1));
    first = y + 1;
    held = 0;
  }
  end_band(rows);
  return bands;
}

}  // namespace rastrum::ranks
