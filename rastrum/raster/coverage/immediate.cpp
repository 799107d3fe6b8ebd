#include <rastrum/raster/coverage/immediate.hpp>

#include <rastrum/parallel/filter.hpp>
#include <rastrum/parallel/range.hpp>
#include <rastrum/raster/coverage.hpp>

namespace rastrum::raster {
namespace {

/// Paper 1, table 5, after Schütz et al., 2021.
constexpr std::uint64_t kSmallPx = 128;

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

}  // namespace

parallel::Buffer<std::uint32_t> pieces_in_view(Frame& frame, std::span<const Piece> pieces) {
  return parallel::filter(
      frame.exec, parallel::counting<std::uint32_t>(pieces.size()),
      [area = BoxArea{pieces.data(), frame.view}](std::uint32_t i) { return area(i) != 0; });
}

parallel::Partition<std::uint32_t> small_pieces_first(Frame& frame, std::span<const Piece> pieces) {
  const int asked = frame.request.tuning.small_px;
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
  const BlockOrder order = frame.request.tuning.order;
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

}  // namespace rastrum::raster
