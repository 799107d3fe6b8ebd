#include <rastrum/family/coverage/tiled.hpp>

#include <rastrum/family/coverage/immediate.hpp>
#include <rastrum/family/coverage/sorted_tiles.hpp>
#include <rastrum/family/piece_array.hpp>

namespace rastrum::family {
namespace {

template <int kBin, int kTile>
class Tiled final : public Coverage {
 public:
  Tiled(const Tuning&, MemoryAccount& memory) : pieces_(memory) {}

  void draw(Frame& frame, std::uint64_t first, std::uint64_t last) override {
    const std::span<const Piece> pieces = pieces_.fill(frame, first, last);
    const auto which = pieces_in_view(frame, pieces);
    frame.watch.lap(frame.stats, "setup");
    draw_sorted_tiles<kBin, kTile>(frame, pieces.data(), which);
    frame.watch.lap(frame.stats, frame.has_surface() ? "draw" : "draw and shade");
  }

 private:
  PieceArray pieces_;
};

}  // namespace

std::unique_ptr<Coverage> make_tiled(const Tuning& tuning, MemoryAccount& memory) {
  return make_with_tiles<Tiled>("tiled", tuning, memory);
}

}  // namespace rastrum::family
