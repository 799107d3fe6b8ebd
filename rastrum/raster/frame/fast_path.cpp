#include <rastrum/raster/frame/fast_path.hpp>

#include <algorithm>

#include <rastrum/raster/cover/bin_keys.hpp>
#include <rastrum/raster/cover/bin_quadrics.hpp>
#include <rastrum/raster/frame/bins.hpp>

namespace rastrum::raster {
namespace {

/// The nearest surface of a bin.
class NearestInBin : public BinKeys {
 public:
  static constexpr bool kColors = false;

  explicit NearestInBin(MemoryAccount& memory) : quadrics_(memory) {}
  void begin(const BinContext& context, const SurfaceView& surface, Rect rect) {
    BinKeys::begin(*context.kernel, surface, rect, context.request->targets.overdraw.empty());
  }
  void deferred(Frame& frame, std::span<const Group> groups, std::size_t bin, Rect rect) {
    frame.fragments.fetch_add(quadrics_.draw(frame.context(), groups, bin, rect, *this),
                              std::memory_order_relaxed);
  }
  static void finish() {}

 private:
  BinQuadrics quadrics_;
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
    // Who counts overdraw wants to see everything.
    const bool hides = frame.request.targets.overdraw.empty();
    const bool has_quadrics = std::ranges::any_of(
        frame.request.draws, [](const Draw& d) { return d.quadrics != nullptr; });
    const BinTable lists{{frame.view, kBinSize}, hides, hides && has_quadrics};
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
