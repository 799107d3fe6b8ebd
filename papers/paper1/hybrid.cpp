// SPDX-License-Identifier: BSD-3-Clause
#include <papers/paper1/hybrid.hpp>

#include <papers/axes/immediate.hpp>
#include <papers/axes/piece_array.hpp>
#include <papers/paper1/scanline.hpp>
#include <papers/paper1/sorted_tiles.hpp>

namespace rastrum::family {
namespace {

class Hybrid final : public Coverage {
 public:
  Hybrid(const Tuning& tuning, MemoryAccount& memory)
      : draw_small_(tuning.small_path == SmallPath::rows ? draw_scanlines : draw_box_blocks),
        sizes_(checked_sizes("hybrid", tuning, {}, kBlockSize / 2)),
        pieces_(memory) {}

  void draw(Frame& frame, std::uint64_t first, std::uint64_t last) override {
    const std::span<const Piece> pieces = pieces_.fill(frame, first, last);
    const auto parted = small_pieces_first(frame, pieces);
    const std::span<const std::uint32_t> all = parted.elements;
    frame.watch.lap(frame.stats, "setup");
    draw_small_(frame, pieces.data(), all.first(parted.first_count));
    frame.watch.lap(frame.stats, "small");
    draw_sorted_tiles(frame, sizes_, pieces.data(), all.subspan(parted.first_count));
    frame.watch.lap(frame.stats, "large");
  }

 private:
  void (*draw_small_)(Frame&, const Piece*, std::span<const std::uint32_t>);
  BinSizes sizes_;
  PieceArray pieces_;
};

}  // namespace

std::unique_ptr<Coverage> make_hybrid(const Tuning& tuning, MemoryAccount& memory) {
  return std::make_unique<Hybrid>(tuning, memory);
}

}  // namespace rastrum::family
