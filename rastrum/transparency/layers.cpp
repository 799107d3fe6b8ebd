// SPDX-License-Identifier: BSD-3-Clause
// LucidRaster's rasterization stage (paper 4, stage 3) for threads. A bin's translucent pieces are
// recorded as masks of 8 × 8 samples: windows, or blocks if a pixel has several samples (the
// paper's tri-blocks). They are sorted by block and by the depth at their samples' centroid. Then
// each pixel's fragments are ordered (layer_lists.hpp) and blended (blend.hpp).
//
// Where it deviates: the paper shades fragment by fragment. Here a plane of fragments, one per
// pixel, is shaded like a visible surface, so every shader of the opaque path serves and neighbours
// share vectors. Lists grow, so no density needs its own rasterizer; dense bins are cut into parts
// (layered_path.cpp).
#include <rastrum/transparency/layers.hpp>

#include <algorithm>
#include <bit>
#include <utility>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/context/added_transparency.hpp>
#include <rastrum/raster/cover/bin_keys.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/resolve/resolve.hpp>
#include <rastrum/raster/rules/make_piece.hpp>
#include <rastrum/raster/shade/shader.hpp>
#include <rastrum/stop.hpp>
#include <rastrum/transparency/layer_lists.hpp>
#include <rastrum/transparency/packed_fragments.hpp>
#include <rastrum/transparency/recorded_blend.hpp>
#include <rastrum/transparency/records.hpp>
#include <rastrum/transparency/sampled_block.hpp>

namespace rastrum::transparency {
namespace {

using raster::BinFragment;
using raster::Block;
using raster::BlockColors;
using raster::kBlockSize;
using raster::Piece;
using raster::Rect;
using raster::Translucent;

/// Fragments that `exact` looks back over before the sort.
constexpr std::size_t kExactFilter = 8;
/// With fewer samples insertion is faster without a sort of the pieces (paper 4: up to 3 pieces).
constexpr std::uint64_t kFewSamples = 4 * 64;
/// 16 MiB per thread.
constexpr std::size_t kMostPlanes = std::size_t{1} << 15;
constexpr std::size_t kLeastPlanes = 64;

}  // namespace

struct LayeredBin::Impl {
  explicit Impl(MemoryAccount& memory)
      : windows_(memory),
        records_(memory),
        micro_(memory),
        micro_by_block_(memory),
        order_(memory),
        lists_(memory),
        packed_(memory),
        sampled_(memory) {}

  void begin(const raster::BinContext& context, const raster::SurfaceView& surface, Rect rect) {
    context_ = context;
    surface_ = surface;
    rect_ = rect;
    columns_ = raster::block_columns(rect);
    // Bounds would drop hidden fragments, which overdraw counts.
    opaque_.begin(*context.kernel, surface, rect, context.plan->hides);
    has_opaque_ = context.request->pass.load;
    windows_.restart();
    records_.restart();
    micro_.restart();
    samples_ = context.request->samples;
    kernel_ = &packed_kernels(context.request->isa);
    sink_ = context.request->sink;
    translucent_ = context.plan->translucent;
    const bool shades =
        context.plan->colors != raster::FramePlan::Colors::none || hands_on_colors();
    shading_ = shades ? context.request->shading : raster::Shading();
    const TransparencyOptions& options = context.request->transparency;
    if (!made_ || options != made_for_ || context.request->isa != made_with_) {
      made_for_ = options;
      made_with_ = context.request->isa;
      made_ = make_blend(options, made_with_);
    }
    blend_ = made_.get();
    if (hands_on_colors()) {
      recorded_.begin(*made_, *sink_);
      blend_ = &recorded_;
    }
    // Half of the fragments' memory is for records (layered_path.cpp). A worker may hold both
    // planes and packed fragments.
    const std::uint64_t share = context.fragment_bytes / 4;
    planes_ = kMostPlanes;
    if (share != 0)
      planes_ = std::clamp<std::size_t>(share / kPlaneBytes, kLeastPlanes, kMostPlanes);
    packed_.begin(context.request->isa, share);
    if (filters()) packed_.set_filter(filter(), planes_);
  }

  void blocks(const Piece* pieces, std::span<const Block> blocks) {
    for (std::size_t i = 0; i < blocks.size();) {
      // With several samples the surface's keys do not suffice for opaque pieces.
      const auto is_opaque = [&](const Block& b) {
        return samples_ == 1 && (pieces[b.piece].flags & kTranslucent) == 0;
      };
      std::size_t end = i;
      while (end < blocks.size() && is_opaque(blocks[end])) ++end;
      if (end > i) draw_opaque(pieces, blocks.subspan(i, end - i));
      for (i = end; end < blocks.size() && !is_opaque(blocks[end]);) ++end;
      if (end > i && !leaves_out()) record(pieces, blocks.subspan(i, end - i));
      i = end;
    }
  }

  void draw_opaque(const Piece* pieces, std::span<const Block> blocks) {
    opaque_.blocks(pieces, blocks);
    has_opaque_ = true;
  }

  [[nodiscard]] bool leaves_out() const { return translucent_ == Translucent::left_out; }
  [[nodiscard]] bool hands_on_colors() const { return translucent_ == Translucent::colors_to_sink; }

  void record(const Piece* pieces, std::span<const Block> blocks) {
    if (samples_ > 1) {
      Record* const out = records_.room(blocks.size());
      for (std::size_t i = 0; i < blocks.size(); ++i)
        out[i] = {pieces + blocks[i].piece, blocks[i].mask,
                  block_number(blocks[i].bx, blocks[i].by)};
      records_.added(blocks.size());
      return;
    }
    layer_blocks_ += blocks.size();
    Window* out = windows_.room(blocks.size());
    for (const Block& b : blocks)
      out = add(pieces, b,
                static_cast<std::uint32_t>((b.by * kBlockSize - rect_.y0) * kPackedPitch +
                                           b.bx * kBlockSize - rect_.x0),
                out);
    windows_.added(static_cast<std::size_t>(out - windows_.end()));
  }

  [[nodiscard]] bool takes_windows() const { return samples_ == 1; }

  void windows(const Piece* pieces, std::span<Block> windows) {
    const auto is_opaque = [&](const Block& w) {
      return (pieces[w.piece].flags & kTranslucent) == 0;
    };
    for (std::size_t i = 0; i < windows.size();) {
      std::size_t end = i;
      for (; end < windows.size() && is_opaque(windows[end]); ++end) {
        Block& w = windows[end];
        w.bx = static_cast<std::uint16_t>((rect_.x0 + w.bx) / kBlockSize);
        w.by = static_cast<std::uint16_t>((rect_.y0 + w.by) / kBlockSize);
      }
      if (end > i) draw_opaque(pieces, windows.subspan(i, end - i));
      i = end;
      if (leaves_out()) {
        while (i < windows.size() && !is_opaque(windows[i])) ++i;
        continue;
      }
      Window* out = windows_.room(windows.size() - i);
      for (; end < windows.size() && !is_opaque(windows[end]); ++end) {
        const Block& w = windows[end];
        layer_blocks_ += blocks_of_window(w.mask, w.bx, w.by);
        out = add(pieces, w, static_cast<std::uint32_t>(w.by * kPackedPitch + w.bx), out);
      }
      windows_.added(static_cast<std::size_t>(out - windows_.end()));
      i = end;
    }
  }

  /// Writes the window of `b` at `pixel` of the region to `out`, behind those of windows_. Returns
  /// the place of the next one.
  Window* add(const Piece* pieces, const Block& b, std::uint32_t pixel, Window* out) {
    const Piece& piece = pieces[b.piece];
    *out = {&piece, b.mask, pixel};
    if ((piece.flags & raster::kClipped) == 0 || b.piece == 0 ||
        pieces[b.piece - 1].low != piece.low)
      return out + 1;
    Window own = *out;
    windows_.added(static_cast<std::size_t>(out - windows_.end()));
    keep_nearest(own);
    out = windows_.end();
    *out = own;
    return out + (own.mask != 0);
  }
  /// A clipped triangle's pieces may overlap by a snapped vertex. They are one layer, and come one
  /// after the other, as blocks: at each sample the nearest counts.
  void keep_nearest(Window& window) {
    alignas(64) std::uint64_t keys[64], others[64];
    Block block{0,
                static_cast<std::uint16_t>(
                    (rect_.x0 + static_cast<int>(window.pixel) % kPackedPitch) / kBlockSize),
                static_cast<std::uint16_t>(
                    (rect_.y0 + static_cast<int>(window.pixel) / kPackedPitch) / kBlockSize),
                0};
    for (std::size_t k = windows_.size(); k-- > 0;) {
      Window& other = windows_.in_order()[k];
      if (other.piece->low != window.piece->low) return;
      block.mask = other.pixel == window.pixel ? other.mask & window.mask : 0;
      if (block.mask == 0) continue;
      context_.kernel->keys(*window.piece, block, keys);
      context_.kernel->keys(*other.piece, block, others);
      for (std::uint64_t m = block.mask; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        (keys[i] > others[i] ? other : window).mask &= ~(std::uint64_t{1} << i);
      }
      if (other.mask == 0) windows_.remove(k);
    }
  }

  void fragments(std::span<const BinFragment> fragments) {
    // Fragments count from the bin; the region may be a part of it.
    const auto first = static_cast<std::uint32_t>(rect_.y0 % raster::kBinSize * kPackedPitch +
                                                  rect_.x0 % raster::kBinSize);
    while (!fragments.empty()) {
      std::size_t end = 0;
      while (end < fragments.size() && !is_translucent(fragments[end])) ++end;
      if (end > 0) {
        opaque_.fragments(fragments.first(end));
        has_opaque_ = true;
      }
      fragments = fragments.subspan(end);
      fragments = fragments.subspan(micro_.take(*kernel_, fragments, first));
    }
    if (leaves_out()) micro_.restart();
  }

  raster::DepthBounds* bounds() { return samples_ == 1 ? opaque_.bounds() : nullptr; }

  void collect(raster::Counters& counters) {
    opaque_.collect(counters);
    const auto add = [&](std::string_view name, std::uint64_t& value) {
      raster::add_counter(counters, name, std::exchange(value, 0));
    };
    add("translucent fragments", totals_.fragments);
    add("layer blocks", layer_blocks_);
    add("windows", totals_.windows);
    if (filters()) add("wrong pixels", misplaced_);
    if (made_for_.method == Transparency::exact) add("repaired pixels", misplaced_);
    raster::raise_counter(counters, "deepest", std::exchange(totals_.deepest, 0));
  }

  [[nodiscard]] std::uint32_t block_number(int bx, int by) const {
    return static_cast<std::uint32_t>((by - rect_.y0 / kBlockSize) * columns_ + bx -
                                      rect_.x0 / kBlockSize);
  }

  void resolve() {
    layer_blocks_ += records_.size();  // of several samples
    if ((leaves_out() || translucent_ == Translucent::keys_to_sink) && samples_ == 1)
      return hand_on_keys();
    const BlockGrid grid{rect_.x0 / kBlockSize, rect_.y0 / kBlockSize, columns_,
                         raster::block_rows(rect_)};
    if (grid.columns * kBlockSize <= kPackedPitch && grid.rows * kBlockSize <= kPackedPitch &&
        resolve_packed(grid, windows_.in_order(), micro_.all()))
      return;
    const std::size_t blocks = raster::block_count(rect_);
    sort_by_block(blocks);
    for (std::size_t b = 0; b < blocks; ++b) {
      throw_if_stopped();  // thousands of layers take long
      const int bx = rect_.x0 / kBlockSize + static_cast<int>(b) % columns_;
      const int by = rect_.y0 / kBlockSize + static_cast<int>(b) / columns_;
      resolve_block(bx, by, records_.of(b), micro_by_block_.of(b));
    }
  }

  void sort_by_block(std::size_t blocks) {
    for (const Window& w : windows_.in_order()) {
      Record* out = records_.room(4);
      for_each_block_of(
          w.mask, w.pixel % kPackedPitch, w.pixel / kPackedPitch,
          [&](std::uint32_t column, std::uint32_t row, std::uint64_t mask) {
            *out++ = {w.piece, mask, row * static_cast<std::uint32_t>(columns_) + column};
          });
      records_.added(static_cast<std::size_t>(out - records_.end()));
    }
    records_.sort(blocks);
    const MicroFragments all = micro_.all();
    micro_by_block_.restart();
    MicroRecord* const out = micro_by_block_.room(all.count);
    for (std::size_t i = 0; i < all.count; ++i) {
      const std::uint32_t x = all.pixels[i] % kPackedPitch, y = all.pixels[i] / kPackedPitch;
      out[i] = {all.keys[i], y / kBlockSize * static_cast<std::uint32_t>(columns_) + x / kBlockSize,
                y % kBlockSize * kBlockSize + x % kBlockSize};
    }
    micro_by_block_.added(all.count);
    micro_by_block_.sort(blocks);
  }

  /// Sends the keys of translucent fragments to the sink, and shades the opaque surfaces.
  void hand_on_keys() {
    const std::size_t blocks = raster::block_count(rect_);
    sort_by_block(blocks);
    alignas(64) std::uint64_t piece_keys[64];
    for (std::size_t b = 0; b < blocks; ++b) {
      throw_if_stopped();
      const int bx = rect_.x0 / kBlockSize + static_cast<int>(b) % columns_;
      const int by = rect_.y0 / kBlockSize + static_cast<int>(b) / columns_;
      const std::uint64_t* const keys = surface_.block(bx, by);
      for (const Record& r : records_.of(b)) {
        context_.kernel->keys(
            *r.piece, {0, static_cast<std::uint16_t>(bx), static_cast<std::uint16_t>(by), r.mask},
            piece_keys);
        std::uint64_t mask = 0;
        for (std::uint64_t m = r.mask; m != 0; m &= m - 1) {
          const int i = std::countr_zero(m);
          mask |= std::uint64_t{piece_keys[i] > keys[i]} << i;
        }
        if (mask != 0) sink_->take({bx, by, piece_keys, mask, nullptr});
      }
      for (const MicroRecord& f : micro_by_block_.of(b)) {
        if (f.key <= keys[f.pixel]) continue;
        piece_keys[f.pixel] = f.key;
        sink_->take({bx, by, piece_keys, std::uint64_t{1} << f.pixel, nullptr});
      }
      shade_opaque(keys, bx, by, *surface_.colors_of(bx, by));
    }
  }

  /// Resolves `grid` at once. Returns false if its fragments are too many.
  bool resolve_packed(const BlockGrid& grid, std::span<const Window> windows,
                      const MicroFragments& micro) {
    if (samples_ > 1) return false;
    if (!packed_.collect(windows, micro, grid, has_opaque_ ? &surface_ : nullptr)) return false;
    if (blend_->order() == LayerOrder::depth) packed_.sort();
    if (shading_) packed_.shade(context_, shading_, blend_->opaque_at());
    for (int by = grid.by; by < grid.by + grid.rows; ++by)
      for (int bx = grid.bx; bx < grid.bx + grid.columns; ++bx) {
        std::uint64_t* const keys = surface_.block(bx, by);
        BlockColors& out = *surface_.colors_of(bx, by);
        const bool any = packed_.any(bx, by), opaque = packed_.has_opaque(bx, by);
        // A block with nothing in it keeps its colours unset; they are not read.
        if (opaque) shade_opaque(keys, bx, by, any ? behind_ : out);
        if (!any) continue;
        if (shading_) {
          recorded_.place(bx, by);
          packed_.blend(bx, by, *blend_, opaque ? &behind_ : nullptr, out);
        }
        if (translucent_ == Translucent::blended) packed_.raise(bx, by, keys);
        if (filters()) note_misplaced(bx, by, packed_.misplaced(bx, by));
      }
    totals_.add({packed_.fragments(), packed_.deepest()});
    return true;
  }

  void resolve_block(int bx, int by, std::span<Record> records,
                     std::span<const MicroRecord> micro) {
    std::uint64_t* const keys = surface_.block(bx, by);
    BlockColors& out = *surface_.colors_of(bx, by);
    if (samples_ > 1) {
      note(bx, by,
           sampled_.resolve(context_, shading_, *made_, records, bx, by, filter(), planes_,
                            !filters(), keys, out));
      return;
    }
    micro_.restart();  // they are in their blocks
    for (const MicroRecord& f : micro)
      micro_.add(f.key, f.pixel / kBlockSize * kPackedPitch + f.pixel % kBlockSize);
    windows_.restart();
    Window* const own = windows_.room(records.size());
    for (std::size_t i = 0; i < records.size(); ++i)
      own[i] = {records[i].piece, records[i].mask, 0};
    windows_.added(records.size());
    if (resolve_packed({bx, by, 1, 1}, windows_.in_order(), micro_.all())) return;
    BlockColors& behind = records.empty() && micro.empty() ? out : behind_;
    shade_opaque(keys, bx, by, behind);
    if (&behind == &out) return;

    const LayerOrder order = blend_->order();
    sort_by_depth(records, order == LayerOrder::depth && wants_sort(records), bx, by);
    const bool sorted = order == LayerOrder::depth && !filters();
    LayerCounts counts;
    std::uint64_t nearest[64];
    std::copy_n(keys, 64, nearest);
    recorded_.place(bx, by);
    blend_->begin(behind);
    for (int pass = 0; pass < blend_->passes(); ++pass) {
      blend_->begin_pass(pass);
      lists_.restart(order, filter(), planes_);
      std::uint64_t finished = 0;
      do {
        fill_lists(keys, records, micro, bx, by);
        if (!filters()) lists_.sort();
        const std::size_t depth = lists_.depth();
        for (std::size_t k = 0; k < depth; ++k) {
          // Sorted by depth, the first plane has the nearest.
          if (k == 0 || !sorted) raise(nearest, lists_.plane(k), lists_.mask(k));
          const std::uint64_t mask = lists_.mask(k) & ~finished;
          if (mask == 0) continue;
          finished |= blend_->layer({lists_.plane(k), mask, shade(lists_.plane(k), mask, bx, by)});
        }
        for (std::size_t k = 0; k < depth && pass == 0; ++k)
          counts.fragments += static_cast<std::uint64_t>(parallel::popcount(lists_.mask(k)));
      } while (lists_.next_window() && ++counts.windows != 0);
      counts.deepest = lists_.deepest();
      counts.misplaced |= lists_.misplaced();
    }
    note(bx, by, counts);
    blend_->finish(out);
    if (translucent_ == Translucent::blended) std::copy_n(nearest, 64, keys);
  }

  [[nodiscard]] bool filters() const { return filter_of(made_for_) != 0; }
  [[nodiscard]] std::size_t filter() const {
    return filters() ? static_cast<std::size_t>(filter_of(made_for_)) : kExactFilter;
  }

  void fill_lists(const std::uint64_t* keys, std::span<const Record> records,
                  std::span<const MicroRecord> micro, int bx, int by) {
    alignas(64) std::uint64_t piece_words[64];
    for (std::size_t k = 0; k < records.size(); ++k) {
      const Record& r = records[order_[k] & 0xFFFFFFFFU];
      context_.kernel->keys(
          *r.piece, {0, static_cast<std::uint16_t>(bx), static_cast<std::uint16_t>(by), r.mask},
          piece_words);
      for (std::uint64_t m = r.mask; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        if (piece_words[i] > keys[i]) lists_.insert(i, piece_words[i]);
      }
    }
    for (const MicroRecord& f : micro)
      if (f.key > keys[f.pixel]) lists_.insert(static_cast<int>(f.pixel), f.key);
  }

  /// The filter's errors are defined for sorted pieces.
  [[nodiscard]] bool wants_sort(std::span<const Record> records) const {
    if (records.size() < 2) return false;
    if (filters() || records.size() * 64 > 16 * kFewSamples) return true;
    std::uint64_t samples = 0;
    for (const Record& r : records)
      samples += static_cast<std::uint64_t>(parallel::popcount(r.mask));
    return samples > kFewSamples;
  }

  /// Puts the numbers of a block's records into order_: nearest first, or as they are.
  void sort_by_depth(std::span<const Record> records, bool sort, int bx, int by) {
    order_.reserve(records.size());
    for (std::size_t i = 0; i < records.size(); ++i)
      order_[i] = i | (sort ? near_first(*records[i].piece, records[i].mask, bx, by) : 0);
    if (sort) std::sort(order_.data(), order_.data() + records.size());
  }

  static void raise(std::uint64_t* nearest, const std::uint64_t* keys, std::uint64_t mask) {
    for (std::uint64_t m = mask; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      nearest[i] = std::max(nearest[i], keys[i]);
    }
  }

  const BlockColors& shade(const std::uint64_t* keys, std::uint64_t mask, int bx, int by) {
    if (shading_ &&
        shade_block(shading_, *context_.frame,
                    {keys, mask, bx * kBlockSize, by * kBlockSize, context_.shader_scratch},
                    context_.request->isa, colors_))
      std::fill_n(colors_.a, 64, 1.0F);
    return colors_;
  }

  /// The opaque surface; 0 where there is none.
  void shade_opaque(const std::uint64_t* keys, int bx, int by, BlockColors& out) {
    std::uint64_t covered =
        context_.kernel->covered(keys) &
        raster::samples_inside({0, 0, context_.request->width, context_.request->height}, bx, by);
    if (hands_on_colors()) covered = 0;  // the sink's owner draws what is behind
    if (covered != ~std::uint64_t{0}) out = {};
    if (covered == 0 || !shading_) return;
    const BlockColors& colors = shade(keys, covered, bx, by);
    for (std::uint64_t m = covered; m != 0; m &= m - 1)
      out.set(std::countr_zero(m), colors.at(std::countr_zero(m)));
  }

  void note(int bx, int by, const LayerCounts& counts) {
    totals_.add(counts);
    note_misplaced(bx, by, counts.misplaced);
  }
  void note_misplaced(int bx, int by, std::uint64_t pixels) {
    misplaced_ += static_cast<std::uint64_t>(parallel::popcount(pixels));
    const ImageView<std::uint8_t>& errors = context_.request->targets.errors;
    // In the order of submission no depth is misplaced.
    if (errors.empty() || blend_->order() != LayerOrder::depth) return;
    for (std::uint64_t m = pixels; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      errors(bx * kBlockSize + i % kBlockSize, by * kBlockSize + i / kBlockSize) = 255;
    }
  }

  raster::BinContext context_;
  raster::SurfaceView surface_;
  Rect rect_;
  int columns_ = 0;
  raster::Shading shading_;  ///< empty: no colour is wanted
  std::size_t planes_ = 0;
  int samples_ = 1;

  raster::BinKeys opaque_;
  bool has_opaque_ = false;  ///< whether the surface may have keys
  std::unique_ptr<LayerBlend> made_;
  LayerBlend* blend_ = nullptr;  ///< `made_`, or `recorded_` around it
  RecordedBlend recorded_;
  const PackedKernels* kernel_ = nullptr;
  raster::FragmentSink* sink_ = nullptr;
  Translucent translucent_ = Translucent::blended;
  TransparencyOptions made_for_;
  Isa made_with_ = Isa::scalar;
  InOrder<Window> windows_;  ///< if pixels have one sample
  ByBlock<Record> records_;
  MicroRecords micro_;
  ByBlock<MicroRecord> micro_by_block_;
  ScratchBuffer<std::uint64_t> order_;  ///< of a block's records: ~depth << 32 | number
  LayerLists<> lists_;
  PackedFragments packed_;
  SampledBlock sampled_;
  BlockColors behind_, colors_;
  LayerCounts totals_;
  std::uint64_t layer_blocks_ = 0, misplaced_ = 0;
};

LayeredBin::LayeredBin(MemoryAccount& memory) : impl_(std::make_unique<Impl>(memory)) {}
LayeredBin::LayeredBin(LayeredBin&&) noexcept = default;
LayeredBin::~LayeredBin() = default;

void LayeredBin::begin(const raster::BinContext& context, const raster::SurfaceView& surface,
                       Rect rect) {
  impl_->begin(context, surface, rect);
}
void LayeredBin::blocks(const Piece* pieces, std::span<const Block> blocks) {
  impl_->blocks(pieces, blocks);
}
bool LayeredBin::takes_windows() const {
  return impl_->takes_windows();
}
void LayeredBin::windows(const Piece* pieces, std::span<Block> windows) {
  impl_->windows(pieces, windows);
}
void LayeredBin::fragments(std::span<const BinFragment> fragments) {
  impl_->fragments(fragments);
}
raster::DepthBounds* LayeredBin::bounds() {
  return impl_->bounds();
}
void LayeredBin::finish() {
  impl_->resolve();
}
void LayeredBin::collect(raster::Counters& counters) {
  impl_->collect(counters);
}

}  // namespace rastrum::transparency
