// SPDX-License-Identifier: BSD-3-Clause
// scanline on a device (scanline.hpp), with the host's functors (rows.hpp). One thread makes a row
// or a run.
#pragma once

#include <cstdint>
#include <span>

#include <papers/axes/small.cuh>
#include <papers/paper1/rows.hpp>

namespace rastrum::family {

/// Work O(pieces + (rows + runs) log). Counters: "rows", "runs".
template <class Exec>
void draw_scanlines(FamilyFrame<Exec>& frame, std::span<const Piece> pieces,
                    std::span<const std::uint32_t> which) {
  constexpr std::uint64_t kRowBytes = sizeof(PieceRow) + sizeof(std::size_t);
  const Rect view = frame.surface.view;
  std::uint64_t runs = 0;
  const std::uint64_t rows = expand_in_turns(
      frame.exec, which, RowCount{pieces.data(), view}, MakeRow{pieces.data(), view},
      frame.most(kRowBytes), [&](std::span<const PieceRow> some) {
        runs += expand_in_turns(frame.exec, some, RunCount{}, MakeRun{}, frame.most(kBlockBytes),
                                [&](std::span<const Block> blocks) { frame.emit(pieces, blocks); });
      });
  frame.count("rows", rows);
  frame.count("runs", runs);
}

template <class Exec>
void draw_scanline(FamilyFrame<Exec>& frame, std::span<const Piece> pieces) {
  const auto which = all_pieces(frame, pieces);
  draw_scanlines(frame, pieces, parallel::view_of(which));
}

}  // namespace rastrum::family
