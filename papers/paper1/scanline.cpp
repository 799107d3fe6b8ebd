// SPDX-License-Identifier: BSD-3-Clause
#include <papers/paper1/scanline.hpp>

#include <papers/axes/expand_in_turns.hpp>
#include <papers/axes/immediate.hpp>
#include <papers/axes/piece_array.hpp>
#include <papers/paper1/rows.hpp>

namespace rastrum::family {
namespace {

/// A row and its place in the expansion to runs.
constexpr std::uint64_t kRowBytes = sizeof(PieceRow) + sizeof(std::size_t);

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
      [&](const parallel::Buffer<PieceRow>& rows) {
        const parallel::Expansion runs(frame.exec, rows, RunCount{}, kResultsPerChunk);
        draw_expanded(frame, pieces, runs, rows,
                      [](const PieceRow& row, std::size_t j, Emitter& emitter) {
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

}  // namespace rastrum::family
