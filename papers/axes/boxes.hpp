// SPDX-License-Identifier: BSD-3-Clause
// How large the box of a piece is in a view, and which blocks it touches: functors for host and
// device.
#pragma once

#include <cstddef>
#include <cstdint>

#include <papers/axes/names.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/raster/rules/piece.hpp>

namespace rastrum::family {

/// A piece is small if its box has at most this many pixels (paper 1, table 5, after Schütz et al.,
/// CuRast, 2026).
inline constexpr std::uint64_t kSmallPx = 128;
/// `binned` queues a piece if its box has at least this many pixels (paper 2).
inline constexpr int kLargePx = 4000;

/// The number of pixels of a piece's box in the view.
struct BoxArea {
  const Piece* pieces;
  Rect view;
  RASTRUM_HD std::uint64_t operator()(std::uint32_t piece) const {
    const Rect box = piece_bounds(pieces[piece], view);
    if (box.empty()) return 0;
    return static_cast<std::uint64_t>(box.x1 - box.x0) *
           static_cast<std::uint64_t>(box.y1 - box.y0);
  }
};

/// The blocks that a piece's box touches.
struct BoxBlocks {
  int bx = 0, by = 0, columns = 0, rows = 0;

  RASTRUM_HD static BoxBlocks of(const Piece& piece, Rect view) {
    const Rect box = piece_bounds(piece, view);
    if (box.empty()) return {};
    const int bx = box.x0 / kBlockSize, by = box.y0 / kBlockSize;
    return {bx, by, (box.x1 - 1) / kBlockSize - bx + 1, (box.y1 - 1) / kBlockSize - by + 1};
  }
  [[nodiscard]] RASTRUM_HD std::size_t count() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
};

}  // namespace rastrum::family
