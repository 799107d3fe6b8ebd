// SPDX-License-Identifier: BSD-3-Clause
// Picks the pieces of a batch for several coverages of the family: all by index, or the small ones
// apart. Small ones are drawn by the blocks that their boxes touch (paper 1, table 5).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <papers/axes/boxes.hpp>
#include <papers/axes/frame.cuh>
#include <papers/axes/order.hpp>
#include <papers/axes/turns.cuh>

namespace rastrum::family {

struct HasAreaUpTo {
  BoxArea area;
  std::uint64_t most_px;
  RASTRUM_HD bool operator()(std::uint32_t piece) const { return area(piece) <= most_px; }
};

template <class Exec>
[[nodiscard]] auto all_pieces(FamilyFrame<Exec>& frame, std::span<const Piece> pieces) {
  auto which = parallel::make_buffer<std::uint32_t>(frame.exec, pieces.size());
  parallel::tabulate(frame.exec, which, parallel::range_detail::IndexItself<std::uint32_t>{});
  return which;
}

/// All pieces, small ones first: those whose box in the view has at most `most_px` pixels. Counts
/// "small" and "large".
template <class Exec>
[[nodiscard]] auto small_pieces_first(FamilyFrame<Exec>& frame, std::span<const Piece> pieces,
                                      std::uint64_t most_px) {
  auto parted =
      parallel::partition(frame.exec, parallel::counting<std::uint32_t>(pieces.size()),
                          HasAreaUpTo{BoxArea{pieces.data(), frame.surface.view}, most_px});
  frame.count("small", parted.first_count);
  frame.count("large", parted.elements.size() - parted.first_count);
  return parted;
}
/// The same with the tuning's limit, for `pineda` and `hybrid`.
template <class Exec>
[[nodiscard]] auto small_pieces_first(FamilyFrame<Exec>& frame, std::span<const Piece> pieces) {
  const int asked = frame.tuning.small_px;
  return small_pieces_first(frame, pieces,
                            asked == 0 ? kSmallPx : static_cast<std::uint64_t>(asked));
}

struct BoxBlockCount {
  const Piece* pieces;
  Rect view;
  RASTRUM_HD std::size_t operator()(std::uint32_t piece) const {
    return BoxBlocks::of(pieces[piece], view).count();
  }
};
struct MakeBoxBlock {
  const Piece* pieces;
  Rect view;
  BlockOrder order;
  RASTRUM_HD Block operator()(std::uint32_t piece, std::size_t j) const {
    const BoxBlocks box = BoxBlocks::of(pieces[piece], view);
    const Cell cell = cell_at(order, j, box.columns, box.rows);
    const int bx = box.bx + cell.column, by = box.by + cell.row;
    return {piece, static_cast<std::uint16_t>(bx), static_cast<std::uint16_t>(by),
            cover_box(edges_of(pieces[piece]), view, bx, by)};
  }
};

/// Expands each piece to the blocks that its box touches. Work O(pieces + blocks).
template <class Exec>
void draw_box_blocks(FamilyFrame<Exec>& frame, std::span<const Piece> pieces,
                     std::span<const std::uint32_t> which) {
  const Rect view = frame.surface.view;
  expand_in_turns(frame.exec, which, BoxBlockCount{pieces.data(), view},
                  MakeBoxBlock{pieces.data(), view, frame.tuning.order}, frame.most(kBlockBytes),
                  [&](std::span<const Block> blocks) { frame.emit(pieces, blocks); });
}

}  // namespace rastrum::family
