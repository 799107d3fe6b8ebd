#include <rastrum/raster/frame/fast_path.hpp>

#include <rastrum/raster/cover/bin_keys.hpp>
#include <rastrum/raster/frame/bins.hpp>

namespace rastrum::raster {
namespace {

/// The nearest surface of a bin.
class NearestInBin : public BinKeys {
 public:
  static constexpr bool kColors = false;

  explicit NearestInBin(MemoryAccount&) {}
  void begin(const BinContext& context, const SurfaceView& surface, Rect rect) {
    // Who counts overdraw wants to see everything.
    BinKeys::begin(*context.kernel, surface, rect, context.request->targets.overdraw.empty());
  }
  static void finish() {}
};

class FastPath final : public Method {
 public:
  explicit FastPath(MemoryAccount& memory) : groups_(memory), bins_(memory) {}

  [[nodiscard]] Needs needs() const override {
    return {.rasterizer = "grouped",
            .visibility = "atomic",
            .surface = false,
            .triangle_bytes = 160,
            .expands = true,
            .quadrics = true};
  }

  void draw(Frame& frame, std::uint64_t first, std::uint64_t last) override {
    const BinTable lists{{frame.view, kBinSize}, frame.request.targets.overdraw.empty()};
    // Without a limit for the view they always fit.
    const std::span<Group> groups = *groups_.set_up(frame, lists, true, first, last);
    frame.watch.lap(frame.stats, "setup and bin");
    draw_bins(frame, lists, groups);
    while (!TriangleGroups::are_binned(groups)) {
      groups_.bin_more(frame, lists, groups);
      frame.watch.lap(frame.stats, "setup and bin");
      draw_bins(frame, lists, groups);
    }
  }

  void abandon() override {
    Counters dropped;
    bins_.collect(dropped);
  }

 private:
  void draw_bins(Frame& frame, const BinTable& lists, std::span<const Group> groups) {
    frame.for_each_index(lists.bins.count(), [&](std::size_t bin) {
      bins_.draw(frame, lists, groups, bin, lists.bins.rect(bin), kBinSize);
    });
    bins_.collect(frame.counters);
    frame.watch.lap(frame.stats, frame.has_surface() ? "draw" : "draw and shade");
  }

  TriangleGroups groups_;
  Bins<NearestInBin> bins_;
};

}  // namespace

std::unique_ptr<Method> make_fast_path(MemoryAccount& memory) {
  return std::make_unique<FastPath>(memory);
}

}  // namespace rastrum::raster
