// SPDX-License-Identifier: BSD-3-Clause
#include <papers/table/grouped.hpp>

#include <rastrum/error.hpp>
#include <rastrum/raster/bin/groups.hpp>

namespace rastrum::family {
namespace {

class Grouped final : public Coverage {
 public:
  explicit Grouped(MemoryAccount& memory) : groups_(memory) {}

  void draw(Frame& frame, std::uint64_t first, std::uint64_t last) override {
    const BinTable lists{{frame.view, kBinSize}, frame.visibility.hides && frame.hides};
    // set_up always returns groups here: the view has no limit of its own.
    const std::span<Group> groups =
        *groups_.set_up(frame.base, lists, frame.visibility.takes_fragments, first, last);
    frame.watch.lap(frame.stats, "setup and bin");
    draw_bins(frame, lists, groups);
    while (!TriangleGroups::are_binned(groups)) {
      groups_.bin_more(frame.base, lists, groups);
      frame.watch.lap(frame.stats, "setup and bin");
      draw_bins(frame, lists, groups);
    }
  }

 private:
  static void draw_bins(Frame& frame, const BinTable& lists, std::span<const Group> groups) {
    draw_tiles(
        frame, lists.bins,
        [&](std::size_t bin) {
          return std::ranges::all_of(groups,
                                     [&](const Group& g) { return g.is_empty(lists, bin); });
        },
        [&](std::size_t bin, Emitter& emitter) {
          enumerate_bin(frame.base, lists, groups, bin, lists.bins.rect(bin), emitter);
        });
    frame.watch.lap(frame.stats, frame.has_surface() ? "draw" : "draw and shade");
  }

  TriangleGroups groups_;
};

}  // namespace

std::unique_ptr<Coverage> make_grouped(const Tuning& tuning, MemoryAccount& memory) {
  if ((tuning.bin_px != 0 && tuning.bin_px != kBinSize) ||
      (tuning.tile_px != 0 && tuning.tile_px != kBlockSize))
    throw Error(Errc::invalid_argument, "'grouped' has bins of 64 and tiles of 8 px");
  return std::make_unique<Grouped>(memory);
}

}  // namespace rastrum::family
