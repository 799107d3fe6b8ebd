#include <rastrum/raster/frame/fast_path.hpp>

#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

#include <rastrum/raster/bin/bin_parts.hpp>
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

  explicit NearestInBin(MemoryAccount& memory) : row_keys_(memory), quadrics_(memory) {}
  void begin(const BinContext& context, const SurfaceView& surface, Rect rect) {
    if (row_keys_.capacity() == 0) {
      row_keys_.reserve(RowKeys::kSize);
      rows_.keys = row_keys_.data();
      std::fill_n(rows_.keys, RowKeys::kSize, 0);
    }
    BinKeys::begin(*context.kernel, surface, rect, context.request->targets.overdraw.empty(),
                   &rows_);
  }
  void deferred(Frame& frame, std::span<const Group> groups, std::size_t bin, Rect rect) {
    frame.fragments.fetch_add(quadrics_.draw(frame.context(), groups, bin, rect, *this),
                              std::memory_order_relaxed);
  }

 private:
  ScratchBuffer<std::uint64_t> row_keys_;
  RowKeys rows_;
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
  [[nodiscard]] bool has(std::uint64_t slot) const { return seen_[slot] != 0; }
  void begin(const Selection& now) {
    fingerprint_ = now.fingerprint();
    slots_ = now.slots();
    seen_.assign(static_cast<std::size_t>(slots_), 0);
  }
  /// Thread-safe for distinct slots.
  void add(std::uint64_t slot) { seen_[slot] = 1; }

 private:
  std::uint64_t fingerprint_ = 0, slots_ = 0;
  std::vector<std::uint8_t> seen_;
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
    // Memory for pairs alone is planned, and drawn in turns.
    const bool small = hides && frame.expansion_bytes == 0 && frame.kernel.raise_small != nullptr;
    const BinTable lists{{frame.view, kBinSize}, hides, hides && has_quadrics, 0, small};
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
    // Quadrics that bins make themselves are made for whole bins.
    parts_.make(frame, lists, groups_, !lists.defers);
    begins_.assign(begins_bins_ ? lists.bins.count() : 0, 0);
    if (begins_bins_)
      for (const BinPart& part : parts_.all())
        if (!part.is_empty && touched_[part.bin] == 0) begins_[part.bin] = 1;
    for (std::size_t bin = 0; bin < begins_.size(); ++bin) touched_[bin] |= begins_[bin];
    parts_.for_each(frame, [&](const BinPart& part) {
      // The keys of a bin begin when the first group has something there.
      if (begins_bins_ && begins_[part.bin] != 0)
        load_keys(frame.request.targets, part.rect, frame.surface_at(part.rect));
      if (!part.is_empty)
        bins_.draw(frame, lists, groups, part.bin, part.rect, part.side_px);
      else if (!frame.has_surface())
        frame.shade_nothing(part.rect);
    });
    bins_.collect(frame.counters);
    frame.watch.lap(frame.stats, frame.has_surface() ? "draw" : "draw and shade");
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
  bool begins_bins_ = false;  ///< keys_ are begun where something is drawn
  BinParts parts_;
  std::vector<std::uint8_t> touched_;  ///< by bin: keys_ have begun there
  std::vector<std::uint8_t> begins_;   ///< and begin with what is drawn now
  bool is_hinted_ = true;              ///< what the last frame saw tells what this one sees
  std::vector<std::uint8_t> later_;    ///< by candidate: 1 is not drawn first, 2 is hidden
  struct OfPart {
    std::size_t runs = 0, first_run = 0;
    std::uint64_t drawn = 0, missed = 0, hidden = 0;
  };
  std::vector<OfPart> of_part_;  ///< of some candidates, one after the other
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
  later_.resize(all.size());
  runs_.reserve(all.size());
  std::size_t count = 0;
  // Asked in parts, so that tasks are large.
  const std::size_t at_once = std::clamp<std::size_t>(
      all.size() / (4 * static_cast<std::size_t>(frame.concurrency())), 64, 1024);
  of_part_.assign((all.size() + at_once - 1) / at_once, {});
  const auto ask = [&](const auto& f) {
    frame.for_each_index(of_part_.size(), [&](std::size_t part) {
      OfPart own;
      for (std::size_t i = part * at_once; i < std::min(all.size(), (part + 1) * at_once); ++i)
        f(i, own);
      of_part_[part] = own;
    });
  };
  // The runs of those that are marked so, in order.
  const auto collect_runs = [&](std::uint8_t mark) {
    for (OfPart& own : of_part_) {
      own.first_run = count;
      count += own.runs;
    }
    frame.for_each_index(of_part_.size(), [&](std::size_t part) {
      std::size_t to = of_part_[part].first_run;
      for (std::size_t i = part * at_once; i < std::min(all.size(), (part + 1) * at_once); ++i)
        if (later_[i] == mark) runs_[to++] = all[i].run;
    });
  };
  ask([&](std::size_t i, OfPart& own) {
    const bool first = knows && is_hinted_ ? seen_.has(all[i].slot) : !all[i].leans_away;
    later_[i] = all[i].run.cluster != SetupRun::kPlain && !first ? 1 : 0;
    own.runs += later_[i] == 0 ? 1U : 0U;
  });
  collect_runs(0);
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

  ask([&](std::size_t i, OfPart& own) {
    if (later_[i] == 1 && depths_.hides(all[i])) later_[i] = 2;
    own.runs += later_[i] == 1 ? 1U : 0U;
  });
  collect_runs(1);
  frame.count("clusters seen later", count);
  if (count != 0) draw();

  // What is hidden behind the whole picture need not be drawn first the next time.
  ask([&](std::size_t i, OfPart& own) {
    if (later_[i] != 2 && depths_.hides(all[i])) later_[i] = 2;
    if (all[i].run.cluster == SetupRun::kPlain) return;
    if (later_[i] == 2) {
      own.hidden += all[i].run.count;
      return;
    }
    ++own.drawn;
    own.missed += knows && !seen_.has(all[i].slot) ? 1U : 0U;
  });
  std::uint64_t drawn = 0, missed = 0, hidden = 0;
  for (const OfPart& own : of_part_) {
    drawn += own.drawn;
    missed += own.missed;
    hidden += own.hidden;
  }
  // A camera that jumped sees others than the last one did.
  is_hinted_ = missed * kWorth < drawn;
  seen_.begin(selection_);
  ask([&](std::size_t i, OfPart&) {
    if (later_[i] != 2 && all[i].run.cluster != SetupRun::kPlain) seen_.add(all[i].slot);
  });
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
