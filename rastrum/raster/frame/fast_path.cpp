// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/frame/fast_path.hpp>

#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

#include <rastrum/raster/bin/bin_parts.hpp>
#include <rastrum/raster/bin/bin_quadrics.hpp>
#include <rastrum/raster/cover/bin_keys.hpp>
#include <rastrum/raster/cull/seen_first.hpp>
#include <rastrum/raster/frame/bins.hpp>

namespace rastrum::raster {
namespace {

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
    BinKeys::begin(*context.kernel, surface, rect, context.plan->hides, &rows_);
  }
  void deferred(FrameRun& frame, std::span<const Group> groups, std::size_t bin, Rect rect) {
    frame.fragments.fetch_add(quadrics_.draw(frame.context(), groups, bin, rect, *this),
                              std::memory_order_relaxed);
  }

 private:
  ScratchBuffer<std::uint64_t> row_keys_;
  RowKeys rows_;
  BinQuadrics quadrics_;
};
static_assert(BinWithRows<NearestInBin> && BinWithSurface<NearestInBin> &&
              BinWithDeferred<NearestInBin>);

class FastPath final : public Method {
 public:
  explicit FastPath(MemoryAccount& memory)
      : groups_(memory), bins_(memory), clusters_(memory), keys_(memory) {}

  [[nodiscard]] Needs needs() const override {
    return {.rasterizer = "grouped",
            .visibility = "atomic",
            .surface = false,
            .triangle_bytes = 160,
            .expands = true,
            .quadrics = true};
  }
  [[nodiscard]] bool takes_clusters(const FrameRequest& /*request*/) const override { return true; }

  void draw(FrameRun& frame, std::uint64_t first, std::uint64_t last) override {
    const bool hides = frame.plan.hides;
    // A memory limit plans only for pairs, which can be drawn in turns, so it rules out lists of
    // small triangles.
    const bool small = hides && frame.expansion_bytes == 0 && frame.kernel.raise_small != nullptr;
    const BinTable lists{
        {frame.view, kBinSize}, hides, hides && frame.request.has_quadrics(), 0, small};
    const bool by_clusters = has_clusters(frame.request);
    if (by_clusters && clusters_.choose(frame, first, last, hides))
      return draw_what_is_seen(frame, lists);
    // Without a limit for the view the groups always fit.
    const auto groups = by_clusters ? groups_.set_up(frame, lists, true, clusters_.all())
                                    : groups_.set_up(frame, lists, true, first, last);
    draw_groups(frame, lists, *groups, frame.has_surface() ? "draw" : "draw and shade",
                [](const BinPart&) {});
  }

  void abandon() override {
    begins_bins_ = false;
    Counters dropped;
    bins_.collect(dropped);
  }

 private:
  /// Calls then(part) after each part of a bin, more than once where memory is planned.
  template <class Then>
  void draw_groups(FrameRun& frame, const BinTable& lists, std::span<Group> groups,
                   const char* stage, const Then& then) {
    frame.watch.lap(frame.stats, "setup and bin");
    draw_bins(frame, lists, groups, stage, then);
    while (!TriangleGroups::are_binned(groups)) {
      groups_.bin_more(frame, lists, groups);
      frame.watch.lap(frame.stats, "setup and bin");
      draw_bins(frame, lists, groups, stage, then);
    }
  }
  template <class Then>
  void draw_bins(FrameRun& frame, const BinTable& lists, std::span<const Group> groups,
                 const char* stage, const Then& then) {
    // A bin that makes quadrics itself makes them whole, so it is not cut.
    parts_.make(frame, lists, groups_, !lists.defers);
    begins_.assign(begins_bins_ ? lists.bins.count() : 0, 0);
    if (begins_bins_)
      for (const BinPart& part : parts_.all())
        if (!part.is_empty && touched_[part.bin] == 0) begins_[part.bin] = 1;
    for (std::size_t bin = 0; bin < begins_.size(); ++bin) touched_[bin] |= begins_[bin];
    parts_.for_each(frame, [&](const BinPart& part) {
      // A bin's keys begin when the first group draws there.
      if (begins_bins_ && begins_[part.bin] != 0)
        load_keys(frame.request, part.rect, frame.surface_at(part.rect));
      if (!part.is_empty)
        bins_.draw(frame, lists, groups, part.bin, part.rect, part.side_px);
      else if (!frame.has_surface())
        frame.shade_nothing(part.rect);
      then(part);
    });
    bins_.collect(frame.counters);
    frame.watch.lap(frame.stats, stage);
  }

  void draw_what_is_seen(FrameRun& frame, const BinTable& lists);

  /// Keeping and testing keys of so many pixels costs as much as drawing a hidden triangle.
  static constexpr std::uint64_t kPixelsOfTriangle = 7;

  TriangleGroups groups_;
  Bins<NearestInBin> bins_;
  SeenFirst clusters_;
  ScratchBuffer<std::uint64_t> keys_;  ///< of the view, where the driver has none
  bool begins_bins_ = false;           ///< keys_ begin where something is drawn
  BinParts parts_;
  std::vector<std::uint8_t> touched_;  ///< by bin: keys_ have begun there
  std::vector<std::uint8_t> begins_;   ///< they begin with the current groups
};

/// Two passes (SeenFirst), with keys of the whole view kept between them.
void FastPath::draw_what_is_seen(FrameRun& frame, const BinTable& lists) {
  const bool own_surface = !frame.has_surface();
  if (own_surface) {
    keys_.reserve(lists.bins.count() * kBlocksPerBin * 64);
    frame.surface.keys = keys_.data();
    frame.bin_columns = lists.bins.columns();
  }
  // A pass that loads has keys everywhere. Otherwise a bin's keys begin with its first draw.
  const bool loads = frame.request.pass.load;
  touched_.assign(lists.bins.count(), own_surface && !loads ? 0 : 1);
  if (own_surface && loads)
    frame.for_each_index(lists.bins.count(), [&](std::size_t bin) {
      const Rect r = lists.bins.rect(bin);
      load_keys(frame.request, r, frame.surface_at(r));
    });
  begins_bins_ = own_surface && !loads;
  const auto draw = [&](std::span<const SetupRun> runs, const char* stage, const auto& then) {
    draw_groups(frame, lists, *groups_.set_up(frame, lists, true, runs), stage, then);
  };
  const auto look = [&](const BinPart& part) {
    clusters_.depths().look(frame.kernel, frame.surface_at(part.rect), part.rect);
  };
  const auto shade = [&](const BinPart& part) {
    if (touched_[part.bin] != 0)
      frame.shade(frame.surface_at(part.rect), part.rect);
    else
      frame.shade_nothing(part.rect);
  };
  draw(clusters_.first(frame), "draw", [&](const BinPart& part) {
    if (touched_[part.bin] != 0) look(part);
  });
  // Shades a part while its keys are in cache, unless more may be drawn there.
  const bool shades = own_surface && !frame.plans_memory();
  draw(clusters_.rest(frame), shades ? "draw and shade" : "draw", [&](const BinPart& part) {
    if (!part.is_empty) look(part);
    if (shades) shade(part);
  });
  std::uint64_t pixels = 0;
  for (const std::uint8_t t : touched_) pixels += t * std::uint64_t{kBinSize * kBinSize};
  clusters_.finish(frame, pixels / kPixelsOfTriangle);
  begins_bins_ = false;
  if (!own_surface) return;
  if (!shades) {
    parts_.for_each(frame, shade);
    frame.watch.lap(frame.stats, "shade");
  }
  frame.surface = {};
  frame.bin_columns = 0;
}

}  // namespace

std::unique_ptr<Method> make_fast_path(MemoryAccount& memory) {
  return std::make_unique<FastPath>(memory);
}

}  // namespace rastrum::raster
