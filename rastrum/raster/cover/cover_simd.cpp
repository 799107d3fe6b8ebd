// SPDX-License-Identifier: BSD-3-Clause
// Coverage with Highway, compiled once per instruction set, by coverage.hpp's exact edge functions
// and so with its masks. Triangles of a few pixels raise rows of keys, if there are rows. Other
// pieces with a box of at most 8 × 8 samples are covered one a lane and then cut along blocks, or
// become windows (windows.hpp). The rest goes block by block.

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/cover/cover_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include <rastrum/raster/cover/quadric_kernels-inl.hpp>
#include <rastrum/raster/cover/row_lists.hpp>
#include <rastrum/raster/cover/triangle_lanes-inl.hpp>
#include <rastrum/raster/cover/windows.hpp>
#include <rastrum/raster/kernels/depth_bounds.hpp>
#include <rastrum/raster/kernels/kernels_simd.hpp>
#include <rastrum/raster/kernels/lanes-inl.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/raster/rules/edge_lanes-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2

/// Samples of a block in a vector: several rows, a row, or half of one.
using Wide = hn::CappedTag<std::int32_t, 16>;
constexpr std::size_t kWide = hn::MaxLanes(Wide{});
constexpr std::size_t kRowsAtOnce = kWide < 8 ? 1 : kWide / 8,
                      kPartsOfRow = kWide < 8 ? 8 / kWide : 1;

/// Differences of an edge's value between a block's first sample and the samples of the first
/// vectors.
struct EdgeSteps {
  hn::Vec<Wide> part[kPartsOfRow];

  HWY_INLINE void set(std::int32_t a, std::int32_t b) {
    const Wide d;
    for (std::size_t i = 0; i < kPartsOfRow; ++i) {
      const auto lane = hn::Iota(d, static_cast<std::int32_t>(i * kWide));
      part[i] = hn::Add(hn::Mul(hn::Set(d, a), hn::And(lane, hn::Set(d, 7))),
                        hn::Mul(hn::Set(d, b), hn::ShiftRight<3>(lane)));
    }
  }
};

/// cover_8x8 from the three edges' values at the block's first sample, clamped to int32.
HWY_INLINE std::uint64_t cover_block(const std::int32_t (&base)[3], const EdgeSteps (&steps)[3],
                                     const std::int32_t (&b)[3]) {
  const Wide d;
  std::uint64_t mask = 0;
  for (std::size_t part = 0; part < kPartsOfRow; ++part) {
    auto e0 = hn::Add(hn::Set(d, base[0]), steps[0].part[part]);
    auto e1 = hn::Add(hn::Set(d, base[1]), steps[1].part[part]);
    auto e2 = hn::Add(hn::Set(d, base[2]), steps[2].part[part]);
    constexpr auto kRows = static_cast<std::int32_t>(kRowsAtOnce);
    const auto b0 = hn::Set(d, b[0] * kRows), b1 = hn::Set(d, b[1] * kRows),
               b2 = hn::Set(d, b[2] * kRows);
    for (std::size_t row = 0; row < 8; row += kRowsAtOnce) {
      // A negative value of any edge sets the sign bit: outside.
      const auto any = hn::Or(hn::Or(e0, e1), e2);
      std::uint16_t outside = 0;
      hn::StoreMaskBits(d, hn::Lt(any, hn::Zero(d)), reinterpret_cast<std::uint8_t*>(&outside));
      const std::uint64_t inside = static_cast<std::uint64_t>(~outside) & ((1U << kWide) - 1);
      mask |= inside << (row * 8 + part * kWide);
      e0 = hn::Add(e0, b0);
      e1 = hn::Add(e1, b1);
      e2 = hn::Add(e2, b2);
    }
  }
  return mask;
}

/// An edge's value, clamped so that every sum in a block keeps its sign.
HWY_INLINE std::int32_t clamped(std::int64_t value) {
  constexpr std::int64_t kClamp = std::int64_t{1} << 30;
  return static_cast<std::int32_t>(std::clamp(value, -kClamp, kClamp));
}

/// Whether all edge values at the samples of blocks in the piece's box fit int32: with differences
/// up to 2^14 (64 px) and samples up to 8 px outside, |E| < 2 · 2^14 · (2^14 + 2^11) < 2^30.
HWY_INLINE bool is_small(const Piece& p) {
  constexpr int kMost = 1 << 14;
  return max3(p.x[0], p.x[1], p.x[2]) - min3(p.x[0], p.x[1], p.x[2]) < kMost &&
         max3(p.y[0], p.y[1], p.y[2]) - min3(p.y[0], p.y[1], p.y[2]) < kMost;
}

/// A row of a bin's blocks, one a lane.
constexpr std::size_t kRowParts = kBlocksPerBinRow / kLanes;

/// Which blocks of a row a bin's bounds hide: HiddenTest::hides_block in lanes.
class HiddenRow {
 public:
  HWY_INLINE HiddenRow(const Piece& p, const DepthBounds* bounds, Rect bin, int bx0)
      : bounds_(bounds != nullptr && has_depth_bounds(p) ? bounds : nullptr), bin_(bin) {
    constexpr float kPxPerSubpixel = 1.0F / kSubpixels;
    const F32 d;
    y0_ = static_cast<float>(p.y[0]) * kPxPerSubpixel;
    zy_ = p.zy;
    // highest_depth: at the corner that the slopes choose.
    below_ = p.zy > 0 ? kBlockSize - 1 : 0;
    const F x0 = hn::Set(d, static_cast<float>(p.x[0]) * kPxPerSubpixel);
    for (std::size_t part = 0; part < kRowParts; ++part) {
      const int first = (bx0 + static_cast<int>(part * kLanes)) * kBlockSize;
      const F column =
          hn::Add(hn::Set(d, static_cast<float>(first + (p.zx > 0 ? kBlockSize - 1 : 0))),
                  hn::Mul(hn::Iota(d, 0), hn::Set(d, static_cast<float>(kBlockSize))));
      const F dx = hn::Sub(hn::Add(column, hn::Set(d, 0.5F)), x0);
      along_[part] = hn::Add(hn::Set(d, p.z0), hn::Mul(hn::Set(d, p.zx), dx));
    }
  }
  [[nodiscard]] bool hides() const { return bounds_ != nullptr; }
  /// A bit for each block of part `part` of row `by`, from block `bx` on.
  HWY_INLINE std::uint32_t operator()(int bx, int by, std::size_t part) const {
    const F32 d;
    const float dy = (static_cast<float>(by * kBlockSize + below_) + 0.5F) - y0_;
    const F depth = hn::Add(along_[part], hn::Set(d, zy_ * dy));
    const float* const at = bounds_->block +
                            (by * kBlockSize - bin_.y0) / kBlockSize * kBlocksPerBinRow +
                            (bx * kBlockSize - bin_.x0) / kBlockSize;
    // The last row's load may reach beyond the array.
    HWY_ALIGN float own[kLanes] = {};
    const auto n = static_cast<std::size_t>(bounds_->block + kBlocksPerBin - at);
    if (HWY_UNLIKELY(n < kLanes)) std::copy_n(at, n, own);
    const F bound = HWY_UNLIKELY(n < kLanes) ? hn::Load(d, own) : hn::LoadU(d, at);
    // A bound is at most 1, so depths need not be clamped.
    return lane_bits(
        hn::RebindMask(I32{}, hn::And(hn::Gt(bound, hn::Zero(d)), hn::Lt(depth, bound))));
  }

 private:
  const DepthBounds* bounds_;
  Rect bin_;
  F along_[kRowParts];
  float y0_, zy_;
  int below_;
};

/// The blocks of a small piece by rows. Drops blocks that an edge excludes or that are hidden.
/// Blocks inside of all edges are not tested by sample.
template <class Add>
HWY_INLINE void small_cover(const Piece& p, int bx0, int by0, int bx1, int by1, Rect bin,
                            DepthBounds* bounds, const Add& add) {
  const I32 d;
  const int px = bx0 * (kBlockSize * kSubpixels) + kHalfPixel;
  const int py = by0 * (kBlockSize * kSubpixels) + kHalfPixel;
  std::int32_t row_base[3], a[3], b[3], most[3], least[3];
  EdgeSteps steps[3];
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    a[i] = p.y[i] - p.y[j];
    b[i] = p.x[j] - p.x[i];
    row_base[i] = edge_value(a[i], b[i], px - p.x[i], py - p.y[i]) >> kSubpixelBits;
    most[i] = 7 * (std::max(a[i], 0) + std::max(b[i], 0));
    least[i] = 7 * (std::min(a[i], 0) + std::min(b[i], 0));
    steps[i].set(a[i], b[i]);
  }
  const HiddenRow hidden(p, bounds, bin, bx0);
  const auto parts = static_cast<std::size_t>(bx1 - bx0) / kLanes + 1;
  for (int by = by0; by <= by1; ++by) {
    for (std::size_t part = 0; part < parts; ++part) {
      const auto before = static_cast<std::int32_t>(part * kLanes);
      I outside = hn::Zero(d), cut = hn::Zero(d);  // below 0: true
      for (int i = 0; i < 3; ++i) {
        const I first = hn::Add(hn::Set(d, row_base[i] + a[i] * kBlockSize * before),
                                hn::Mul(hn::Set(d, a[i] * kBlockSize), hn::Iota(d, 0)));
        outside = hn::Or(outside, hn::Add(first, hn::Set(d, most[i])));
        cut = hn::Or(cut, hn::Add(first, hn::Set(d, least[i])));
      }
      const int count = std::min(bx1 - bx0 + 1 - before, static_cast<int>(kLanes));
      std::uint32_t touched = ~lane_bits(hn::Lt(outside, hn::Zero(d))) & ((1U << count) - 1);
      if (touched == 0) continue;
      const std::uint32_t partly = lane_bits(hn::Lt(cut, hn::Zero(d)));
      if (hidden.hides()) {
        const std::uint32_t dropped = touched & hidden(bx0 + before, by, part);
        bounds->hidden_blocks += static_cast<std::uint64_t>(std::popcount(dropped));
        touched &= ~dropped;
      }
      for (; touched != 0; touched &= touched - 1) {
        const int lane = std::countr_zero(touched);
        const int bx = bx0 + before + lane;
        if ((partly >> lane & 1) == 0) {
          add(bx, by, ~std::uint64_t{0});
          continue;
        }
        std::int32_t base[3];
        for (int i = 0; i < 3; ++i) base[i] = row_base[i] + a[i] * kBlockSize * (before + lane);
        add(bx, by, cover_block(base, steps, b));
      }
    }
    for (int i = 0; i < 3; ++i) row_base[i] += b[i] * kBlockSize;
  }
}

/// For a quadric that may be visible in `box`.
HWY_INLINE std::size_t cover_quadric_blocks(const Piece& piece, std::uint32_t index, Rect box,
                                            HiddenTest& hidden, Block* out) {
  std::size_t n = 0;
  for (int by = box.y0 / kBlockSize; by <= (box.y1 - 1) / kBlockSize; ++by)
    for (int bx = box.x0 / kBlockSize; bx <= (box.x1 - 1) / kBlockSize; ++bx) {
      if (hidden.hides_block(piece, bx, by)) continue;
      const std::uint64_t mask = quadric_mask(piece, bx, by, box);
      if (mask != 0)
        out[n++] = {index, static_cast<std::uint16_t>(bx), static_cast<std::uint16_t>(by), mask};
    }
  return n;
}

/// Prefetches a piece's quadric, which lies elsewhere and was written long ago: waiting for it took
/// half of the time of a million small spheres.
HWY_INLINE void prefetch_quadric(const Piece& piece) {
  if (!is_quadric(piece)) return;
  const auto* const q = reinterpret_cast<const char*>(&quadric_of(piece));
  __builtin_prefetch(q);
  __builtin_prefetch(q + 64);
}

/// How long before its use a piece is prefetched. Pieces lie anywhere, half of them in two cache
/// lines, and were written long ago.
constexpr std::size_t kAhead = 16;
HWY_INLINE void prefetch_piece(const PieceList& in, std::size_t i) {
  if (i >= in.count) return;
  const auto* const p = reinterpret_cast<const char*>(in.pieces + in.list[i].piece);
  __builtin_prefetch(p);
  __builtin_prefetch(p + sizeof(Piece) - 1);
}

/// Points and lines, by the scalar form, and quadrics. Out of line, so that triangles do not pay
/// for this code.
HWY_NOINLINE std::size_t cover_other(const Piece& piece, std::uint32_t index, Rect bin,
                                     HiddenTest& hidden, Block* out) {
  const Rect box = piece_bounds(piece, bin);
  if (box.empty() || hidden.hides_piece(piece, box)) return 0;
  if (is_quadric(piece)) return cover_quadric_blocks(piece, index, box, hidden, out);
  std::size_t n = 0;
  cover_blocks(
      piece, box, bin, [&](int bx, int by) { return hidden.hides_block(piece, bx, by); },
      [&](int bx, int by, std::uint64_t mask) {
        out[n++] = {index, static_cast<std::uint16_t>(bx), static_cast<std::uint16_t>(by), mask};
      });
  return n;
}

/// For a triangle whose box exceeds 8 × 8 samples. Returns the number of blocks written.
HWY_NOINLINE std::size_t cover_large(const Piece& piece, std::uint32_t index, Rect bin,
                                     DepthBounds* bounds, HiddenTest& hidden, Block* out) {
  const bool cut = bin.x1 % kBlockSize != 0 || bin.y1 % kBlockSize != 0;
  const Rect box = sample_bounds(piece.x, piece.y, bin);
  if (box.empty() || hidden.hides_piece(piece, box)) return 0;
  const int bx0 = box.x0 / kBlockSize, by0 = box.y0 / kBlockSize;
  const int bx1 = (box.x1 - 1) / kBlockSize, by1 = (box.y1 - 1) / kBlockSize;
  std::size_t n = 0;
  const auto add = [&](int bx, int by, std::uint64_t mask) HWY_ATTR {
    if (cut) mask &= samples_inside(bin, bx, by);
    out[n] = {index, static_cast<std::uint16_t>(bx), static_cast<std::uint16_t>(by), mask};
    n += mask != 0;
  };
  if (is_small(piece)) {
    small_cover(piece, bx0, by0, bx1, by1, bin, bounds, add);
    return n;
  }
  std::int32_t b[3];
  std::int64_t row_base[3], block_dx[3], block_dy[3], reach[3], least[3];
  EdgeSteps steps[3];
  for (int i = 0; i < 3; ++i) {
    const Edge e = edge_function(piece, i);
    b[i] = e.b;
    row_base[i] =
        e.base + std::int64_t{e.a} * (bx0 * kBlockSize) + std::int64_t{e.b} * (by0 * kBlockSize);
    block_dx[i] = std::int64_t{e.a} * kBlockSize;
    block_dy[i] = std::int64_t{e.b} * kBlockSize;
    // The largest value in a block relative to its first sample. If the sum is below 0, no sample
    // is in.
    reach[i] = 7 * (std::int64_t{std::max(e.a, 0)} + std::max(e.b, 0));
    // The smallest one. If the sum is at least 0, all samples are in.
    least[i] = 7 * (std::int64_t{std::min(e.a, 0)} + std::min(e.b, 0));
    steps[i].set(e.a, e.b);
  }
  for (int by = by0; by <= by1; ++by) {
    std::int64_t base[3] = {row_base[0], row_base[1], row_base[2]};
    for (int bx = bx0; bx <= bx1; ++bx) {
      if (base[0] + reach[0] >= 0 && base[1] + reach[1] >= 0 && base[2] + reach[2] >= 0 &&
          !hidden.hides_block(piece, bx, by)) {
        if (base[0] + least[0] >= 0 && base[1] + least[1] >= 0 && base[2] + least[2] >= 0)
          add(bx, by, ~std::uint64_t{0});
        else
          add(bx, by,
              cover_block({clamped(base[0]), clamped(base[1]), clamped(base[2])}, steps, b));
      }
      for (int i = 0; i < 3; ++i) base[i] += block_dx[i];
    }
    for (int i = 0; i < 3; ++i) row_base[i] += block_dy[i];
  }
  return n;
}

void bins(const Piece* pieces, std::size_t n, const BinNumbers& numbers,
          std::uint32_t* out) noexcept {
  const I32 d;
  const Rect view = numbers.view;
  const int columns = (view.x1 - view.x0 + kBinSize - 1) / kBinSize;
  const auto bin_of = [&](I sample, int first) HWY_ATTR {
    static_assert(kBinSize == 1 << 6);
    return hn::ShiftRight<6>(hn::Sub(sample, hn::Set(d, first)));
  };
  for (std::size_t i = 0; i < n; i += kLanes) {
    const Piece* lanes[kLanes];
    const std::size_t count = std::min(kLanes, n - i);
    for (std::size_t k = 0; k < kLanes; ++k) lanes[k] = pieces + i + (k < count ? k : 0);
    const Triangles t = load_triangles(lanes, numbers.reach);
    const I x0 = hn::Max(t.x0, hn::Set(d, view.x0)), x1 = hn::Min(t.x1, hn::Set(d, view.x1 - 1));
    const I y0 = hn::Max(t.y0, hn::Set(d, view.y0)), y1 = hn::Min(t.y1, hn::Set(d, view.y1 - 1));
    const I column = bin_of(x0, view.x0), row = bin_of(y0, view.y0);
    const auto one = hn::And(hn::Eq(column, bin_of(x1, view.x0)), hn::Eq(row, bin_of(y1, view.y0)));
    const auto empty = hn::Or(hn::Gt(x0, x1), hn::Gt(y0, y1));
    const I bin = hn::Add(hn::Mul(row, hn::Set(d, columns)), column);
    HWY_ALIGN std::int32_t found[kLanes];
    hn::Store(hn::IfThenElse(hn::AndNot(empty, one), bin, hn::Set(d, -1)), d, found);
    for (std::size_t k = 0; k < count; ++k)
      out[i + k] = has_corners(*lanes[k]) && !is_deferred(*lanes[k]) && found[k] >= 0
                       ? numbers.of(*lanes[k], static_cast<std::uint32_t>(found[k]))
                       : kManyBins;
  }
}

struct SmallPieces {
  HWY_ALIGN std::int32_t x0[kLanes], y0[kLanes];        ///< the first sample of the box
  HWY_ALIGN std::uint32_t top[kLanes], bottom[kLanes];  ///< rows [0, half) and [half, 2 half)
  int half = 0;
  std::uint32_t lanes = 0;  ///< boxes of at most 8 × 8 samples; other lanes are not set

  /// Bit 8 · row + column, from the first sample on.
  [[nodiscard]] std::uint64_t mask(std::size_t lane) const {
    return top[lane] | std::uint64_t{bottom[lane]} << (kBlockSize * half);
  }
};

using U16 = hn::Repartition<std::uint16_t, I32>;
using I16 = hn::Repartition<std::int16_t, I32>;

/// v in both halves of each lane, in 16 bits.
HWY_INLINE I twice(I low, I high) {
  return hn::Or(hn::And(low, hn::Set(I32{}, 0xFFFF)), hn::ShiftLeft<16>(high));
}

/// Computes rows [0, half) into `top` and [half, 2 half) into `bottom` together in 16 bits, from
/// the edges' values at the first sample.
template <int kColumns>
HWY_INLINE void cover_rows(const I (&base)[3], const I (&a)[3], const I (&b)[3], int half, I& top,
                           I& bottom) {
  const I32 d;
  const I16 d16;
  const U16 du16;
  hn::Vec<I16> value[3], dx[3], dy[3];
  for (int i = 0; i < 3; ++i) {
    // Backwards, so that shifting the bits left leaves the first column in bit 0.
    const I last = hn::Add(base[i], hn::Mul(a[i], hn::Set(d, kColumns - 1)));
    value[i] = hn::BitCast(d16, twice(last, hn::Add(last, hn::Mul(b[i], hn::Set(d, half)))));
    dx[i] = hn::BitCast(d16, twice(a[i], a[i]));
    dy[i] = hn::BitCast(d16, twice(b[i], b[i]));
  }
  top = bottom = hn::Zero(d);
  for (int row = 0; row < half; ++row) {
    auto e0 = value[0], e1 = value[1], e2 = value[2];
    auto outside = hn::Zero(du16);
    for (int column = 0; column < kColumns; ++column) {
      // A negative value of any edge sets the sign bit: outside.
      const auto any = hn::BitCast(du16, hn::Or(hn::Or(e0, e1), e2));
      outside = hn::Add(hn::Add(outside, outside), hn::ShiftRight<15>(any));
      e0 = hn::Sub(e0, dx[0]);
      e1 = hn::Sub(e1, dx[1]);
      e2 = hn::Sub(e2, dx[2]);
    }
    for (int i = 0; i < 3; ++i) value[i] = hn::Add(value[i], dy[i]);
    const I inside = hn::BitCast(d, hn::AndNot(outside, hn::Set(du16, (1U << kColumns) - 1)));
    top = hn::Or(top, hn::ShiftLeftSame(hn::And(inside, hn::Set(d, 0xFF)), row * kBlockSize));
    bottom = hn::Or(bottom, hn::ShiftLeftSame(hn::ShiftRight<16>(inside), row * kBlockSize));
  }
}

/// Covers kLanes pieces of any kind. Where a box has at most 8 × 8 samples, the vertices and the 8
/// × 8 samples from its first on lie in a square of less than 9 px, s = 2304 / 256 px. An edge
/// function there is twice the area of a triangle in that square, |E| ≤ s². So products fit int32,
/// and ⌊(E − 1) / 256⌋ ≥ −20,737 and its steps fit int16. Intermediate sums may wrap, which the
/// final sum undoes.
HWY_INLINE void cover_small(const Triangles& t, SmallPieces& out) {
  const I32 d;
  const auto &x = t.x, &y = t.y;
  const I x0 = t.x0, y0 = t.y0, x1 = t.x1, y1 = t.y1;
  const I last_column = hn::Sub(x1, x0), last_row = hn::Sub(y1, y0);
  const I half_pixel = hn::Set(d, kHalfPixel);
  const I size = hn::Set(d, kBlockSize);
  const auto small = hn::And(hn::Lt(last_column, size), hn::Lt(last_row, size));
  out.lanes = lane_bits(small);
  if (out.lanes == 0) return;

  const I px = hn::Add(hn::ShiftLeft<kSubpixelBits>(x0), half_pixel);
  const I py = hn::Add(hn::ShiftLeft<kSubpixelBits>(y0), half_pixel);
  I base[3], a[3], b[3];
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    a[i] = hn::Sub(y[i], y[j]);
    b[i] = hn::Sub(x[j], x[i]);
    base[i] =
        hn::ShiftRight<kSubpixelBits>(edge_lanes(a[i], b[i], hn::Sub(px, x[i]), hn::Sub(py, y[i])));
  }
  // As many rows and columns as the largest box.
  const auto any_beyond = [&](I last, int n) HWY_ATTR {
    return (lane_bits(hn::Gt(last, hn::Set(d, n - 1))) & out.lanes) != 0;
  };
  out.half = any_beyond(last_row, 4) ? 3 + any_beyond(last_row, 6) : 1 + any_beyond(last_row, 2);
  I top, bottom;
  if (!any_beyond(last_column, 4))
    cover_rows<4>(base, a, b, out.half, top, bottom);
  else if (!any_beyond(last_column, 6))
    cover_rows<6>(base, a, b, out.half, top, bottom);
  else
    cover_rows<8>(base, a, b, out.half, top, bottom);
  hn::Store(x0, d, out.x0);
  hn::Store(y0, d, out.y0);
  hn::Store(hn::BitCast(U32{}, top), U32{}, out.top);
  hn::Store(hn::BitCast(U32{}, bottom), U32{}, out.bottom);
}

/// columns(k): all rows, the first 8 − k columns.
constexpr std::uint64_t columns(int k) {
  return (std::uint64_t{0xFF} >> k) * 0x0101010101010101U;
}

/// Cuts the mask of a small piece, from sample (x0, y0) on, along up to four blocks of `bin`. A bin
/// drawn in parts has pieces that touch only other parts. Out of line: it needs all registers.
HWY_NOINLINE std::size_t split_small(std::uint64_t mask, int x0, int y0, std::uint32_t index,
                                     const Rect& bin, Block* out) {
  static_assert(std::endian::native == std::endian::little);
  const int bx = x0 >> 3, by = y0 >> 3, sx = x0 & 7, sy = y0 & 7;
  const std::uint64_t keep = columns(sx);
  // This block has columns keep << sx, so the next block's others are its complement.
  std::uint64_t left = (mask & keep) << sx;
  std::uint64_t right = mask >> (8 - sx) & ~(keep << sx);
  // False also if no sample of the box is in `bin`, which may be a part of the list's bin.
  const auto is_between = [](int v, int begin, int end) {
    return static_cast<unsigned>(v - begin) < static_cast<unsigned>(end - begin);
  };
  left = is_between(bx * kBlockSize, bin.x0, bin.x1) ? left : 0;
  right = is_between((bx + 1) * kBlockSize, bin.x0, bin.x1) ? right : 0;
  const std::uint64_t rows = ~std::uint64_t{0} << (8 * sy);
  const std::uint64_t top = is_between(by * kBlockSize, bin.y0, bin.y1) ? rows : 0;
  const std::uint64_t bottom = is_between((by + 1) * kBlockSize, bin.y0, bin.y1) ? ~rows : 0;
  // A Block's first half. With sums a negative bx borrows from by what bx + 1 returns.
  constexpr std::uint64_t kOneX = std::uint64_t{1} << 32, kOneY = std::uint64_t{1} << 48;
  const std::uint64_t at =
      index + static_cast<std::uint64_t>(bx) * kOneX + static_cast<std::uint64_t>(by) * kOneY;
  std::size_t n = 0;
  const auto add = [&](std::uint64_t place, std::uint64_t part) {
    const std::uint64_t both[2] = {place, part};
    std::memcpy(out + n, both, sizeof(Block));
    n += part != 0;
  };
  left = std::rotl(left, 8 * sy);
  right = std::rotl(right, 8 * sy);
  add(at, left & top);
  add(at + kOneX, right & top);
  add(at + kOneY, left & bottom);
  add(at + kOneX + kOneY, right & bottom);
  return n;
}

/// Keeps the samples in `bin`. Returns the number of blocks left.
HWY_NOINLINE std::size_t cut_blocks(Rect bin, Block* blocks, std::size_t n) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < n; ++i) {
    Block block = blocks[i];
    block.mask &= samples_inside(bin, block.bx, block.by);
    blocks[kept] = block;
    kept += block.mask != 0;
  }
  return kept;
}

/// Vectors of a row's keys; kLanes samples make one or two.
using Keys = hn::CappedTag<std::int64_t, kLanes>;
constexpr std::size_t kKeys = hn::MaxLanes(Keys{});

/// Part `part` of kLanes numbers, widened to 64 bits.
HWY_INLINE hn::Vec<Keys> widened(I v, [[maybe_unused]] std::size_t part) {
#if HWY_MAX_BYTES >= 64
  return hn::PromoteTo(Keys{}, v);
#else
  const hn::Half<I32> dh;
  return hn::PromoteTo(Keys{}, part == 0 ? hn::LowerHalf(dh, v) : hn::UpperHalf(dh, v));
#endif
}

/// The box and the fragments of all triangles so far, by lane.
struct RowTally {
  I left, top, right, bottom;  ///< box of all, inclusive
  std::uint64_t fragments = 0;

  HWY_INLINE explicit RowTally(Rect bin) {
    const I32 d;
    left = hn::Set(d, bin.x1);
    top = hn::Set(d, bin.y1);
    right = hn::Set(d, bin.x0 - 1);
    bottom = hn::Set(d, bin.y0 - 1);
  }
  /// `x`, `y`: the picture's pixel from which the box counts.
  HWY_INLINE void add_to(RowKeys& rows, int x = 0, int y = 0) const {
    const I32 d;
    Rect& box = rows.touched;
    box.x0 = std::min(box.x0, x + hn::GetLane(hn::MinOfLanes(d, left)));
    box.y0 = std::min(box.y0, y + hn::GetLane(hn::MinOfLanes(d, top)));
    box.x1 = std::max(box.x1, x + hn::GetLane(hn::MaxOfLanes(d, right)) + 1);
    box.y1 = std::max(box.y1, y + hn::GetLane(hn::MaxOfLanes(d, bottom)) + 1);
    rows.fragments += fragments;
  }
};

/// kLanes triangles that raise rows. With a box of up to 16 px the vertices lie in a square of less
/// than 18 px and the tested samples in one of 24, so edge functions stay below 2^27.
struct RowTriangles {
  HWY_ALIGN std::int32_t a[3][kLanes], b[3][kLanes];  ///< change of edges by a pixel
  HWY_ALIGN std::int32_t value[3][kLanes];            ///< at the first sample
  HWY_ALIGN std::int32_t x0[kLanes], y0[kLanes], x1[kLanes], y1[kLanes];  ///< box, inclusive
  HWY_ALIGN float x[kLanes], y[kLanes];                                   ///< first vertex, px
  std::uint32_t lanes;  ///< lanes with such triangles
  std::uint32_t some;   ///< those that have a sample in the bin

  HWY_INLINE void find(const Triangles& t, std::uint32_t of, Rect bin, RowTally& tally) {
    const I32 d;
    const F32 df;
    const I zero = hn::Zero(d), half = hn::Set(d, kHalfPixel);
    const auto small = hn::And(hn::Lt(hn::Sub(t.x1, t.x0), hn::Set(d, kMostRows)),
                               hn::Lt(hn::Sub(t.y1, t.y0), hn::Set(d, kMostRows)));
    lanes = some = lane_bits(small) & of;
    if (lanes == 0) return;
    const I other = hn::And(
        t.flags, hn::Set(d, static_cast<std::int32_t>(kMayDrop | kLine | kPoint | kQuadric)));
    lanes &= lane_bits(hn::Eq(other, zero));
    const I left = hn::Max(t.x0, hn::Set(d, bin.x0)), top = hn::Max(t.y0, hn::Set(d, bin.y0));
    const I right = hn::Min(t.x1, hn::Set(d, bin.x1 - 1));
    const I bottom = hn::Min(t.y1, hn::Set(d, bin.y1 - 1));
    some = lanes & ~lane_bits(hn::Or(hn::Gt(left, right), hn::Gt(top, bottom)));
    if (some == 0) return;
    hn::Store(left, d, x0);
    hn::Store(top, d, y0);
    hn::Store(right, d, x1);
    hn::Store(bottom, d, y1);
    const I px = hn::Add(hn::ShiftLeft<kSubpixelBits>(left), half);
    const I py = hn::Add(hn::ShiftLeft<kSubpixelBits>(top), half);
    for (int i = 0; i < 3; ++i) {
      const int j = i == 2 ? 0 : i + 1;
      const I ea = hn::Sub(t.y[i], t.y[j]), eb = hn::Sub(t.x[j], t.x[i]);
      hn::Store(hn::ShiftLeft<kSubpixelBits>(ea), d, a[i]);
      hn::Store(hn::ShiftLeft<kSubpixelBits>(eb), d, b[i]);
      hn::Store(edge_lanes(ea, eb, hn::Sub(px, t.x[i]), hn::Sub(py, t.y[i])), d, value[i]);
    }
    const F px_per_subpixel = hn::Set(df, 1.0F / kSubpixels);
    hn::Store(hn::Mul(hn::ConvertTo(df, t.x[0]), px_per_subpixel), df, x);
    hn::Store(hn::Mul(hn::ConvertTo(df, t.y[0]), px_per_subpixel), df, y);
    const auto drawn = hn::RebindMask(d, lane_mask(some));
    tally.left = hn::IfThenElse(drawn, hn::Min(tally.left, left), tally.left);
    tally.top = hn::IfThenElse(drawn, hn::Min(tally.top, top), tally.top);
    tally.right = hn::IfThenElse(drawn, hn::Max(tally.right, right), tally.right);
    tally.bottom = hn::IfThenElse(drawn, hn::Max(tally.bottom, bottom), tally.bottom);
  }
};

HWY_INLINE std::uint64_t low_of(const Piece& p) {
  return p.low;
}
HWY_INLINE std::uint64_t low_of(const BinTriangle& t) {
  return kIdMask - t.id;
}

/// Raises the rows of a triangle. `outside` counts down the tested samples that are not covered.
/// Returns the number of tested samples.
template <class Triangle>
HWY_INLINE std::uint64_t raise_rows(const Triangle& p, const RowTriangles& t, std::size_t lane,
                                    Rect bin, std::uint64_t* keys, I& outside) {
  const I32 d;
  const F32 df;
  const Keys dk;
  const int x1 = t.x1[lane], y0 = t.y0[lane], y1 = t.y1[lane];
  const I iota = hn::Iota(d, 0);
  const F half = hn::Set(df, 0.5F), zero = hn::Zero(df), one = hn::Set(df, 1.0F);
  const F first_y = hn::Add(hn::Set(df, static_cast<float>(y0)), half);
  const F x = hn::Set(df, t.x[lane]), y = hn::Set(df, t.y[lane]);
  const F z0 = hn::Set(df, p.z0), zx = hn::Set(df, p.zx), zy = hn::Set(df, p.zy);
  const I dy0 = hn::Set(d, t.b[0][lane]), dy1 = hn::Set(d, t.b[1][lane]),
          dy2 = hn::Set(d, t.b[2][lane]);
  const auto low = hn::Set(dk, static_cast<std::int64_t>(low_of(p)));
  std::uint64_t looked = 0;
  for (int x0 = t.x0[lane]; x0 <= x1; x0 += static_cast<int>(kLanes)) {
    const I column = hn::Add(hn::Set(d, x0), iota);
    const I from_first = hn::Sub(column, hn::Set(d, t.x0[lane]));
    const auto edge = [&](std::size_t i) HWY_ATTR {
      return hn::Add(hn::Set(d, t.value[i][lane]), hn::Mul(hn::Set(d, t.a[i][lane]), from_first));
    };
    // Columns beyond the box are outside in all rows: they may be another bin's.
    I e0 = hn::IfThenElse(hn::Gt(column, hn::Set(d, x1)), hn::Set(d, -(1 << 30)), edge(0));
    I e1 = edge(1), e2 = edge(2);
    // The depth formula in lanes.
    const F along = hn::Add(z0, hn::Mul(zx, hn::Sub(hn::Add(hn::ConvertTo(df, column), half), x)));
    F sample_y = first_y;
    std::uint64_t* at = keys + static_cast<std::size_t>(y0 - bin.y0) * RowKeys::kRow +
                        static_cast<std::size_t>(x0 - bin.x0);
    for (int row = y0; row <= y1; ++row, at += RowKeys::kRow) {
      // A negative value of any edge sets the sign bit: outside.
      const I out = hn::BroadcastSignBit(hn::Or(hn::Or(e0, e1), e2));
      outside = hn::Add(outside, out);
      F depth = hn::Add(along, hn::Mul(zy, hn::Sub(sample_y, y)));
      depth = hn::Min(hn::IfThenElseZero(hn::Gt(depth, zero), depth), one);
      const I bits = hn::BitCast(d, depth);
      for (std::size_t part = 0; part < kLanes / kKeys; ++part) {
        const auto key = hn::AndNot(widened(out, part),
                                    hn::Or(hn::ShiftLeft<kIdBits>(widened(bits, part)), low));
        auto* const place = reinterpret_cast<std::int64_t*>(at + part * kKeys);
        // Keys stay below 2^63, so the signed maximum is the maximum.
        hn::StoreU(hn::Max(hn::LoadU(dk, place), key), dk, place);
      }
      e0 = hn::Add(e0, dy0);
      e1 = hn::Add(e1, dy1);
      e2 = hn::Add(e2, dy2);
      sample_y = hn::Add(sample_y, one);
    }
    looked += static_cast<std::uint64_t>(y1 - y0 + 1) * kLanes;
  }
  return looked;
}

/// Counts a triangle for the next update of depth bounds: a small one in the block where its box
/// begins, one larger than a block several times in all its blocks, since it covers more of them.
HWY_INLINE void count_blocks(const RowTriangles& t, std::size_t lane, Rect bin, RowKeys& rows) {
  constexpr std::uint32_t kLarge = 8;
  const std::int32_t x0 = t.x0[lane] - bin.x0, x1 = t.x1[lane] - bin.x0;
  const std::int32_t y0 = t.y0[lane] - bin.y0, y1 = t.y1[lane] - bin.y0;
  if (x1 - x0 < kBlockSize && y1 - y0 < kBlockSize) {
    ++rows.unseen[y0 / kBlockSize * kBlocksPerBinRow + x0 / kBlockSize];
    return;
  }
  for (int by = y0 / kBlockSize; by <= y1 / kBlockSize; ++by)
    for (int bx = x0 / kBlockSize; bx <= x1 / kBlockSize; ++bx)
      rows.unseen[by * kBlocksPerBinRow + bx] += kLarge;
}

/// Out of line: it needs all registers.
template <class Triangle>
HWY_NOINLINE void raise_rows(const Triangle* const (&pieces)[kLanes], const RowTriangles& t,
                             std::uint32_t lanes, Rect bin, RowKeys& rows, RowTally& tally) {
  I outside = hn::Zero(I32{});
  std::uint64_t looked = 0;
  for (std::uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
    count_blocks(t, lane, bin, rows);
    looked += raise_rows(*pieces[lane], t, lane, bin, rows.keys, outside);
  }
  // Each sample that is not covered counted −1.
  const std::int64_t not_covered = hn::GetLane(hn::SumOfLanes(I32{}, outside));
  tally.fragments += looked + static_cast<std::uint64_t>(not_covered);
}

/// kLanes small triangles, relative to their bin.
HWY_INLINE Triangles load_small(const BinTriangle* const (&lanes)[kLanes]) {
  const I32 d;
  I first[4], second[4];
  load_numbers(lanes, 0, first);
  load_numbers(lanes, 1, second);
  Triangles t;
  for (int i = 0; i < 3; ++i) {
    t.x[i] = hn::ShiftRight<16>(hn::ShiftLeft<16>(first[i]));
    t.y[i] = hn::ShiftRight<16>(first[i]);
  }
  t.z0 = hn::BitCast(F32{}, first[3]);
  t.zx = hn::BitCast(F32{}, second[0]);
  t.zy = hn::BitCast(F32{}, second[1]);
  t.flags = hn::Zero(d);
  find_boxes(t);
  return t;
}

void raise_small(const BinTriangle* triangles, std::size_t n, int bin_x, int bin_y, Rect rect,
                 DepthBounds* bounds, RowKeys& rows) noexcept {
  // Relative to the bin's first pixel: differences are the same.
  const Rect bin{rect.x0 - bin_x, rect.y0 - bin_y, rect.x1 - bin_x, rect.y1 - bin_y};
  const bool hides = bounds != nullptr && knows_depths(*bounds);
  SquareBounds squares;
  if (hides) squares.find(*bounds);
  RowTriangles of_rows;
  RowTally tally(bin);
  for (std::size_t i = 0; i < n; i += kLanes) {
    const BinTriangle* lanes[kLanes];
    const std::size_t count = std::min(kLanes, n - i);
    for (std::size_t k = 0; k < kLanes; ++k) lanes[k] = triangles + i + (k < count ? k : 0);
    const Triangles t = load_small(lanes);
    std::uint32_t seen = (1U << count) - 1;
    if (hides) {
      const std::uint32_t hidden = hidden_lanes(t, bin, squares) & seen;
      bounds->hidden_pieces += static_cast<std::uint64_t>(std::popcount(hidden));
      seen &= ~hidden;
      if (seen == 0) continue;
    }
    of_rows.find(t, seen, bin, tally);
    raise_rows(lanes, of_rows, of_rows.some, bin, rows, tally);
  }
  tally.add_to(rows, bin_x, bin_y);
}

/// With fewer pieces, blocks are faster: a bin's blocks take its rows in the time of some forty
/// small triangles.
constexpr std::size_t kWorthRows = 32;

/// The window of a small piece with a mask from sample (x0, y0) on; none if no sample is in `bin`.
HWY_INLINE std::size_t add_window(std::uint64_t mask, int x0, int y0, std::uint32_t index,
                                  const Rect& bin, Block* out) {
  int x = x0 - bin.x0, y = y0 - bin.y0;
  const int right = bin.x1 - x0, down = bin.y1 - y0;
  if (HWY_UNLIKELY(std::min(x, y) < 0 || std::min(right, down) < kBlockSize)) {
    if (std::min(right, down) <= 0 || std::min(x, y) <= -kBlockSize) return 0;
    if (right < kBlockSize) mask &= columns(kBlockSize - right);
    if (down < kBlockSize) mask &= ~std::uint64_t{0} >> (kBlockSize * (kBlockSize - down));
    // Moves its start into the bin.
    if (x < 0) mask = mask >> -x & columns(-x);
    if (y < 0) mask >>= kBlockSize * -y;
    x = std::max(x, 0);
    y = std::max(y, 0);
  }
  *out = {index, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), mask};
  return mask != 0;
}

template <bool kWindows>
HWY_INLINE std::size_t cover_list(const PieceList& in, std::size_t& cursor, Rect bin, Block* out,
                                  std::size_t capacity, DepthBounds* bounds,
                                  [[maybe_unused]] RowKeys* rows) {
  const bool cut = bin.x1 % kBlockSize != 0 || bin.y1 % kBlockSize != 0;
  if (in.count < kWorthRows) rows = nullptr;
  const std::size_t end = rows != nullptr ? std::min(in.count, cursor + kMostRowPieces) : in.count;
  const bool hides = bounds != nullptr && knows_depths(*bounds);
  SquareBounds squares;
  if (hides) squares.find(*bounds);
  HiddenTest hidden(bounds, bin);
  SmallPieces small;
  RowTriangles of_rows;
  of_rows.lanes = of_rows.some = 0;
  RowTally tally(bin);
  std::size_t n = 0;
  for (std::size_t i = 0; i < kAhead; ++i) prefetch_piece(in, cursor + i);
  while (cursor < end) {
    const Piece* pieces[kLanes];
    const std::size_t count = std::min(kLanes, end - cursor);
    for (std::size_t i = 0; i < kLanes; ++i) {
      pieces[i] = in.pieces + in.list[cursor + (i < count ? i : 0)].piece;
      prefetch_piece(in, cursor + kAhead + i);
    }
    const Triangles t = load_triangles(pieces);
    const I32 d;
    if (!hn::AllTrue(d, hn::Eq(hn::And(t.flags, hn::Set(d, int{kQuadric})), hn::Zero(d))))
      for (const Piece* const piece : pieces) prefetch_quadric(*piece);
    std::uint32_t dropped = 0;
    if (hides) {
      dropped = hidden_lanes(t, bin, squares) & ((1U << count) - 1);
      if (dropped == (1U << count) - 1) {
        bounds->hidden_pieces += count;
        cursor += count;
        continue;
      }
    }
    if (rows != nullptr) {
      const std::uint32_t seen = ((1U << count) - 1) & ~dropped;
      of_rows.find(t, seen, bin, tally);
      if (of_rows.lanes == seen) {
        raise_rows(pieces, of_rows, of_rows.some, bin, *rows, tally);
        if (dropped != 0)
          bounds->hidden_pieces += static_cast<std::uint64_t>(std::popcount(dropped));
        cursor += count;
        continue;
      }
    }
    cover_small(t, small);
    for (std::size_t i = 0; i < count; ++i, ++cursor) {
      if (n + kBlocksPerBin > capacity) {
        if (rows != nullptr) tally.add_to(*rows);
        return n;
      }
      if ((dropped >> i & 1) != 0) {
        ++bounds->hidden_pieces;
        continue;
      }
      if ((of_rows.lanes >> i & 1) != 0) {
        raise_rows(pieces, of_rows, of_rows.some & 1U << i, bin, *rows, tally);
        continue;
      }
      const Piece& piece = *pieces[i];
      const std::uint32_t index = in.list[cursor].piece;
      std::size_t written = 0;
      if (!is_triangle(piece)) {
        written = cover_other(piece, index, bin, hidden, out + n);
      } else if ((small.lanes >> i & 1) == 0) {
        written = cover_large(piece, index, bin, bounds, hidden, out + n);
      } else if (kWindows && (piece.flags & (kTranslucent | kClipped)) == kTranslucent) {
        n += add_window(small.mask(i), small.x0[i], small.y0[i], index, bin, out + n);
        continue;
      } else {
        written = split_small(small.mask(i), small.x0[i], small.y0[i], index, bin, out + n);
        if (cut) written = cut_blocks(bin, out + n, written);
      }
      if constexpr (kWindows)
        for (std::size_t k = n; k < n + written; ++k) {
          out[k].bx = static_cast<std::uint16_t>(out[k].bx * kBlockSize - bin.x0);
          out[k].by = static_cast<std::uint16_t>(out[k].by * kBlockSize - bin.y0);
        }
      n += written;
    }
  }
  if (rows != nullptr) tally.add_to(*rows);
  return n;
}

std::size_t cover(const PieceList& in, std::size_t& cursor, Rect bin, Block* out,
                  std::size_t capacity, DepthBounds* bounds, RowKeys* rows) noexcept {
  return cover_list<false>(in, cursor, bin, out, capacity, bounds, rows);
}

std::size_t windows(const PieceList& in, std::size_t& cursor, Rect bin, Block* out,
                    std::size_t capacity, DepthBounds* bounds) noexcept {
  return cover_list<true>(in, cursor, bin, out, capacity, bounds, nullptr);
}

void masks(const Piece* pieces, Block* blocks, std::size_t n) noexcept {
  for (std::size_t k = 0; k < n; ++k) {
    Block& block = blocks[k];
    if (block.mask != 0) continue;
    if (is_quadric(pieces[block.piece])) {
      const Piece& piece = pieces[block.piece];
      const int x0 = block.bx * kBlockSize, y0 = block.by * kBlockSize;
      const Rect box = sample_bounds(piece.x, piece.y, {x0, y0, x0 + kBlockSize, y0 + kBlockSize});
      if (!box.empty()) block.mask = quadric_mask(piece, block.bx, block.by, box);
      continue;
    }
    if (!is_triangle(pieces[block.piece])) {
      block.mask = cover_8x8(pieces[block.piece], block.bx, block.by);
      continue;
    }
    std::int32_t base[3], b[3];
    EdgeSteps steps[3];
    for (int i = 0; i < 3; ++i) {
      const Edge e = edge_function(pieces[block.piece], i);
      b[i] = e.b;
      base[i] = clamped(e.base + std::int64_t{e.a} * (block.bx * kBlockSize) +
                        std::int64_t{e.b} * (block.by * kBlockSize));
      steps[i].set(e.a, e.b);
    }
    block.mask = cover_block(base, steps, b);
  }
}

void fill(Kernels& table) {
  table.bins = bins;
  table.cover = cover;
  table.raise_small = raise_small;
  table.masks = masks;
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::raster {

namespace {

/// All are blocks.
std::size_t windows_scalar(const PieceList& in, std::size_t& cursor, Rect bin, Block* out,
                           std::size_t capacity, DepthBounds* bounds) noexcept {
  const std::size_t n = kernels(Isa::scalar).cover(in, cursor, bin, out, capacity, bounds, nullptr);
  for (Block& b : std::span(out, n)) {
    b.bx = static_cast<std::uint16_t>(b.bx * kBlockSize - bin.x0);
    b.by = static_cast<std::uint16_t>(b.by * kBlockSize - bin.y0);
  }
  return n;
}

}  // namespace

CoverWindows cover_windows(Isa isa) noexcept {
  static constexpr CoverWindows kWindows[] = RASTRUM_BY_ISA(windows, windows_scalar);
  return kWindows[static_cast<std::size_t>(isa)];
}

FillKernels fill_cover_kernels(Isa isa) noexcept {
  static constexpr FillKernels kFill[] = RASTRUM_BY_ISA(fill, nullptr);
  return kFill[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::raster
#endif
