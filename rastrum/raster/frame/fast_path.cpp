#include <rastrum/raster/frame/fast_path.hpp>

#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

#include <rastrum/raster/cover/bin_keys.hpp>
#include <rastrum/raster/cover/bin_quadrics.hpp>
#include <rastrum/raster/cull/depth_map.hpp>
#include <rastrum/raster/cull/selection.hpp>
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

/// Which clusters were seen in the frame before, so that they are drawn first in this one. A hint:
/// whatever it says, all that may be seen is drawn.
class LastSeen {
 public:
  /// Whether something is known of the frame's clusters.
  [[nodiscard]] bool knows(const Selection& now) const {
    return fingerprint_ == now.fingerprint() && slots_ == now.slots();
  }
  [[nodiscard]] bool has(std::uint64_t slot) const {
    return (bits_[slot / 64] >> slot % 64 & 1) != 0;
  }
  void begin(const Selection& now) {
    fingerprint_ = now.fingerprint();
    slots_ = now.slots();
    bits_.assign(static_cast<std::size_t>((slots_ + 63) / 64), 0);
  }
  void add(std::uint64_t slot) { bits_[slot / 64] |= std::uint64_t{1} << slot % 64; }

 private:
  std::uint64_t fingerprint_ = 0, slots_ = 0;
  std::vector<std::uint64_t> bits_;
};

class FastPath final : public Method {
 public:
  explicit FastPath(MemoryAccount& memory)
      : groups_(memory),
        bins_(memory),
        selection_(memory),
        depths_(memory),
        keys_(memory),
        runs_(memory) {}

  [[nodiscard]] Needs needs() const override {
    return {.rasterizer = "grouped",
            .visibility = "atomic",
            .surface = false,
            .triangle_bytes = 160,
            .expands = true,
            .quadrics = true};
  }
  [[nodiscard]] bool takes_clusters(const FrameRequest& /*request*/) const override { return true; }

  void draw(Frame& frame, std::uint64_t first, std::uint64_t last) override {
    // Who counts overdraw wants to see everything.
    const bool hides = frame.request.targets.overdraw.empty();
    const bool has_quadrics = std::ranges::any_of(
        frame.request.draws, [](const Draw& d) { return d.quadrics != nullptr; });
    const BinTable lists{{frame.view, kBinSize}, hides, hides && has_quadrics};
    if (has_clusters(frame.request)) {
      selection_.choose(frame, first, last);
      frame.watch.lap(frame.stats, "choose");
      if (hides && is_worth_a_look()) return draw_what_is_seen(frame, lists);
      draw_groups(frame, lists, *groups_.set_up(frame, lists, true, selection_.runs()));
      return;
    }
    // Without a limit for the view they always fit.
    draw_groups(frame, lists, *groups_.set_up(frame, lists, true, first, last));
  }

  void abandon() override {
    begins_bins_ = false;
    Counters dropped;
    bins_.collect(dropped);
  }

 private:
  void draw_groups(Frame& frame, const BinTable& lists, std::span<Group> groups) {
    frame.watch.lap(frame.stats, "setup and bin");
    draw_bins(frame, lists, groups);
    while (!TriangleGroups::are_binned(groups)) {
      groups_.bin_more(frame, lists, groups);
      frame.watch.lap(frame.stats, "setup and bin");
      draw_bins(frame, lists, groups);
    }
  }
  void draw_bins(Frame& frame, const BinTable& lists, std::span<const Group> groups) {
    frame.for_each_index(lists.bins.count(), [&](std::size_t bin) {
      if (begins_bins_) begin_bin(frame, lists, groups, bin);
      bins_.draw(frame, lists, groups, bin, lists.bins.rect(bin), kBinSize);
    });
    bins_.collect(frame.counters);
    frame.watch.lap(frame.stats, frame.has_surface() ? "draw" : "draw and shade");
  }

  /// Begins the keys of a bin when the first group has something there.
  void begin_bin(Frame& frame, const BinTable& lists, std::span<const Group> groups,
                 std::size_t bin) {
    if (touched_[bin] != 0 ||
        std::ranges::all_of(groups, [&](const Group& g) { return g.is_empty(lists, bin); }))
      return;
    touched_[bin] = 1;
    const Rect r = lists.bins.rect(bin);
    load_keys(frame.request.targets, r, frame.surface_at(r));
  }

  /// Whether to look for hidden clusters: there are so many triangles that it can pay, and where it
  /// did not in the frame that last looked, only now and then.
  bool is_worth_a_look() {
    if (selection_.always()) return true;
    if (selection_.triangles() < kLeastTriangles) return false;
    if (!seen_.knows(selection_)) wait_ = 0;
    return wait_ == 0 || --wait_ == 0;
  }
  void draw_what_is_seen(Frame& frame, const BinTable& lists);

  /// Fewer triangles are set up sooner than keys of a picture are kept.
  static constexpr std::uint64_t kLeastTriangles = 50'000;
  /// Frames that do not look after one that found too little: to keep keys for so many pixels and
  /// look at them costs as much as to set up a triangle.
  static constexpr int kWait = 15;
  static constexpr std::uint64_t kPixelsOfTriangle = 16;
  /// Where more than this part of what is seen was not seen before, which clusters face the viewer
  /// is the better hint.
  static constexpr std::uint64_t kWorth = 8;

  TriangleGroups groups_;
  Bins<NearestInBin> bins_;
  Selection selection_;
  LastSeen seen_;
  int wait_ = 0;
  DepthMap depths_;
  ScratchBuffer<std::uint64_t> keys_;  ///< of the view, where the driver keeps none
  ScratchBuffer<SetupRun> runs_;
  bool begins_bins_ = false;           ///< keys_ are begun where something is drawn
  std::vector<std::uint8_t> touched_;  ///< by bin: keys_ have begun there
  bool is_hinted_ = true;              ///< what the last frame saw tells what this one sees
  std::vector<std::uint8_t> later_;    ///< by candidate: 1 is not drawn first, 2 is hidden
};

/// Two passes: what the last frame saw, and what is not hidden by that (Greene, Kass and Miller,
/// 1993). Keys are kept for the whole view between them.
void FastPath::draw_what_is_seen(Frame& frame, const BinTable& lists) {
  const std::span<const Candidate> all = selection_.candidates();
  const bool knows = seen_.knows(selection_);
  const bool own_surface = !frame.has_surface();
  const auto each_bin = [&](const auto& f) {
    frame.for_each_index(lists.bins.count(), [&](std::size_t bin) {
      const Rect r = lists.bins.rect(bin);
      f(bin, r, frame.surface_at(r));
    });
  };
  if (own_surface) {
    keys_.reserve(lists.bins.count() * kBlocksPerBin * 64);
    frame.surface.keys = keys_.data();
    frame.bin_columns = lists.bins.columns();
  }
  // A pass that loads has keys everywhere; else bins begin when something comes.
  const bool loads = frame.request.targets.load;
  touched_.assign(lists.bins.count(), own_surface && !loads ? 0 : 1);
  if (own_surface && loads)
    each_bin([&](std::size_t, Rect r, const SurfaceView& s) {
      load_keys(frame.request.targets, r, s, frame.request.part.value_or(Rect{}));
    });
  begins_bins_ = own_surface && !loads;
  later_.assign(all.size(), 0);
  runs_.reserve(all.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool first = knows && is_hinted_ ? seen_.has(all[i].slot) : !all[i].leans_away;
    if (all[i].run.cluster != SetupRun::kPlain && !first)
      later_[i] = 1;
    else
      runs_[count++] = all[i].run;
  }
  depths_.begin(frame.view);
  const auto draw = [&] {
    draw_groups(frame, lists,
                *groups_.set_up(frame, lists, true, {runs_.data(), std::exchange(count, 0)}));
    each_bin([&](std::size_t bin, Rect r, const SurfaceView& s) {
      if (touched_[bin] != 0) depths_.look(frame.kernel, s, r);
    });
    frame.watch.lap(frame.stats, "look");
  };
  draw();

  // Asked in parts, so that tasks are large.
  constexpr std::size_t kAtOnce = 1024;
  const auto ask = [&](const auto& f) {
    frame.for_each_index((all.size() + kAtOnce - 1) / kAtOnce, [&](std::size_t part) {
      for (std::size_t i = part * kAtOnce; i < std::min(all.size(), (part + 1) * kAtOnce); ++i)
        f(i);
    });
  };
  ask([&](std::size_t i) {
    if (later_[i] == 1 && depths_.hides(all[i])) later_[i] = 2;
  });
  for (std::size_t i = 0; i < all.size(); ++i)
    if (later_[i] == 1) runs_[count++] = all[i].run;
  frame.count("clusters seen later", count);
  if (count != 0) draw();

  // What is hidden behind the whole picture need not be drawn first the next time.
  ask([&](std::size_t i) {
    if (later_[i] != 2 && depths_.hides(all[i])) later_[i] = 2;
  });
  std::size_t drawn = 0, missed = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (later_[i] == 2 || all[i].run.cluster == SetupRun::kPlain) continue;
    ++drawn;
    missed += knows && !seen_.has(all[i].slot) ? 1U : 0U;
  }
  // A camera that jumped sees others than the last one did.
  is_hinted_ = missed * kWorth < drawn;
  seen_.begin(selection_);
  std::uint64_t hidden = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].run.cluster == SetupRun::kPlain) continue;
    if (later_[i] == 2)
      hidden += all[i].run.count;
    else
      seen_.add(all[i].slot);
  }
  frame.count("triangles of hidden clusters", hidden);
  std::uint64_t pixels = 0;
  for (const std::uint8_t t : touched_) pixels += t * std::uint64_t{kBinSize * kBinSize};
  wait_ = hidden * kPixelsOfTriangle < pixels ? kWait : 0;
  begins_bins_ = false;
  if (!own_surface) return;
  each_bin([&](std::size_t bin, Rect r, const SurfaceView& s) {
    if (touched_[bin] != 0)
      frame.shade(s, r);
    else
      frame.shade_nothing(r);
  });
  frame.surface = {};
  frame.bin_columns = 0;
  frame.watch.lap(frame.stats, "shade");
}

}  // namespace

std::unique_ptr<Method> make_fast_path(MemoryAccount& memory) {
  return std::make_unique<FastPath>(memory);
}

}  // namespace rastrum::raster
