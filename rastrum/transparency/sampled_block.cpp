// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/transparency/sampled_block.hpp>

#include <bit>

#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/resolve/resolve.hpp>
#include <rastrum/raster/setup/assemble.hpp>
#include <rastrum/raster/shade/shader.hpp>

namespace rastrum::transparency {

using raster::BlockColors;
using raster::kBlockSize;
using raster::Piece;

/// A clipped triangle's pieces may overlap by a snapped vertex: the nearest counts.
template <class F>
void SampledBlock::for_each_record(const Triangle& t, const std::uint64_t& pixels,
                                   std::optional<std::uint32_t> only, F&& f) {
  alignas(64) std::uint64_t keys[64], others[64];
  const auto find = [&](const Record& record, std::uint64_t mask, std::uint64_t* out) {
    context_->kernel->keys(
        *record.piece, {0, static_cast<std::uint16_t>(bx_), static_cast<std::uint16_t>(by_), mask},
        out);
  };
  for (std::uint32_t r = t.first; r < t.end;) {
    const int sample = raster::sample_of(*records_[r].piece);
    std::uint64_t mask = records_[r].mask & pixels;
    const bool wanted = static_cast<std::uint32_t>(sample) == only.value_or(sample);
    if (wanted && mask != 0) find(records_[r], mask, keys);
    for (++r; r < t.end && raster::sample_of(*records_[r].piece) == sample; ++r) {
      const std::uint64_t more = records_[r].mask & pixels;
      if (!wanted || more == 0) continue;
      find(records_[r], more, others);
      for (std::uint64_t m = more; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        keys[i] = (mask >> i & 1) != 0 ? std::max(keys[i], others[i]) : others[i];
      }
      mask |= more;
    }
    if (wanted && mask != 0)
      f(static_cast<std::uint32_t>(sample), mask, static_cast<const std::uint64_t*>(keys));
  }
}

/// In order of submission; a triangle's records by sample.
void SampledBlock::find_triangles() {
  // A triangle's pieces face one way; a quadric's are two surfaces.
  const auto away = [](const Record& r) { return r.piece->flags & raster::kFacesAway; };
  std::sort(records_.begin(), records_.end(), [&](const Record& a, const Record& b) {
    if (a.piece->low != b.piece->low) return a.piece->low > b.piece->low;
    if (away(a) != away(b)) return away(a) < away(b);
    return raster::sample_of(*a.piece) < raster::sample_of(*b.piece);
  });
  triangle_count_ = 0;
  const auto n = static_cast<std::uint32_t>(records_.size());
  for (std::uint32_t first = 0; first < n;) {
    std::uint32_t end = first + 1;
    while (end < n && records_[end].piece->low == records_[first].piece->low &&
           away(records_[end]) == away(records_[first]))
      ++end;
    triangles_.grow(triangle_count_ + 1, triangle_count_);
    triangles_[triangle_count_++] = {first, end, ~std::uint64_t{0}, 0, 0};
    first = end;
  }
}

/// By the depth at the centroid of the first sample's part, nearest first, or as submitted.
void SampledBlock::order_triangles() {
  order_.reserve(triangle_count_);
  const bool by_depth = blend_->order() == LayerOrder::depth;
  for (std::uint32_t k = 0; k < triangle_count_; ++k) {
    const Record& r = records_[triangles_[k].first];
    order_[k] = (by_depth ? near_first(*r.piece, r.mask, bx_, by_) : 0) | k;
  }
  if (by_depth) std::sort(order_.data(), order_.data() + triangle_count_);
}

/// Calls f(piece) for the pieces of `piece`'s primitive at the pixels' centres. Clipped primitives
/// are clipped again: a piece may cover a centre but no sample of this block.
template <class F>
void SampledBlock::for_each_piece_at_centre(const Piece& piece, F&& f) {
  if ((piece.flags & raster::kClipped) != 0) {
    const std::uint64_t id = raster::kIdMask - piece.low;
    const raster::FrameGeometry& frame = *context_->frame;
    const raster::Draw& draw = frame.draw_of(id);
    (void)raster::assemble_primitive(frame, draw, id - draw.first_id, f);
    return;
  }
  const auto offsets = raster::sample_offsets(context_->request->samples);
  const raster::SampleOffset at = offsets[static_cast<std::size_t>(raster::sample_of(piece))];
  f(raster::moved(piece, {-at.x, -at.y}));
}

void SampledBlock::find_points(const Triangle& t, Shaded& out) {
  out.mask = 0;
  for (std::uint32_t r = t.first; r < t.end; ++r) out.mask |= records_[r].mask;
  std::uint64_t at_centre = 0;
  alignas(64) std::uint64_t keys[64];
  for_each_piece_at_centre(*records_[t.first].piece, [&](const Piece& piece) {
    raster::Block block{0, static_cast<std::uint16_t>(bx_), static_cast<std::uint16_t>(by_), 0};
    context_->kernel->masks(&piece, &block, 1);
    block.mask &= out.mask;
    if (block.mask != 0) context_->kernel->keys(piece, block, keys);
    for (std::uint64_t m = block.mask; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      out.keys[i] = (at_centre >> i & 1) != 0 ? std::max(out.keys[i], keys[i]) : keys[i];
      out.points.dx[i] = out.points.dy[i] = 0;
    }
    at_centre |= block.mask;
  });
  std::uint64_t left = out.mask & ~at_centre;
  if (left == 0) return;
  const auto offsets = raster::sample_offsets(context_->request->samples);
  for_each_record(t, left, {},
                  [&](std::uint32_t sample, std::uint64_t mask, const auto* at_sample) {
                    constexpr float kPx = 1.0F / raster::kSubpixels;
                    for (std::uint64_t m = mask; m != 0; m &= m - 1) {
                      const int i = std::countr_zero(m);
                      out.keys[i] = at_sample[i];
                      out.points.dx[i] = static_cast<float>(offsets[sample].x) * kPx;
                      out.points.dy[i] = static_cast<float>(offsets[sample].y) * kPx;
                    }
                    left &= ~mask;
                  });
}

void SampledBlock::raise_opaque() {
  const auto samples = static_cast<std::uint32_t>(context_->request->samples);
  for (std::uint32_t s = 0; s < samples; ++s) {
    std::fill_n(opaque_[s], 64, std::uint64_t{0});
    std::fill_n(owner_[s], 64, kNone);
  }
  has_opaque_ = false;
  for (std::uint32_t t = 0; t < triangle_count_; ++t) {
    if (is_translucent(triangles_[t])) continue;
    has_opaque_ = true;
    for_each_record(triangles_[t], triangles_[t].kept, {},
                    [&](std::uint32_t s, std::uint64_t mask, const auto* keys) {
                      for (std::uint64_t m = mask; m != 0; m &= m - 1) {
                        const int i = std::countr_zero(m);
                        if (keys[i] <= opaque_[s][i]) continue;
                        opaque_[s][i] = keys[i];
                        owner_[s][i] = t;
                      }
                    });
  }
}

void SampledBlock::find_shown() {
  for (std::uint32_t k = 0; k < triangle_count_; ++k) {
    Triangle& t = triangles_[k];
    if (!has_opaque_) {
      for (std::uint32_t r = t.first; r < t.end; ++r) t.shown |= records_[r].mask & t.kept;
      continue;
    }
    const bool translucent = is_translucent(t);
    for_each_record(t, t.kept, {}, [&](std::uint32_t s, std::uint64_t mask, const auto* keys) {
      for (std::uint64_t m = mask; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        const bool shows = translucent ? keys[i] > opaque_[s][i] : owner_[s][i] == k;
        t.shown |= std::uint64_t{shows} << i;
      }
    });
  }
}

std::size_t SampledBlock::count_shown() const {
  std::size_t count = 0;
  for (std::uint32_t k = 0; k < triangle_count_; ++k)
    count += static_cast<std::size_t>(parallel::popcount(shown(triangles_[k])));
  return count;
}

/// Fragments of several triangles are shaded together if their pixels differ.
void SampledBlock::shade(std::size_t count) {
  color_count_ = 1;
  colors_.reserve(count + 1);
  colors_[0] = {};
  Shaded plane, own;
  plane_triangles_.clear();
  for (std::uint32_t k = 0; k < triangle_count_; ++k) {
    Triangle& t = triangles_[k];
    const std::uint64_t pixels = shown(t);
    if (pixels == 0) continue;
    t.color = color_count_;
    color_count_ += static_cast<std::uint32_t>(parallel::popcount(pixels));
    find_points(t, own);
    if ((plane.mask & pixels) != 0) flush(plane);
    for (std::uint64_t m = pixels; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      plane.keys[i] = own.keys[i];
      plane.points.dx[i] = own.points.dx[i];
      plane.points.dy[i] = own.points.dy[i];
    }
    plane.mask |= pixels;
    plane_triangles_.push_back(k);
  }
  flush(plane);
}

void SampledBlock::flush(Shaded& plane) {
  if (plane.mask == 0) return;
  BlockColors shaded;
  if (shading_) {
    raster::VisibleBlock block{plane.keys, plane.mask, bx_ * kBlockSize, by_ * kBlockSize,
                               context_->shader_scratch};
    block.points = &plane.points;
    if (shade_block(shading_, *context_->frame, block, context_->request->isa, shaded))
      std::fill_n(shaded.a, 64, 1.0F);
    for (const std::uint32_t k : plane_triangles_) {
      std::uint32_t place = triangles_[k].color;
      for (std::uint64_t m = shown(triangles_[k]); m != 0; m &= m - 1)
        colors_[place++] = shaded.at(std::countr_zero(m));
    }
  }
  plane.mask = 0;
  plane_triangles_.clear();
}

bool SampledBlock::find_behind(std::uint32_t sample, BlockColors& behind) const {
  bool any = false;
  behind = {};
  if (!has_opaque_) return false;
  for (int i = 0; i < 64; ++i) {
    if ((pixels_ >> i & 1) == 0 || owner_[sample][i] == kNone) continue;
    any = true;
    if (shading_) behind.set(i, color(owner_[sample][i], i));
  }
  return any;
}

/// Returns false if there are too many fragments.
bool SampledBlock::deal() {
  const LayerOrder order = blend_->order();
  const std::size_t filter = repair_ || order == LayerOrder::submission ? 0 : filter_;
  layers_.begin(context_->request->isa, planes_ * kPlaneBytes / 2);
  if (filter != 0) order_triangles();
  for (std::uint32_t n = 0; n < triangle_count_; ++n) {
    const auto k = filter == 0 ? n : static_cast<std::uint32_t>(order_[n]);
    const Triangle& t = triangles_[k];
    if (!is_translucent(t) || shown(t) == 0) continue;
    for_each_record(t, t.kept & pixels_, {},
                    [&](std::uint32_t s, std::uint64_t mask, const auto* keys) {
                      std::uint64_t seen = mask;
                      for (std::uint64_t m = mask; m != 0; m &= m - 1) {
                        const int i = std::countr_zero(m);
                        if (has_opaque_) seen &= ~(std::uint64_t{keys[i] <= opaque_[s][i]} << i);
                        nearest_[i] = std::max(nearest_[i], keys[i]);
                      }
                      layers_.add(s, seen, keys, [&](int i) { return place_of(t, i) - 1; });
                    });
    if (!layers_.has_room()) return false;
  }
  return layers_.deal(context_->request->samples, order, filter, planes_);
}

/// Returns false if the method takes no rows.
bool SampledBlock::blend_dealt(BlockColors& sum) {
  const auto samples = static_cast<std::uint32_t>(context_->request->samples);
  bool takes_rows = true;
  BlockColors behind, one;
  for (std::uint32_t s = 0; s < samples && takes_rows; ++s) {
    const bool any_behind = find_behind(s, behind);
    PackedRow rows[kBlockSize];
    for (std::size_t y = 0; y < 8; ++y) rows[y] = layers_.row(s, y, colors_.data());
    blend_rows(*blend_, rows, any_behind ? &behind : nullptr, one, [&] { takes_rows = false; });
    add(sum, one);
  }
  return takes_rows;
}

LayerCounts SampledBlock::blend_sample(std::uint32_t sample, BlockColors& out) {
  LayerCounts counts;
  BlockColors behind, layer;
  raster::FragmentSink* const sink = context_->request->sink;
  (void)find_behind(sample, behind);
  blend_->begin(behind);
  for (int pass = 0; pass < blend_->passes(); ++pass) {
    blend_->begin_pass(pass);
    lists_.restart(blend_->order(), filter_, planes_);
    std::uint64_t finished = 0;
    do {
      for (std::uint32_t n = 0; n < triangle_count_; ++n) {
        const auto k = static_cast<std::uint32_t>(order_[n]);
        if (!is_translucent(triangles_[k])) continue;
        for_each_record(triangles_[k], triangles_[k].kept & pixels_, sample,
                        [&](std::uint32_t, std::uint64_t mask, const auto* keys) {
                          for (std::uint64_t m = mask; m != 0; m &= m - 1) {
                            const int i = std::countr_zero(m);
                            if (keys[i] > opaque_[sample][i]) lists_.insert(i, keys[i], k);
                          }
                        });
      }
      if (repair_) lists_.sort();
      const std::size_t depth = lists_.depth();
      for (std::size_t k = 0; k < depth; ++k) {
        const std::uint32_t* const owners = lists_.owners(k);
        const std::uint64_t mask = lists_.mask(k);
        for (std::uint64_t m = mask; m != 0; m &= m - 1) {
          const int i = std::countr_zero(m);
          nearest_[i] = std::max(nearest_[i], lists_.plane(k)[i]);
          if (shading_) layer.set(i, color(owners[i], i));
        }
        if (pass == 0) counts.fragments += static_cast<std::uint64_t>(parallel::popcount(mask));
        if ((mask & ~finished) != 0 && sink != nullptr)
          sink->take({bx_, by_, lists_.plane(k), mask & ~finished, shading_ ? &layer : nullptr,
                      static_cast<int>(sample)});
        if ((mask & ~finished) != 0 && shading_)
          finished |= blend_->layer({lists_.plane(k), mask & ~finished, layer});
      }
    } while (lists_.next_window() && ++counts.windows != 0);
    counts.deepest = lists_.deepest();
    counts.misplaced |= lists_.misplaced();
  }
  blend_->finish(out);
  std::uint64_t opaque = 0;
  for (int i = 0; i < 64; ++i) opaque |= std::uint64_t{owner_[sample][i] != kNone} << i;
  opaque &= pixels_;
  if (sink != nullptr && opaque != 0)
    sink->take({bx_, by_, opaque_[sample], opaque, shading_ ? &behind : nullptr,
                static_cast<int>(sample), true});
  return counts;
}

LayerCounts SampledBlock::resolve(const raster::BinContext& context, const raster::Shading& shading,
                                  LayerBlend& blend, std::span<Record> records, int bx, int by,
                                  std::size_t filter, std::size_t planes, bool repair,
                                  std::uint64_t* keys, BlockColors& out) {
  context_ = &context;
  shading_ = shading;
  blend_ = &blend;
  records_ = records;
  bx_ = bx;
  by_ = by;
  filter_ = filter;
  planes_ = planes;
  repair_ = repair;
  find_triangles();
  test();
  raise_opaque();
  find_shown();
  std::fill_n(nearest_, 64, std::uint64_t{0});
  for (int s = 0; s < context.request->samples; ++s)
    for (int i = 0; i < 64; ++i) nearest_[i] = std::max(nearest_[i], opaque_[s][i]);
  LayerCounts counts;
  blend_pixels(~std::uint64_t{0}, counts, out);
  std::copy_n(nearest_, 64, keys);
  return counts;
}

/// Goes half by half if all fragments' colours need more memory than planes may.
void SampledBlock::blend_pixels(std::uint64_t pixels, LayerCounts& counts, BlockColors& out) {
  pixels_ = pixels;
  const std::size_t count = count_shown();
  if (count * sizeof(Vec4) > planes_ * kPlaneBytes && !std::has_single_bit(pixels)) {
    const std::uint64_t second = pixels & pixels << std::popcount(pixels) / 2;
    blend_pixels(pixels & ~second, counts, out);
    blend_pixels(second, counts, out);
    return;
  }
  shade(count);
  const auto samples = static_cast<std::uint32_t>(context_->request->samples);
  BlockColors sum = {}, one;
  // Layers for a sink, and blocks without colours, go plane by plane.
  if (shading_ && context_->request->sink == nullptr && deal() && blend_dealt(sum)) {
    counts.add({layers_.fragments(), layers_.deepest(), 0, layers_.misplaced()});
  } else {
    order_triangles();
    sum = {};
    for (std::uint32_t s = 0; s < samples; ++s) {
      counts.add(blend_sample(s, one));
      add(sum, one);
    }
  }
  const float share = 1.0F / static_cast<float>(samples);
  for (std::uint64_t m = pixels; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    out.set(i, {sum.r[i] * share, sum.g[i] * share, sum.b[i] * share, sum.a[i] * share});
  }
}

void SampledBlock::test() {
  if (!context_->plan->tests) return;
  Shaded own;
  for (std::uint32_t k = 0; k < triangle_count_; ++k) {
    Triangle& t = triangles_[k];
    const Piece& piece = *records_[t.first].piece;
    if ((piece.flags & raster::kMayDrop) == 0) continue;
    find_points(t, own);
    t.kept = context_->request->kept(
        *context_->frame, piece,
        {0, static_cast<std::uint16_t>(bx_), static_cast<std::uint16_t>(by_), own.mask},
        &own.points);
  }
}

}  // namespace rastrum::transparency
