// SPDX-License-Identifier: BSD-3-Clause
// Operations on the keys of 8 × 8 blocks with Highway, compiled once per instruction set: the
// maximum and the conversion to 8-bit colours, with the scalar forms' operations, order and bits
// (make_piece.hpp, color.hpp).

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/cover/blocks_simd.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <limits>

#include <rastrum/raster/cover/quadric_kernels-inl.hpp>
#include <rastrum/raster/kernels/kernels_simd.hpp>
#include <rastrum/raster/kernels/lane_math-inl.hpp>
#include <rastrum/raster/rules/color.hpp>
#include <rastrum/raster/rules/srgb.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2

/// The depths of a block's rows, by parts of columns: the depth formula in lanes.
struct DepthRows {
  F along_x[8 / kLanes];
  float y0, zy;
  int first_row;

  HWY_INLINE DepthRows(const Piece& p, const Block& block) {
    constexpr float kPxPerSubpixel = 1.0F / kSubpixels;
    const F32 d;
    const float x0 = static_cast<float>(p.x[0]) * kPxPerSubpixel;
    y0 = static_cast<float>(p.y[0]) * kPxPerSubpixel;
    zy = p.zy;
    first_row = block.by * kBlockSize;
    for (std::size_t part = 0; part < 8 / kLanes; ++part) {
      const F column = hn::Iota(
          d, static_cast<float>(block.bx * kBlockSize) + static_cast<float>(part * kLanes));
      const F dx = hn::Sub(hn::Add(column, hn::Set(d, 0.5F)), hn::Set(d, x0));
      along_x[part] = hn::Add(hn::Set(d, p.z0), hn::Mul(hn::Set(d, p.zx), dx));
    }
  }
  HWY_INLINE F at(int row, std::size_t part) const {
    const float dy = (static_cast<float>(first_row + row) + 0.5F) - y0;
    return hn::Add(along_x[part], hn::Set(F32{}, zy * dy));
  }
};

/// For each kLanes64 samples with some in `mask`, the bit of the first.
HWY_INLINE std::uint64_t parts_of(std::uint64_t mask) {
  mask |= mask >> 1;
  if constexpr (kLanes64 == 4) mask |= mask >> 2;
  return mask & (kLanes64 == 4 ? 0x1111111111111111U : 0x5555555555555555U);
}

HWY_NOINLINE void raise_quadric(const Piece& piece, const Block& block, std::uint64_t* out) {
  HWY_ALIGN std::uint64_t keys[64];
  quadric_keys(piece, block, keys);
  const I64 d;
  for (std::uint64_t rest = parts_of(block.mask); rest != 0; rest &= rest - 1) {
    const int first = std::countr_zero(rest);
    const std::uint64_t bits = block.mask >> first & ((1U << kLanes64) - 1);
    const auto key = hn::And(hn::Load(d, reinterpret_cast<const std::int64_t*>(keys + first)),
                             hn::Load(d, kLaneTable.keep[bits]));
    auto* const place = reinterpret_cast<std::int64_t*>(out + first);
    hn::Store(hn::Max(hn::Load(d, place), key), d, place);
  }
}

#if HWY_MAX_BYTES >= 64
/// Raises a block by a triangle, line or point, two rows at a time.
HWY_INLINE void raise(const Piece& p, const Block& block, std::uint64_t* out) {
  constexpr float kPxPerSubpixel = 1.0F / kSubpixels;
  const hn::CappedTag<float, 16> d;
  const hn::RebindToSigned<hn::CappedTag<float, 16>> di;
  const hn::CappedTag<std::int64_t, 8> d64;
  const hn::Half<hn::RebindToSigned<hn::CappedTag<float, 16>>> dh;
  const auto lane = hn::Iota(di, 0);
  // The depth formula in lanes: its parts by column and by row.
  const auto px = [&](int first, hn::Vec<decltype(di)> more) HWY_ATTR {
    return hn::Add(hn::ConvertTo(d, hn::Add(hn::Set(di, first), more)), hn::Set(d, 0.5F));
  };
  const auto dx = hn::Sub(px(block.bx * kBlockSize, hn::And(lane, hn::Set(di, 7))),
                          hn::Set(d, static_cast<float>(p.x[0]) * kPxPerSubpixel));
  const auto by_column = hn::Add(hn::Set(d, p.z0), hn::Mul(hn::Set(d, p.zx), dx));
  const auto y0 = hn::Set(d, static_cast<float>(p.y[0]) * kPxPerSubpixel);
  const auto zy = hn::Set(d, p.zy);
  const auto low = hn::Set(d64, static_cast<std::int64_t>(p.low));
  auto row = px(block.by * kBlockSize, hn::ShiftRight<3>(lane));
  std::uint64_t mask = block.mask;
  for (int first = 0; first < 64; first += 16, mask >>= 16, row = hn::Add(row, hn::Set(d, 2.0F))) {
    if ((mask & 0xFFFF) == 0) continue;
    auto depth = hn::Add(by_column, hn::Mul(zy, hn::Sub(row, y0)));
    depth = hn::IfThenElseZero(hn::Gt(depth, hn::Zero(d)), depth);
    const auto bits = hn::BitCast(di, hn::Min(depth, hn::Set(d, 1.0F)));
    const auto raise_row = [&](hn::Vec<decltype(dh)> half, int at) HWY_ATTR {
      const auto key = hn::Or(hn::ShiftLeft<kIdBits>(hn::PromoteTo(d64, half)), low);
      const std::uint64_t seen = mask >> at & 0xFF;  // eight bytes are read
      // Keys stay below 2^63, so the signed maximum is the maximum.
      auto* const place = reinterpret_cast<std::int64_t*>(out + first + at);
      const auto raised = hn::IfThenElseZero(
          hn::LoadMaskBits(d64, reinterpret_cast<const std::uint8_t*>(&seen)), key);
      hn::Store(hn::Max(hn::Load(d64, place), raised), d64, place);
    };
    raise_row(hn::LowerHalf(dh, bits), 0);
    raise_row(hn::UpperHalf(dh, bits), 8);
  }
}
#else
/// In parts of a row as wide as a vector of keys, since most masks have a few samples in each of a
/// few rows.
HWY_INLINE void raise(const Piece& p, const Block& block, std::uint64_t* out) {
  constexpr float kPxPerSubpixel = 1.0F / kSubpixels;
  const F32 d;
  const hn::Half<F32> dh;
  const I64 d64;
  const F half_px = hn::Set(d, 0.5F);
  // The depth formula in lanes: its parts by column and by row.
  HWY_ALIGN float by_column[8], by_row[8];
  const auto fill = [&](float first_px, std::int32_t origin, float slope, float plus, bool adds,
                        float* to) HWY_ATTR {
    for (std::size_t part = 0; part < 8; part += kLanes) {
      const F px = hn::Add(hn::Iota(d, first_px + static_cast<float>(part)), half_px);
      const F at = hn::Sub(px, hn::Set(d, static_cast<float>(origin) * kPxPerSubpixel));
      const F change = hn::Mul(hn::Set(d, slope), at);
      hn::Store(adds ? hn::Add(hn::Set(d, plus), change) : change, d, to + part);
    }
  };
  fill(static_cast<float>(block.bx * kBlockSize), p.x[0], p.zx, p.z0, true, by_column);
  fill(static_cast<float>(block.by * kBlockSize), p.y[0], p.zy, 0, false, by_row);
  const auto low = hn::Set(d64, static_cast<std::int64_t>(p.low));
  const std::uint64_t mask = block.mask;
  const auto key_at = [&](int first) HWY_ATTR {
    auto depth = hn::Add(hn::Load(dh, by_column + first % kBlockSize),
                         hn::Set(dh, by_row[first / kBlockSize]));
    depth = hn::IfThenElseZero(hn::Gt(depth, hn::Zero(dh)), depth);
    depth = hn::Min(depth, hn::Set(dh, 1.0F));
    const auto high = hn::PromoteTo(d64, hn::BitCast(hn::RebindToSigned<hn::Half<F32>>(), depth));
    return hn::Or(hn::ShiftLeft<kIdBits>(high), low);
  };
  const auto raise_part = [&](int first, hn::Vec<I64> key) HWY_ATTR {
    // Keys stay below 2^63, so the signed maximum, which AVX2 has, is the maximum.
    auto* place = reinterpret_cast<std::int64_t*>(out + first);
    hn::Store(hn::Max(hn::Load(d64, place), key), d64, place);
  };
  if (mask == ~std::uint64_t{0}) {
    for (int first = 0; first < 64; first += static_cast<int>(kLanes64))
      raise_part(first, key_at(first));
    return;
  }
  for (std::uint64_t rest = parts_of(mask); rest != 0; rest &= rest - 1) {
    const int first = std::countr_zero(rest);
    const std::uint64_t bits = mask >> first & ((1U << kLanes64) - 1);
    raise_part(first, hn::And(key_at(first), hn::Load(d64, kLaneTable.keep[bits])));
  }
}
#endif

void maximum(const Piece* pieces, const Block* blocks, std::size_t n,
             const SurfaceView& surface) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const Block& block = blocks[i];
    const Piece& p = pieces[block.piece];
    std::uint64_t* const out = surface.block(block.bx, block.by);
    if (is_quadric(p))
      raise_quadric(p, block, out);
    else
      raise(p, block, out);
  }
}

void keys(const Piece& piece, const Block& block, std::uint64_t* out) noexcept {
  if (is_quadric(piece)) return quadric_keys(piece, block, out);
  const hn::RebindToUnsigned<I64> d64;
  const DepthRows depths(piece, block);
  for (std::uint64_t rest = block.mask; rest != 0;) {
    const int row = std::countr_zero(rest) / 8;
    rest &= ~(std::uint64_t{255} << (row * 8));
    for (std::size_t part = 0; part < 8 / kLanes; ++part)
      for_each_half(depths.at(row, part), piece.low, [&](std::size_t h, const auto key) HWY_ATTR {
        hn::Store(key, d64, out + static_cast<std::size_t>(row) * 8 + part * kLanes + h * kLanes64);
      });
  }
}

void store_opaque(const BlockColors& colors, std::uint64_t covered, Rgba8 background, Rgba8* out,
                  std::ptrdiff_t stride) noexcept {
  const U32 d;
  const auto behind = hn::Set(d, std::bit_cast<std::uint32_t>(background));
  for (int row = 0; row < kBlockSize; ++row)
    for (std::size_t part = 0; part < 8; part += kLanes) {
      const std::size_t i = static_cast<std::size_t>(row) * 8 + part;
      const F32 df;
      const auto pixel = packed(hn::Load(df, colors.r + i), hn::Load(df, colors.g + i),
                                hn::Load(df, colors.b + i), 0xff000000U);
      hn::StoreU(hn::IfThenElse(lane_mask(covered >> i), pixel, behind), d,
                 reinterpret_cast<std::uint32_t*>(out + row * stride + static_cast<int>(part)));
    }
}

template <bool kLinear>
void store_over(const BlockColors& colors, std::uint64_t covered, const Backdrop& backdrop,
                Rgba8* out, std::ptrdiff_t stride) {
  const F32 d;
  const U32 du;
  const F one = hn::Set(d, 1.0F);
  const auto empty = hn::Set(du, std::bit_cast<std::uint32_t>(backdrop.empty));
  for (int row = 0; row < kBlockSize; ++row)
    for (std::size_t part = 0; part < 8; part += kLanes) {
      const std::size_t i = static_cast<std::size_t>(row) * 8 + part;
      const F front = hn::Load(d, colors.a + i), through = hn::Sub(one, front);
      const auto over = [&](F color, float behind) HWY_ATTR {
        return hn::Add(color, hn::Mul(hn::Set(d, behind), through));
      };
      const F a = over(front, backdrop.color.w);
      const auto divides = hn::And(hn::Gt(a, hn::Zero(d)), hn::Ne(a, one));
      const F scale = hn::IfThenElse(divides, hn::Div(one, a), one);
      const auto straight = [&](const float* channel, float behind) HWY_ATTR {
        const F c = hn::Mul(over(hn::Load(d, channel + i), behind), scale);
        if constexpr (kLinear) return srgb_from_linear(c);
        return c;
      };
      const auto rgb =
          packed(straight(colors.r, backdrop.color.x), straight(colors.g, backdrop.color.y),
                 straight(colors.b, backdrop.color.z), 0);
      const auto pixel = hn::Or(rgb, hn::ShiftLeft<24>(quantize_lanes(a)));
      hn::StoreU(hn::IfThenElse(lane_mask(covered >> i), pixel, empty), du,
                 reinterpret_cast<std::uint32_t*>(out + row * stride + static_cast<int>(part)));
    }
}

void store_blended(const BlockColors& colors, std::uint64_t covered, const Backdrop& backdrop,
                   Rgba8* out, std::ptrdiff_t stride) noexcept {
  (backdrop.linear ? store_over<true> : store_over<false>)(colors, covered, backdrop, out, stride);
}

/// Writes `columns` pixels at `to`: whole cache lines are streamed, both ends are stored. line(x)
/// has the pixels from x on, rest(x, end) stores some. Without `kPast` whole lines are stored, too.
using Line = hn::CappedTag<std::uint32_t, 16>;
template <bool kPast = true, class Whole, class Rest>
HWY_INLINE void stream_row(int columns, Rgba8* to, const Whole& line, const Rest& rest) {
  const Line d;
  constexpr int kStep = static_cast<int>(hn::MaxLanes(Line()));
  constexpr int kLinePixels = 16;
  const auto address = reinterpret_cast<std::uintptr_t>(to);
  if (address % sizeof(Rgba8) != 0) return rest(0, columns);  // no pixel starts a line
  const auto first = static_cast<int>(address / sizeof(Rgba8) % kLinePixels);
  const int begin = std::min((kLinePixels - first) % kLinePixels, columns);
  const int end = begin + (columns - begin) / kLinePixels * kLinePixels;
  rest(0, begin);
  for (int x = begin; x < end; x += kStep) {
    auto* const at = reinterpret_cast<std::uint32_t*>(to + x);
    if constexpr (kPast)
      hn::Stream(line(x), d, at);
    else
      hn::Store(line(x), d, at);
  }
  rest(end, columns);
}

void stream(const Rgba8* from, int columns, int rows, Rgba8* to, std::ptrdiff_t stride) noexcept {
  for (int row = 0; row < rows; ++row, to += stride, from += columns)
    stream_row(
        columns, to,
        [&](int x) HWY_ATTR {
          return hn::LoadU(Line(), reinterpret_cast<const std::uint32_t*>(from + x));
        },
        [&](int x, int end) { std::copy(from + x, from + end, to + x); });
}

template <bool kPast>
void fill_rows(Rgba8 with, int columns, int rows, Rgba8* to, std::ptrdiff_t stride) noexcept {
  const auto pixels = hn::Set(Line(), std::bit_cast<std::uint32_t>(with));
  for (int row = 0; row < rows; ++row, to += stride)
    stream_row<kPast>(
        columns, to, [&](int) HWY_ATTR { return pixels; },
        [&](int x, int end) { std::fill(to + x, to + end, with); });
}

void end_stream() noexcept {
  hwy::FlushStream();
}

std::uint64_t lowest(const std::uint64_t* keys) noexcept {
  // Keys stay below 2^63, so they compare as signed numbers do.
  const I64 d;
  const auto* in = reinterpret_cast<const std::int64_t*>(keys);
  auto least = hn::Load(d, in);
  for (std::size_t i = kLanes64; i < 64; i += kLanes64) least = hn::Min(least, hn::Load(d, in + i));
  HWY_ALIGN std::int64_t lanes[kLanes64];
  hn::Store(least, d, lanes);
  return static_cast<std::uint64_t>(*std::min_element(lanes, lanes + kLanes64));
}

std::uint64_t take_rows(std::uint64_t* rows, std::uint64_t* block) noexcept {
  const hn::CappedTag<std::int64_t, kBlockSize> d;
  constexpr std::size_t kKeys = hn::MaxLanes(d);
  auto least = hn::Set(d, std::numeric_limits<std::int64_t>::max());
  for (std::size_t row = 0; row < kBlockSize; ++row)
    for (std::size_t part = 0; part < kBlockSize; part += kKeys) {
      auto* const from = reinterpret_cast<std::int64_t*>(rows + row * RowKeys::kRow + part);
      auto* const to = reinterpret_cast<std::int64_t*>(block + row * kBlockSize + part);
      const auto key = hn::Max(hn::LoadU(d, from), hn::Load(d, to));
      hn::StoreU(hn::Zero(d), d, from);
      hn::Store(key, d, to);
      least = hn::Min(least, key);
    }
  return static_cast<std::uint64_t>(hn::GetLane(hn::MinOfLanes(d, least)));
}

std::uint64_t covered(const std::uint64_t* keys) noexcept {
  const hn::RebindToUnsigned<I64> d;
  std::uint64_t mask = 0;
  for (std::size_t i = 0; i < 64; i += kLanes64) {
    std::uint8_t empty = 0;
    hn::StoreMaskBits(d, hn::Eq(hn::Load(d, keys + i), hn::Zero(d)), &empty);
    mask |= static_cast<std::uint64_t>(~empty & ((1U << kLanes64) - 1)) << i;
  }
  return mask;
}

void fill(Kernels& table) {
  table.keys = keys;
  table.maximum = maximum;
  table.lowest = lowest;
  table.take_rows = take_rows;
  table.covered = covered;
  table.store_opaque = store_opaque;
  table.store_blended = store_blended;
  table.stream = stream;
  table.fill = fill_rows<false>;
  table.stream_fill = fill_rows<true>;
  table.end_stream = end_stream;
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::raster {

FillKernels fill_block_kernels(Isa isa) noexcept {
  static constexpr FillKernels kFill[] = RASTRUM_BY_ISA(fill, nullptr);
  return kFill[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::raster
#endif
