// SPDX-License-Identifier: BSD-3-Clause
#include <papers/paper1/pineda.hpp>

#include <papers/axes/immediate.hpp>
#include <papers/axes/piece_array.hpp>
#include <papers/paper1/tiles.hpp>

namespace rastrum::family {
namespace {

class Pineda final : public Coverage {
 public:
  Pineda(const Tuning& tuning, MemoryAccount& memory)
      : sizes_(checked_sizes("pineda", tuning, {}, kBlockSize / 2)), pieces_(memory) {}

  void draw(Frame& frame, std::uint64_t first, std::uint64_t last) override {
    const std::span<const Piece> pieces = pieces_.fill(frame, first, last);
    const auto parted = small_pieces_first(frame, pieces);
    const std::span<const std::uint32_t> all = parted.elements;
    frame.watch.lap(frame.stats, "setup");
    draw_box_blocks(frame, pieces.data(), all.first(parted.first_count));
    frame.watch.lap(frame.stats, "small");
    draw_tiles_of(frame, pieces.data(), all.subspan(parted.first_count));
    frame.watch.lap(frame.stats, "large");
  }

 private:
  void draw_tiles_of(Frame& frame, const Piece* pieces,
                     std::span<const std::uint32_t> which) const {
    const Tiles tiles(sizes_, pieces, frame.view, frame.tuning.order);
    expand_tiles(
        frame, tiles, which, kResultsPerChunk, 0, [&](const auto& bins, const auto& expansion) {
          draw_expanded(frame, pieces, expansion, bins,
                        [&](const BinPair& pair, std::size_t j, Emitter& emitter) {
                          add_tile(frame, tiles, pair.piece, tiles.tile(pair.bin, j), emitter);
                        });
        });
  }

  BinSizes sizes_;
  PieceArray pieces_;
};

}  // namespace

std::unique_ptr<Coverage> make_pineda(const Tuning& tuning, MemoryAccount& memory) {
  return std::make_unique<Pineda>(tuning, memory);
}

}  // namespace rastrum::family
