// SPDX-License-Identifier: BSD-3-Clause
#include <papers/axes/immediate.hpp>

#include <papers/axes/boxes.hpp>
#include <rastrum/parallel/filter.hpp>
#include <rastrum/parallel/range.hpp>

namespace rastrum::family {
parallel::Buffer<std::uint32_t> pieces_in_view(Frame& frame, std::span<const Piece> pieces) {
  return parallel::filter(
      frame.exec, parallel::counting<std::uint32_t>(pieces.size()),
      [area = BoxArea{pieces.data(), frame.view}](std::uint32_t i) { return area(i) != 0; });
}

parallel::Partition<std::uint32_t> small_pieces_first(Frame& frame, std::span<const Piece> pieces) {
  const int asked = frame.tuning.small_px;
  const std::uint64_t small_px = asked == 0 ? kSmallPx : static_cast<std::uint64_t>(asked);
  auto parted = parallel::partition(frame.exec, pieces_in_view(frame, pieces),
                                    [=, area = BoxArea{pieces.data(), frame.view}](
                                        std::uint32_t i) { return area(i) <= small_px; });
  frame.count("small", parted.first_count);
  frame.count("large", parted.elements.size() - parted.first_count);
  return parted;
}

void draw_box_blocks(Frame& frame, const Piece* pieces, std::span<const std::uint32_t> which) {
  const Rect view = frame.view;
  const BlockOrder order = frame.tuning.order;
  const auto blocks_of = [=](std::uint32_t piece) { return BoxBlocks::of(pieces[piece], view); };
  const parallel::Expansion blocks(
      frame.exec, which, [&](std::uint32_t piece) { return blocks_of(piece).count(); },
      kResultsPerChunk);
  draw_expanded(frame, pieces, blocks, which,
                [&](std::uint32_t piece, std::size_t j, Emitter& emitter) {
                  const BoxBlocks box = blocks_of(piece);
                  const Cell cell = cell_at(order, j, box.columns, box.rows);
                  emitter.add_uncovered(piece, box.bx + cell.column, box.by + cell.row);
                });
}

}  // namespace rastrum::family
