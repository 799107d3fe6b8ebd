// SPDX-License-Identifier: BSD-3-Clause
// Where visibility keys live: 8 × 8 blocks of 64 keys, so that a block is one piece of memory
// (512 bytes), whether it belongs to a tile that a thread owns or to the whole frame.
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/raster/rules/color.hpp>
#include <rastrum/raster/rules/piece.hpp>

namespace rastrum::raster {

/// Where block b of an image lies, whose blocks are row by row, `columns` of them across.
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

/// A rectangle of blocks, rows of them `columns` apart. Borrows its memory. 0 is an empty key.
struct SurfaceView {
  int bx0 = 0, by0 = 0;  ///< its first block
  int columns = 0;       ///< blocks from one row of blocks to the next
  std::uint64_t* keys = nullptr;
  BlockColors* colors = nullptr;  ///< per block, where visibility shades at once; else null

  [[nodiscard]] RASTRUM_HD std::size_t index(int bx, int by) const {
    return static_cast<std::size_t>(by - by0) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(bx - bx0);
  }
  [[nodiscard]] RASTRUM_HD std::uint64_t* block(int bx, int by) const {
    return keys + index(bx, by) * 64;
  }
  /// The pixel of keys[element].
  [[nodiscard]] RASTRUM_HD PixelPlace place_of(std::size_t element) const {
    const BlockPlace block(element / 64, static_cast<std::size_t>(columns));
    const auto i = static_cast<int>(element % 64);
    return {(bx0 + static_cast<int>(block.column)) * kBlockSize + i % kBlockSize,
            (by0 + static_cast<int>(block.row)) * kBlockSize + i / kBlockSize};
  }
  [[nodiscard]] BlockColors* colors_of(int bx, int by) const {
    return colors == nullptr ? nullptr : colors + index(bx, by);
  }
  /// The part that begins at block (bx, by).
  [[nodiscard]] SurfaceView part(int bx, int by) const {
    return {bx, by, columns, block(bx, by), colors_of(bx, by)};
  }
};

/// Blocks across `r`, whose first pixel is the first of a block.
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
