// SPDX-License-Identifier: BSD-3-Clause
// Shader::wireframe and Shader::id in lanes, a block at a time. A wireframe visits, for each
// triangle, the rows of its samples. Operations are those of wire.cpp, interpolate.hpp and
// id_color.
#if defined(RASTRUM_RASTER_SHADE_WIRE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_SHADE_WIRE_INL_HPP
#undef RASTRUM_RASTER_SHADE_WIRE_INL_HPP
#else
#define RASTRUM_RASTER_SHADE_WIRE_INL_HPP
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <hwy/highway.h>

#include <rastrum/raster/shade/lit_constants.hpp>
#include <rastrum/raster/shade/wire.hpp>
#include <rastrum/raster/surface/seen_planes-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

constexpr std::uint64_t kWideBits = (std::uint64_t{1} << kLanes64) - 1;

/// A block's triangles and its samples' distances to their edges.
struct WireBlock {
  SeenPlanes seen;
  std::uint64_t samples[64];  ///< by triangle
  /// wire_share's planes, px from the edges, by triangle.
  HWY_ALIGN double p[3][64], q[3][64], r[3][64];
  HWY_ALIGN double x[64], y[64];  ///< places of the samples, px

  HWY_INLINE WireBlock(const FrameGeometry& frame, const VisibleBlock& block) {
    see_planes(frame, block, seen);
    for (std::size_t k = 0; k < seen.count; ++k) samples[k] = samples_of(k) & block.covered;
    for (std::size_t k = 0; k < seen.count; k += kLanes64) set_distances(k);
    for (std::size_t first = 0; first < 64; first += kLanes) {
      const WidePoints at(block, first);
      store(at.x, x + first);
      store(at.y, y + first);
    }
  }

 private:
  /// The samples with place k.
  [[nodiscard]] HWY_INLINE std::uint64_t samples_of(std::size_t k) const {
    const hn::CappedTag<std::uint8_t, 64> d;
    constexpr std::size_t kBytes = hn::MaxLanes(hn::CappedTag<std::uint8_t, 64>());
    std::uint8_t bits[8 + 8];  // StoreMaskBits may write whole words
    for (std::size_t i = 0; i < 64; i += kBytes)
      hn::StoreMaskBits(
          d, hn::Eq(hn::Load(d, seen.place + i), hn::Set(d, static_cast<std::uint8_t>(k))),
          bits + i / 8);
    std::uint64_t samples_there = 0;
    std::memcpy(&samples_there, bits, sizeof samples_there);
    return samples_there;
  }
  /// The planes of triangles k to k + kLanes64.
  HWY_INLINE void set_distances(std::size_t k) {
    const F64 d;
    const auto number = [&](std::size_t which)
                            HWY_ATTR { return hn::Load(d, seen.planes.number[which] + k); };
    for (std::size_t i = 0; i < 3; ++i) {
      const D wp = number(seen.planes.kP + 3 * i), wq = number(seen.planes.kQ + 3 * i);
      const D square = wp * wp + wq * wq;
      const auto has_slope = square > hn::Zero(d);
      const D scale = hn::Set(d, 1.0) / hn::Sqrt(square);
      const D wr = number(seen.planes.kR + 3 * i) * scale;
      hn::Store(hn::IfThenElseZero(has_slope, wp * scale), d, p[i] + k);
      hn::Store(hn::IfThenElseZero(has_slope, wq * scale), d, q[i] + k);
      hn::Store(hn::IfThenElse(has_slope, wr, hn::Set(d, kNoEdge)), d, r[i] + k);
    }
  }
};

/// Distances to the nearest edge of triangle k at its samples. `kCentred`: the samples of a block's
/// column share one x.
template <bool kCentred>
HWY_INLINE void visit(const WireBlock& w, std::size_t k, double* nearest) {
  constexpr std::size_t kInRow = 8 / kLanes64;  // vectors
  const F64 d;
  const auto& weights = w.seen.planes;
  const D x0 = hn::Set(d, weights.number[weights.kX0][k]);
  const D y0 = hn::Set(d, weights.number[weights.kY0][k]);
  D q[3], along[3][kInRow];
  for (int i = 0; i < 3; ++i) q[i] = hn::Set(d, w.q[i][k]);
  const auto set_along = [&](std::size_t first) HWY_ATTR {
    const D dx = hn::Load(d, w.x + first) - x0;
    for (int i = 0; i < 3; ++i)
      along[i][first / kLanes64 % kInRow] = hn::Set(d, w.r[i][k]) + hn::Set(d, w.p[i][k]) * dx;
  };
  if constexpr (kCentred)
    for (std::size_t g = 0; g < kInRow; ++g) set_along(g * kLanes64);
  for (std::uint64_t rest = w.samples[k]; rest != 0;) {
    const auto first = static_cast<std::size_t>(std::countr_zero(rest)) / kLanes64 * kLanes64;
    // LoadMaskBits reads whole bytes.
    const std::uint8_t bits[8] = {static_cast<std::uint8_t>(rest >> first & kWideBits)};
    rest &= ~(kWideBits << first);
    if constexpr (!kCentred) set_along(first);
    const D dy = hn::Load(d, w.y + first) - y0;
    D least = hn::Set(d, kNoEdge);
    for (int i = 0; i < 3; ++i) {
      const D away = hn::Abs(along[i][first / kLanes64 % kInRow] + q[i] * dy);
      least = hn::IfThenElse(hn::Lt(away, least), away, least);  // NaN is no distance
    }
    hn::BlendedStore(least, hn::LoadMaskBits(d, bits), d, nearest + first);
  }
}

/// wire_base of triangle k at its samples.
HWY_INLINE void set_base(const LitScene& scene, const WireBlock& w, std::size_t k,
                         float (&base)[3][64]) {
  constexpr std::uint64_t kAll = (std::uint64_t{1} << kLanes) - 1;
  const Fragment f = w.seen.fragment(k);
  WireColors c;
  fetch_wire_colors(scene, *w.seen.draw[k], w.seen.part[k], f.vertex, c);
  const WeightPlanes planes = w.seen.planes.at(k);
  for (std::size_t first = 0; first < 64; first += kLanes) {
    const std::uint64_t mine = w.samples[k] >> first & kAll;
    if (mine == 0) continue;
    V3 color = set(c.base);
    if (c.interpolates) {
      Wide b[3];
      shares_at(planes, load_wide(w.x + first), load_wide(w.y + first), b);
      V3 mixed = set(Vec3{});
      for (int i = 0; i < 3; ++i) mixed = mixed + set(c.corner[i]) * rounded(b[i]);
      color = color * mixed;
    }
    store(choose(mask_of(mine), color, load(base, first)), base, first);
  }
}

HWY_NOINLINE void shade_wires(const LitScene& scene, const FrameGeometry& frame,
                              const VisibleBlock& block, BlockColors& colors) {
  const WireBlock w(frame, block);
  alignas(64) double nearest[64];
  alignas(64) float base[3][64];
  if (block.covered != ~std::uint64_t{0}) std::fill_n(nearest, 64, kNoEdge);
  for (std::size_t k = 0; k < w.seen.count; ++k)
    if (block.points == nullptr)
      visit<true>(w, k, nearest);
    else
      visit<false>(w, k, nearest);
  if (scene.colored) {
    std::fill_n(base[0], 3 * 64, 0.0F);
    for (std::size_t k = 0; k < w.seen.count; ++k) set_base(scene, w, k, base);
  }
  const auto line_at = [&](const double* away_px) HWY_ATTR {
    const D away = hn::Load(F64{}, away_px), one = hn::Set(F64{}, 1.0);
    return hn::IfThenElseZero(away < one, one - away);
  };
  for (std::size_t i = 0; i < 64; i += kLanes) {
    const F line = rounded({line_at(nearest + i), line_at(nearest + i + kHalf)});
    const V3 under = scene.colored ? load(base, i) : set(kDefaultBase);
    store(under * (set(1) - line) + set(kWireColor) * line, colors.r + i, colors.g + i,
          colors.b + i);
  }
}

/// id_color of all keys; those that are 0 get one that nobody reads.
HWY_NOINLINE void shade_ids(const VisibleBlock& block, BlockColors& colors) {
  const hn::RebindToUnsigned<I64> d64;
  const hn::Rebind<std::uint32_t, F64> du;
  const hn::RebindToSigned<decltype(du)> di;
  const hn::Rebind<float, F64> df;
  const auto mask = hn::Set(d64, kIdMask);
  const auto one = hn::Set(df, 1.0F / 255.0F);
  for (std::size_t i = 0; i < 64; i += kLanes64) {
    const auto id = mask - hn::And(hn::Load(d64, block.keys + i), mask);
    auto h = hn::TruncateTo(du, hn::Xor(id, hn::ShiftRight<32>(id)));
    h = hn::Xor(h, hn::ShiftRight<16>(h));
    h = h * hn::Set(du, 0x85ebca6bU);
    h = hn::Xor(h, hn::ShiftRight<13>(h));
    h = h * hn::Set(du, 0xc2b2ae35U);
    h = hn::Xor(h, hn::ShiftRight<16>(h));
    const auto store_byte = [&](auto byte, float* to) HWY_ATTR {
      const auto level = hn::Or(hn::And(byte, hn::Set(du, 255U)), hn::Set(du, 32U));
      hn::Store(hn::ConvertTo(df, hn::BitCast(di, level)) * one, df, to + i);
    };
    store_byte(h, colors.r);
    store_byte(hn::ShiftRight<8>(h), colors.g);
    store_byte(hn::ShiftRight<16>(h), colors.b);
  }
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_SHADE_WIRE_INL_HPP
