// SPDX-License-Identifier: BSD-3-Clause
// Vector types that SIMD sources share, once per instruction set. A row of a block has 8 samples,
// so vectors have 4 or 8 lanes. A source without rows may first define the most that it wants
// (RASTRUM_MOST_LANES 16).
//
// Highway compiles a source once per target; this guard lets the header in once per target too.
#if defined(RASTRUM_RASTER_KERNELS_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_KERNELS_LANES_INL_HPP
#undef RASTRUM_RASTER_KERNELS_LANES_INL_HPP
#else
#define RASTRUM_RASTER_KERNELS_LANES_INL_HPP
#endif

#include <bit>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <rastrum/raster/rules/piece.hpp>

#ifndef RASTRUM_MOST_LANES
#define RASTRUM_MOST_LANES 8
#endif
/// kLanes for the preprocessor.
#define RASTRUM_LANE_COUNT HWY_MIN(HWY_MAX_BYTES / 4, RASTRUM_MOST_LANES)

// The scalar kernels replace Highway's baseline targets.
#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {  // each source has its own
namespace hn = hwy::HWY_NAMESPACE;

using F32 = hn::CappedTag<float, RASTRUM_MOST_LANES>;
using I32 = hn::RebindToSigned<F32>;
using U32 = hn::RebindToUnsigned<F32>;
using F64 = hn::CappedTag<double, RASTRUM_MOST_LANES / 2>;
using I64 = hn::CappedTag<std::int64_t, RASTRUM_MOST_LANES / 2>;
using F = hn::Vec<F32>;
using I = hn::Vec<I32>;
using D = hn::Vec<F64>;
constexpr std::size_t kLanes = hn::MaxLanes(F32{});
static_assert(kLanes == RASTRUM_LANE_COUNT);
constexpr std::size_t kLanes64 = hn::MaxLanes(F64{});
constexpr std::size_t kHalves = kLanes / kLanes64;
using I128 = hn::Full128<std::int32_t>;

/// Element m keeps the lanes of m's bits.
struct alignas(32) LaneTable {
  std::int64_t keep[1 << kLanes64][kLanes64];
};
[[maybe_unused]] constexpr LaneTable kLaneTable = [] {
  LaneTable table{};
  for (std::size_t m = 0; m < std::size_t{1} << kLanes64; ++m)
    for (std::size_t lane = 0; lane < kLanes64; ++lane)
      table.keep[m][lane] = (m >> lane & 1) != 0 ? -1 : 0;
  return table;
}();

HWY_INLINE D half_to_double(I v, std::size_t half) {
  const F64 d;
#if HWY_MAX_BYTES >= 32
  const hn::Half<I32> dh;
  return hn::PromoteTo(d, half == 0 ? hn::LowerHalf(dh, v) : hn::UpperHalf(dh, v));
#else
  const hn::Half<I32> dh;
  return hn::PromoteTo(
      d, half == 0 ? hn::LowerHalf(dh, v) : hn::LowerHalf(dh, hn::ConcatUpperUpper(I32{}, v, v)));
#endif
}

HWY_INLINE D half_to_double(F v, std::size_t half) {
  const F64 d;
  const hn::Half<F32> dh;
#if HWY_MAX_BYTES >= 32
  return hn::PromoteTo(d, half == 0 ? hn::LowerHalf(dh, v) : hn::UpperHalf(dh, v));
#else
  return hn::PromoteTo(
      d, half == 0 ? hn::LowerHalf(dh, v) : hn::LowerHalf(dh, hn::ConcatUpperUpper(F32{}, v, v)));
#endif
}

/// Bit i is lane i of a mask of 32-bit lanes.
template <class M>
HWY_INLINE std::uint32_t lane_bits(M mask) {
  static_assert(kLanes <= 16 && std::endian::native == std::endian::little);
  std::uint16_t bits = 0;
  hn::StoreMaskBits(I32{}, mask, reinterpret_cast<std::uint8_t*>(&bits));
  return bits & ((1U << kLanes) - 1);
}

/// The lanes of the low bits of `bits`.
HWY_INLINE hn::Mask<U32> lane_mask(std::uint64_t bits) {
  // LoadMaskBits reads whole bytes.
  const std::uint64_t memory = bits & ((1U << kLanes) - 1);
  return hn::LoadMaskBits(U32{}, reinterpret_cast<const std::uint8_t*>(&memory));
}

/// Half `h` of a vector, widened to 64 bits.
HWY_INLINE hn::Vec<hn::RebindToUnsigned<I64>> widened_half(hn::Vec<U32> v, std::size_t h) {
  const hn::Half<U32> dh;
#if HWY_MAX_BYTES >= 32
  const auto half = h == 0 ? hn::LowerHalf(dh, v) : hn::UpperHalf(dh, v);
#else
  const auto half =
      h == 0 ? hn::LowerHalf(dh, v) : hn::LowerHalf(dh, hn::ConcatUpperUpper(U32{}, v, v));
#endif
  return hn::PromoteTo(hn::RebindToUnsigned<I64>{}, half);
}

/// Clamps the depths, and calls use(h, keys) for kHalves vectors of keys with a piece's low part.
template <class Use>
HWY_INLINE void for_each_half(F depth, std::uint64_t low, const Use& use) {
  const F32 df;
  const hn::RebindToUnsigned<I64> du64;
  depth = hn::Min(hn::IfThenElseZero(hn::Gt(depth, hn::Zero(df)), depth), hn::Set(df, 1.0F));
  const auto bits = hn::BitCast(U32{}, depth);
  for (std::size_t h = 0; h < kHalves; ++h)
    use(h, hn::Or(hn::ShiftLeft<kIdBits>(widened_half(bits, h)), hn::Set(du64, low)));
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_KERNELS_LANES_INL_HPP
