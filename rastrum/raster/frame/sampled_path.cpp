// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/frame/sampled_path.hpp>

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include <rastrum/parallel/scratch.hpp>
#include <rastrum/raster/bin/bin_parts.hpp>
#include <rastrum/raster/bin/groups.hpp>
#include <rastrum/raster/cull/seen_first.hpp>
#include <rastrum/raster/frame/frame_run.hpp>
#include <rastrum/raster/frame/tile_surface.hpp>
#include <rastrum/raster/resolve/sampled_colors.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::raster {
namespace {

/// Keeping and testing keys of so many samples costs as much as drawing a hidden triangle.
constexpr std::uint64_t kSamplesOfTriangle = 12;
/// Finding a bin's depth bounds costs, for each block, about as much as drawing ten triangles.
constexpr std::size_t kLookAfter = 512;

/// The nearest surfaces of a bin at all samples, for one thread.
class SampledBin {
 public:
  explicit SampledBin(MemoryAccount& memory) : tile_(memory), memory_(memory) {}

  void draw(FrameRun& frame, const BinTable& lists, std::span<const Group> groups,
            std::size_t bin) {
    const Rect rect = lists.bins.rect(bin);
    const bool is_empty =
        std::ranges::all_of(groups, [&](const Group& group) { return group.is_empty(lists, bin); });
    if (is_empty && !frame.has_surface()) return frame.shade_nothing(rect);
    if (is_empty) return;
    memory_.reserve(keys_size(frame));
    begin(frame, rect, memory_.data());
    clear();
    raise(frame, lists, groups, bin);
    finish(frame);
  }
  [[nodiscard]] static std::size_t keys_size(const FrameRun& frame) {
    return static_cast<std::size_t>(frame.request.samples) / 4 * SampledKeys::kFour;
  }
  /// The same in steps, into keys that the caller keeps: what groups have in a bin, first or after
  /// earlier groups. Updates `depths`.
  void raise(FrameRun& frame, const BinTable& lists, std::span<const Group> groups, std::size_t bin,
             std::uint64_t* keys, bool is_first, DepthMap& depths) {
    const Rect rect = lists.bins.rect(bin);
    begin(frame, rect, keys);
    if (is_first)
      clear();
    else
      depths.recall(bounds_, rect);
    raise(frame, lists, groups, bin);
    look(frame);
    depths.look(bounds_, rect);
  }
  void finish(FrameRun& frame, Rect rect, std::uint64_t* keys) {
    begin(frame, rect, keys);
    finish(frame);
  }
  void collect(Counters& counters) {
    add_counter(counters, "hidden pieces", std::exchange(bounds_.hidden_pieces, 0));
    add_counter(counters, "hidden blocks", std::exchange(bounds_.hidden_blocks, 0));
  }

 private:
  void raise(FrameRun& frame, const BinTable& lists, std::span<const Group> groups,
             std::size_t bin) {
    for (const Group& group : groups) raise_fragments(frame, group.fragments.bin(bin));
    for (const Group& group : groups) raise(frame, group, group.by_bin.bin(bin));
    std::size_t later = 0;
    if (lists.two)
      for (const Group& group : groups) later += group.by_bin.bin(lists.later(bin)).size();
    if (later >= kWorthALook) look(frame);
    if (later != 0)
      for (const Group& group : groups) raise(frame, group, group.by_bin.bin(lists.later(bin)));
  }
  void finish(FrameRun& frame) {
    const bool local = !frame.has_surface();
    const SurfaceView surface =
        local ? tile_.begin(frame.request, rect_, kBinSize, true)
              : frame.surface.part(rect_.x0 / kBlockSize, rect_.y0 / kBlockSize);
    resolve(surface);
    if (local) frame.shade(surface, rect_);
  }
  void begin(FrameRun& frame, Rect rect, std::uint64_t* keys) {
    context_ = frame.context();
    rect_ = rect;
    keys_.x0 = rect.x0;
    keys_.y0 = rect.y0;
    keys_.samples = sample_offsets(frame.request.samples);
    keys_.has_places = keys_.samples.size() == 4 && has_small_ids(frame);
    keys_.keys = keys;
    colors_.begin();
    bounds_.restart();
    seen_ = 0;
    // Blocks outside of the image count as full, so nothing is drawn there.
    for (int i = 0; i < kBlocksPerBin; ++i)
      if (i % kBlocksPerBinRow >= block_columns(rect) || i / kBlocksPerBinRow >= block_rows(rect))
        bounds_.block[i] = 1;
  }
  void clear() {
    // Rows of whole blocks, since whole blocks are read.
    const std::size_t rows = static_cast<std::size_t>(block_rows(rect_)) * kBlockSize;
    for (std::size_t k = 0; k < keys_.samples.size() / 4; ++k)
      std::fill_n(keys_.keys + k * SampledKeys::kFour, rows * SampledKeys::kRow, std::uint64_t{0});
  }
  static bool has_small_ids(const FrameRun& frame) {
    const Draw& last = frame.request.draws.back();
    return last.first_id + last.primitive_count <= SampledKeys::kPlacedIds;
  }
  void look(const FrameRun& frame) {
    seen_ = 0;
    frame.kernel.find_sampled_bounds(keys_, rect_, bounds_);
  }
  /// Points cover all samples of their pixels.
  void raise_fragments(FrameRun& frame, std::span<const BinFragment> fragments) {
    for (std::size_t s = 0; s < keys_.samples.size() && !fragments.empty(); ++s) {
      frame.count_fragments(rect_, fragments);
      for (const BinFragment& f : fragments) {
        std::uint64_t& key = keys_.at(rect_.x0 + column_in_bin(f), rect_.y0 + row_in_bin(f), s);
        key = std::max(key, (f.key & ~kIdMask) | keys_.low(f.key & kIdMask, 0));
      }
    }
  }
  void raise(FrameRun& frame, const Group& group, std::span<const PieceInBin> list) {
    const PieceList pieces{group.pieces.data.data(), list.data(), list.size()};
    const bool counts = !frame.plan.hides;
    for (std::size_t first = 0; first < list.size();) {
      throw_if_stopped();
      const std::size_t end = std::min(first + kLookAfter, list.size());
      if (!counts)
        frame.fragments.fetch_add(
            frame.kernel.raise_samples(pieces, first, end, rect_, keys_, &bounds_),
            std::memory_order_relaxed);
      for (std::size_t i = first; i < end; ++i) {
        const Piece& piece = pieces.pieces[list[i].piece];
        if (!counts && is_raised_at_once(piece)) continue;
        others_[other_count_++] = piece;
        if (other_count_ == std::size(others_)) raise_others(frame);
      }
      seen_ += end - first;
      first = end;
      if (!counts && seen_ >= kLookAfter && first < list.size()) look(frame);
    }
    raise_others(frame);
  }
  /// Raises keys by all other pieces (tested, counted, no triangles), by sample and block.
  void raise_others(FrameRun& frame) {
    const std::size_t count = std::exchange(other_count_, 0);
    for (std::size_t s = 0; s < keys_.samples.size() && count != 0; ++s) {
      const int sample = static_cast<int>(s);
      std::size_t n = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const Piece& piece = others_[i];
        const bool of_all = (piece.flags & kAllSamples) != 0;
        if (!of_all && sample_of(piece) != sample) continue;
        moved_[n] = of_all ? piece_at(piece, sample, keys_.samples[s]) : piece;
        list_[n] = {0, static_cast<std::uint32_t>(n)};
        ++n;
      }
      const PieceList pieces{moved_, list_, n};
      DepthBounds* const bounds = frame.plan.hides ? &bounds_ : nullptr;
      for (std::size_t cursor = 0; cursor < n;) {
        const std::size_t written =
            frame.kernel.cover(pieces, cursor, rect_, blocks_, std::size(blocks_), bounds, nullptr);
        const std::span<Block> blocks(blocks_, written);
        frame.count_fragments(blocks);
        for (const Block& block : blocks) raise_block(s, moved_[block.piece], block);
      }
    }
  }
  void raise_block(std::size_t sample, const Piece& piece, Block block) {
    if (block.mask == 0) return;
    alignas(64) std::uint64_t own[64];
    Piece placed = piece;
    placed.low = keys_.low(piece.low, SampledKeys::kUnknownPlace);
    context_.kernel->keys(placed, block, own);
    std::uint64_t* const first = &keys_.at(block.bx * kBlockSize, block.by * kBlockSize, sample);
    const auto key = [first](std::size_t i) -> std::uint64_t& {
      return first[i / kBlockSize * SampledKeys::kRow + i % kBlockSize * 4];
    };
    const auto for_each = [](std::uint64_t mask, const auto& f) {
      for (; mask != 0; mask &= mask - 1) f(static_cast<std::size_t>(std::countr_zero(mask)));
    };
    std::uint64_t nearer = 0;
    for_each(block.mask, [&](std::size_t i) { nearer |= std::uint64_t{own[i] > key(i)} << i; });
    block.mask = nearer;
    if (nearer != 0 && context_.plan->tests && (piece.flags & kMayDrop) != 0)
      block.mask = colors_.test(context_, piece, block);
    for_each(block.mask, [&](std::size_t i) { key(i) = own[i]; });
  }
  void resolve(const SurfaceView& surface) {
    for (int by = rect_.y0 / kBlockSize; by * kBlockSize < rect_.y1; ++by)
      for (int bx = rect_.x0 / kBlockSize; bx * kBlockSize < rect_.x1; ++bx)
        colors_.resolve(context_, keys_, bx, by, surface.block(bx, by), *surface.colors_of(bx, by));
    if (context_.plan->translucent != Translucent::blended) hand_on();
  }
  /// For a sink that takes keys.
  void hand_on() {
    alignas(64) std::uint64_t plane[64];
    for (int by = rect_.y0 / kBlockSize; by * kBlockSize < rect_.y1; ++by)
      for (int bx = rect_.x0 / kBlockSize; bx * kBlockSize < rect_.x1; ++bx) {
        const std::uint64_t inside = samples_inside(rect_, bx, by);
        for (std::size_t s = 0; s < keys_.samples.size(); ++s) {
          std::uint64_t mask = 0;
          for (int i = 0; i < 64; ++i) {
            const int x = bx * kBlockSize + i % kBlockSize, y = by * kBlockSize + i / kBlockSize;
            const std::uint64_t key = keys_.at(x, y, s);
            mask |= std::uint64_t{key != 0} << i;
            plane[i] = key == 0 ? 0 : keys_.plain(key);
          }
          if (mask &= inside; mask != 0)
            context_.request->sink->take({bx, by, plane, mask, nullptr, static_cast<int>(s), true});
        }
      }
  }

  TileSurface tile_;
  ScratchBuffer<std::uint64_t> memory_;
  BinContext context_;
  Rect rect_;
  SampledKeys keys_;
  DepthBounds bounds_;
  std::size_t seen_ = 0;  ///< pieces since the bounds were found
  SampledColors colors_;
  alignas(64) Block blocks_[kBlockCapacity];
  std::size_t other_count_ = 0;
  Piece others_[64], moved_[64];
  PieceInBin list_[64];
};

class SampledPath final : public Method {
 public:
  explicit SampledPath(MemoryAccount& memory)
      : groups_(memory),
        clusters_(memory),
        keys_(memory),
        bins_([&memory] { return SampledBin(memory); }) {}

  [[nodiscard]] Needs needs() const override {
    return {.rasterizer = "grouped",
            .visibility = "samples",
            .surface = false,
            .surface_bytes = 0,
            .colors = true,
            .triangle_bytes = 160,
            .expands = true,
            .quadrics = true,  // that is, round points
            .whole_view = true,
            .cuts_views = true};
  }

  void draw(FrameRun& frame, std::uint64_t first, std::uint64_t last) override {
    const bool hides = frame.plan.hides;
    const BinTable lists{
        {frame.view, kBinSize}, hides, false, reach_of(sample_offsets(frame.request.samples))};
    const bool by_clusters = has_clusters(frame.request);
    if (by_clusters && clusters_.choose(frame, first, last, hides && may_keep_keys(frame, lists)))
      return draw_what_is_seen(frame, lists);
    const auto groups = by_clusters ? groups_.set_up(frame, lists, true, clusters_.all())
                                    : groups_.set_up(frame, lists, true, first, last);
    frame.watch.lap(frame.stats, "setup and bin");
    frame.fits = groups.has_value();
    if (!frame.fits) return;
    parts_.make(frame, lists, groups_, false);
    parts_.for_each(
        frame, [&](const BinPart& part) { bins_.local().draw(frame, lists, *groups, part.bin); });
    collect(frame.counters);
    frame.watch.lap(frame.stats, "draw and shade");
  }

  void abandon() override {
    Counters dropped;
    collect(dropped);
  }

  [[nodiscard]] bool takes_clusters(const FrameRequest& /*request*/) const override { return true; }

 private:
  /// Whether keys of the whole view may be kept for two passes: in pictures of usual size without
  /// planned memory.
  static bool may_keep_keys(const FrameRun& frame, const BinTable& lists) {
    constexpr std::uint64_t kMostKeys = (std::uint64_t{1} << 30) / sizeof(std::uint64_t);
    return frame.view_bytes == 0 && lists.bins.count() <= kMostKeys / SampledBin::keys_size(frame);
  }

  void draw_what_is_seen(FrameRun& frame, const BinTable& lists) {
    const std::size_t size = SampledBin::keys_size(frame);
    keys_.reserve(lists.bins.count() * size);
    touched_.assign(lists.bins.count(), 0);
    std::span<const Group> groups;
    const auto set_up = [&](std::span<const SetupRun> runs) {
      groups = *groups_.set_up(frame, lists, true, runs);
      frame.watch.lap(frame.stats, "setup and bin");
      parts_.make(frame, lists, groups_, false);
    };
    const auto raise = [&](const BinPart& part) {
      if (part.is_empty) return;
      const bool is_first = std::exchange(touched_[part.bin], 1) == 0;
      bins_.local().raise(frame, lists, groups, part.bin, keys_.data() + part.bin * size, is_first,
                          clusters_.depths());
    };
    set_up(clusters_.first(frame));
    parts_.for_each(frame, raise);
    frame.watch.lap(frame.stats, "draw");
    set_up(clusters_.rest(frame));
    parts_.for_each(frame, [&](const BinPart& part) {
      raise(part);
      if (touched_[part.bin] != 0)
        bins_.local().finish(frame, part.rect, keys_.data() + part.bin * size);
      else if (!frame.has_surface())
        frame.shade_nothing(part.rect);
    });
    const auto drawn = static_cast<std::uint64_t>(std::ranges::count(touched_, 1));
    const auto samples =
        drawn * kBinSize * kBinSize * static_cast<std::uint64_t>(frame.request.samples);
    clusters_.finish(frame, samples / kSamplesOfTriangle);
    collect(frame.counters);
    frame.watch.lap(frame.stats, "draw and shade");
  }
  void collect(Counters& counters) {
    bins_.for_each([&](SampledBin& bin) { bin.collect(counters); });
  }

  TriangleGroups groups_;
  SeenFirst clusters_;
  ScratchBuffer<std::uint64_t> keys_;  ///< bin after bin, where some clusters are drawn first
  std::vector<std::uint8_t> touched_;  ///< by bin: keys_ have begun there
  BinParts parts_;
  parallel::ScratchPool<SampledBin> bins_;
};

}  // namespace

std::unique_ptr<Method> make_sampled_path(MemoryAccount& memory) {
  return std::make_unique<SampledPath>(memory);
}

}  // namespace rastrum::raster
