#include <rastrum/raster/coverage/scanline.hpp>

#include <rastrum/raster/coverage.hpp>
#include <rastrum/raster/coverage/expand_in_turns.hpp>
#include <rastrum/raster/coverage/immediate.hpp>
#include <rastrum/raster/set_up.hpp>

namespace rastrum::raster {
namespace {

/// The pixels [begin, end) of row y that a piece covers; possibly none.
struct Row {
  std::uint32_t piece;
  std::uint16_t y, begin, end;
};

/// Row expansion: how many there are …
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
  RASTRUM_HD Row operator()(std::uint32_t piece, std::size_t j) const {
    const Rect box = piece_bounds(pieces[piece], view);
    const int y = box.y0 + static_cast<int>(j);
    const Span span = row_span(pieces[piece], y, box.x0, box.x1);
    return {piece, static_cast<std::uint16_t>(y), static_cast<std::uint16_t>(span.begin),
            static_cast<std::uint16_t>(span.end)};
  }
};

/// Column expansion: the blocks that a row crosses …
struct RunCount {
  RASTRUM_HD std::size_t operator()(const Row& row) const {
    if (row.begin == row.end) return 0;
    return static_cast<std::size_t>((row.end - 1) / kBlockSize - row.begin / kBlockSize + 1);
  }
};
/// … and its part in block j of them.
struct MakeRun {
  RASTRUM_HD Block operator()(const Row& row, std::size_t j) const {
    const int bx = row.begin / kBlockSize + static_cast<int>(j);
    const int by = row.y / kBlockSize;
    return {row.piece, static_cast<std::uint16_t>(bx), static_cast<std::uint16_t>(by),
            samples_inside({row.begin, row.y, row.end, row.y + 1}, bx, by)};
  }
};

/// A row and its place in the expansion to runs.
constexpr std::uint64_t kRowBytes = sizeof(Row) + sizeof(std::size_t);

class Scanline final : public Coverage {
 public:
  explicit Scanline(MemoryAccount& memory) : pieces_(memory) {}

  void draw(Frame& frame, std::uint64_t first, std::uint64_t last) override {
    const std::span<const Piece> pieces = pieces_.fill(frame, first, last);
    const auto which = pieces_in_view(frame, pieces);
    frame.watch.lap(frame.stats, "setup");
    draw_scanlines(frame, pieces.data(), which);
    frame.watch.lap(frame.stats, "draw");
  }

 private:
  PieceArray pieces_;
};

}  // namespace

void draw_scanlines(Frame& frame, const Piece* pieces, std::span<const std::uint32_t> which) {
  std::uint64_t run_count = 0;
  const std::uint64_t row_count = expand_in_turns(
      frame, which, RowCount{pieces, frame.view}, MakeRow{pieces, frame.view}, kRowBytes,
      [&](const parallel::Buffer<Row>& rows) {
        const parallel::Expansion runs(frame.exec, rows, RunCount{}, kResultsPerChunk);
        draw_expanded(frame, pieces, runs, rows,
                      [](const Row& row, std::size_t j, Emitter& emitter) {
                        emitter.add(MakeRun{}(row, j));
                      });
        run_count += runs.size();
      });
  frame.count("rows", row_count);
  frame.count("runs", run_count);
}

std::unique_ptr<Coverage> make_scanline(const Tuning&, MemoryAccount& memory) {
  return std::make_unique<Scanline>(memory);
}

}  // namespace rastrum::raster
