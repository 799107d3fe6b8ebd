// SPDX-License-Identifier: BSD-3-Clause
// Storage of visibility keys: 8 × 8 blocks of 64 keys. A block is contiguous (512 bytes), in a
// thread's tile and in a whole frame.
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/raster/rules/color.hpp>
#include <rastrum/raster/rules/piece.hpp>

namespace rastrum::raster {

/// `columns`: blocks across an image whose blocks lie row by row.
struct BlockPlace {
  std::uint32_t column, row;
  // An image has fewer than 2^32 blocks, and a GPU divides 64 bits slowly.
  RASTRUM_HD BlockPlace(std::size_t b, std::size_t columns)
      : column(static_cast<std::uint32_t>(b) % static_cast<std::uint32_t>(columns)),
        row(static_cast<std::uint32_t>(b) / static_cast<std::uint32_t>(columns)) {}
};

struct PixelPlace {
  int x, y;
};

/// A rectangle of blocks. Borrows its memory. 0 is an empty key.
struct SurfaceView {
  int bx0 = 0, by0 = 0;  ///< its first block
  int columns = 0;       ///< blocks from one row of blocks to the next
  std::uint64_t* keys = nullptr;
  BlockColors* colors = nullptr;  ///< per block, if visibility shades at once; else null

  [[nodiscard]] RASTRUM_HD std::size_t index(int bx, int by) const {
    return static_cast<std::size_t>(by - by0) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(bx - bx0);
  }
  [[nodiscard]] RASTRUM_HD std::uint64_t* block(int bx, int by) const {
    return keys + index(bx, by) * 64;
  }
  [[nodiscard]] RASTRUM_HD PixelPlace place_of(std::size_t element) const {
    const BlockPlace block(element / 64, static_cast<std::size_t>(columns));
    const auto i = static_cast<int>(element % 64);
    return {(bx0 + static_cast<int>(block.column)) * kBlockSize + i % kBlockSize,
            (by0 + static_cast<int>(block.row)) * kBlockSize + i / kBlockSize};
  }
  [[nodiscard]] BlockColors* colors_of(int bx, int by) const {
    return colors == nullptr ? nullptr : colors + index(bx, by);
  }
  [[nodiscard]] SurfaceView part(int bx, int by) const {
    return {bx, by, columns, block(bx, by), colors_of(bx, by)};
  }
};

/// Requires that `r` starts at a block's first pixel.
[[nodiscard]] RASTRUM_HD constexpr int block_columns(Rect r) {
  return (r.x1 - r.x0 + kBlockSize - 1) / kBlockSize;
}
[[nodiscard]] RASTRUM_HD constexpr int block_rows(Rect r) {
  return (r.y1 - r.y0 + kBlockSize - 1) / kBlockSize;
}
[[nodiscard]] RASTRUM_HD constexpr std::size_t block_count(Rect r) {
  return static_cast<std::size_t>(block_columns(r)) * static_cast<std::size_t>(block_rows(r));
}

}  // namespace rastrum::raster
