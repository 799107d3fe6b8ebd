// SPDX-License-Identifier: BSD-3-Clause
// The boxes of pieces in a view: how large they are, and the blocks that they touch. Functors for
// host and device.
#pragma once

#include <cstddef>
#include <cstdint>

#include <papers/axes/names.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/raster/rules/piece.hpp>

namespace rastrum::family {

/// Pixels of its box up to which a piece is small: paper 1, table 5, after Schütz et al., 2021.
inline constexpr std::uint64_t kSmallPx = 128;
/// From which `binned` sends it through its queue: paper 2.
inline constexpr int kLargePx = 4000;

/// Pixels of a piece's box in the view.
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
