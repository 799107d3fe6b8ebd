// SPDX-License-Identifier: BSD-3-Clause
#include <papers/paper1/tiled.hpp>

#include <papers/axes/immediate.hpp>
#include <papers/axes/piece_array.hpp>
#include <papers/paper1/sorted_tiles.hpp>

namespace rastrum::family {
namespace {

class Tiled final : public Coverage {
 public:
  Tiled(const Tuning& tuning, MemoryAccount& memory)
      : sizes_(checked_sizes("tiled", tuning, {}, kBlockSize / 2)), pieces_(memory) {}

  void draw(Frame& frame, std::uint64_t first, std::uint64_t last) override {
    const std::span<const Piece> pieces = pieces_.fill(frame, first, last);
    const auto which = pieces_in_view(frame, pieces);
    frame.watch.lap(frame.stats, "setup");
    draw_sorted_tiles(frame, sizes_, pieces.data(), which);
    frame.watch.lap(frame.stats, frame.has_surface() ? "draw" : "draw and shade");
  }

 private:
  BinSizes sizes_;
  PieceArray pieces_;
};

}  // namespace

std::unique_ptr<Coverage> make_tiled(const Tuning& tuning, MemoryAccount& memory) {
  return std::make_unique<Tiled>(tuning, memory);
}

}  // namespace rastrum::family
