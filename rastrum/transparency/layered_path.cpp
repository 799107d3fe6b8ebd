// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/transparency/layered_path.hpp>

#include <algorithm>
#include <vector>

#include <rastrum/raster/bin/bin_parts.hpp>
#include <rastrum/raster/cull/selection.hpp>
#include <rastrum/raster/frame/bins.hpp>
#include <rastrum/transparency/layers.hpp>

namespace rastrum::transparency {
namespace {

using raster::BinTable;
using raster::Group;
using raster::kBinSize;
using raster::kBlockSize;
using raster::Rect;

/// Bins of layers with more entries are cut into parts of 32², with even more into 16² px (paper
/// 4's future work; there 32² for all), so that threads share dense bins. Each part covers the
/// bin's pieces again: with an eighth of these numbers a brain of a million triangles took 1.3
/// times as long.
constexpr std::size_t kSparseBin = 1 << 16, kDenser = 8;
/// If a bin exceeds a thread's share, bins are cut from fewer entries on, at least these.
constexpr std::size_t kLeastCut = 1 << 11;
/// A part's load beside its entries, in entries: large triangles have few. With 30, too many of
/// sponza's bins went into one task.
constexpr std::uint64_t kPixels = 500;
/// Per piece and block of a region: three times 24, and a key.
constexpr std::uint64_t kRecordBytes = 80;

struct Part {
  std::size_t bin, entries;
  Rect rect;
  int side_px;

  [[nodiscard]] std::uint64_t record_bytes() const {
    const auto across = static_cast<std::uint64_t>(side_px / kBlockSize);
    return entries * across * across * kRecordBytes;
  }
};

/// More than `sparse` entries are dense.
void cut_bin(std::size_t bin, Rect rect, std::size_t entries, std::size_t sparse,
             std::uint64_t most_bytes, std::vector<Part>& parts) {
  int side = entries <= sparse ? kBinSize : entries <= sparse * kDenser ? 32 : 16;
  while (most_bytes != 0 && side > kBlockSize &&
         Part{bin, entries, {}, side}.record_bytes() > most_bytes)
    side /= 2;
  for (int y = rect.y0; y < rect.y1; y += side)
    for (int x = rect.x0; x < rect.x1; x += side)
      parts.push_back(
          {bin, entries, {x, y, std::min(x + side, rect.x1), std::min(y + side, rect.y1)}, side});
}

static_assert(raster::BinWithWindows<LayeredBin>);

class LayeredPath final : public raster::Method {
 public:
  explicit LayeredPath(MemoryAccount& memory)
      : groups_(memory), selection_(memory), bins_(memory) {}

  [[nodiscard]] raster::Needs needs() const override {
    return {.rasterizer = "grouped",
            .visibility = "layers",
            .surface = false,
            .surface_bytes = 0,
            .colors = true,
            .triangle_bytes = 160,
            .expands = true,
            .quadrics = true,
            .whole_view = true,
            .cuts_views = true};
  }

  void draw(raster::FrameRun& frame, std::uint64_t first, std::uint64_t last) override {
    const BinTable lists{{frame.view, kBinSize}};
    // Micro triangles' fragments have one sample per pixel.
    const auto groups = set_up(frame, lists, first, last);
    frame.watch.lap(frame.stats, "setup and bin");
    frame.fits = groups.has_value();
    if (frame.fits) draw_parts(frame, lists, *groups);
  }

  void abandon() override {
    raster::Counters dropped;
    bins_.collect(dropped);
  }

  /// Clusters do not come in the order of submission. Only methods that sort take them, and only if
  /// no output shows how they sorted.
  [[nodiscard]] bool takes_clusters(const raster::FrameRequest& request) const override {
    return request.transparency.method == Transparency::exact && request.targets.errors.empty() &&
           request.samples == 1 && request.sink == nullptr;
  }

 private:
  std::optional<std::span<Group>> set_up(raster::FrameRun& frame, const BinTable& lists,
                                         std::uint64_t first, std::uint64_t last) {
    const bool micro = frame.request.samples == 1;
    if (!raster::has_clusters(frame.request))
      return groups_.set_up(frame, lists, micro, first, last);
    selection_.begin(frame, first, last);
    selection_.choose(frame, false);
    selection_.project(frame, 1);
    return groups_.set_up(frame, lists, micro, selection_.runs());
  }
  void draw_parts(raster::FrameRun& frame, const BinTable& lists, std::span<const Group> groups) {
    const auto threads = static_cast<std::uint64_t>(frame.concurrency());
    const std::uint64_t most_bytes = frame.fragment_bytes / threads / 2;
    const auto entries = [&](std::size_t bin) {
      const raster::BinLoad load = groups_.load(bin);
      return load.pieces + load.fragments;
    };
    std::uint64_t total = 0;
    for (std::size_t bin = 0; bin < lists.bins.count(); ++bin) total += entries(bin);
    const bool few = frame.concurrency() <= raster::kFewThreads;
    const std::size_t sparse =
        few ? kSparseBin : std::clamp<std::size_t>(total / threads, kLeastCut, kSparseBin);
    std::vector<Part> parts;
    for (std::size_t bin = 0; bin < lists.bins.count(); ++bin)
      cut_bin(bin, lists.bins.rect(bin), entries(bin), sparse, most_bytes, parts);
    // Parts beyond a thread's share of the memory limit go one by one.
    const auto alone = std::stable_partition(parts.begin(), parts.end(), [&](const Part& p) {
      return most_bytes == 0 || p.record_bytes() <= most_bytes;
    });
    const auto draw = [&](const Part& part) {
      bins_.draw(frame, lists, groups, part.bin, part.rect, part.side_px);
    };
    if (few) {
      frame.for_each_index(static_cast<std::size_t>(alone - parts.begin()),
                           [&](std::size_t i) { draw(parts[i]); });
    } else {
      // A part's entries are unknown, so its load is its area's share of the bin's.
      std::vector<std::uint64_t> loads;
      for (auto p = parts.begin(); p != alone; ++p)
        loads.push_back(kPixels + p->entries * static_cast<std::uint64_t>(p->side_px * p->side_px) /
                                      (kBinSize * kBinSize));
      order_.arrange(loads, frame.concurrency());
      frame.for_each_in_order(order_.tasks(), [&](std::size_t task) {
        for (const std::uint32_t part : order_.task(task)) draw(parts[part]);
      });
    }
    std::for_each(alone, parts.end(), draw);
    bins_.collect(frame.counters);
    frame.watch.lap(frame.stats, "draw and shade");
  }

  raster::TriangleGroups groups_;
  raster::Selection selection_;
  raster::LoadOrder order_;
  raster::Bins<LayeredBin> bins_;
};

}  // namespace

std::unique_ptr<raster::Method> make_layered_path(MemoryAccount& memory) {
  return std::make_unique<LayeredPath>(memory);
}

}  // namespace rastrum::transparency
