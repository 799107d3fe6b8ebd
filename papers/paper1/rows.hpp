// SPDX-License-Identifier: BSD-3-Clause
// The two expansions of `scanline` as functors for host and device: a piece to its rows, a row to
// the blocks that it crosses (paper 5, section 3.1; paper 1, section 3.1).
#pragma once

#include <cstddef>
#include <cstdint>

#include <papers/axes/names.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/raster/rules/piece.hpp>

namespace rastrum::family {

/// The pixels [begin, end) of row y that a piece covers; may be empty.
struct PieceRow {
  std::uint32_t piece;
  std::uint16_t y, begin, end;
};

/// Row expansion: how many rows a piece has …
struct RowCount {
  const Piece* pieces;
  Rect view;
  RASTRUM_HD std::size_t operator()(std::uint32_t piece) const {
    const Rect box = piece_bounds(pieces[piece], view);
    return box.empty() ? 0 : static_cast<std::size_t>(box.y1 - box.y0);
  }
};
/// … and row j.
struct MakeRow {
  const Piece* pieces;
  Rect view;
  RASTRUM_HD PieceRow operator()(std::uint32_t piece, std::size_t j) const {
    const Rect box = piece_bounds(pieces[piece], view);
    const int y = box.y0 + static_cast<int>(j);
    const Span span = row_span(pieces[piece], y, box.x0, box.x1);
    return {piece, static_cast<std::uint16_t>(y), static_cast<std::uint16_t>(span.begin),
            static_cast<std::uint16_t>(span.end)};
  }
};

/// Column expansion: how many blocks a row crosses …
struct RunCount {
  RASTRUM_HD std::size_t operator()(const PieceRow& row) const {
    if (row.begin == row.end) return 0;
    return static_cast<std::size_t>((row.end - 1) / kBlockSize - row.begin / kBlockSize + 1);
  }
};
/// … and its part in the j-th of them.
struct MakeRun {
  RASTRUM_HD Block operator()(const PieceRow& row, std::size_t j) const {
    const int bx = row.begin / kBlockSize + static_cast<int>(j);
    const int by = row.y / kBlockSize;
    return {row.piece, static_cast<std::uint16_t>(bx), static_cast<std::uint16_t>(by),
            samples_inside({row.begin, row.y, row.end, row.y + 1}, bx, by)};
  }
};

}  // namespace rastrum::family
