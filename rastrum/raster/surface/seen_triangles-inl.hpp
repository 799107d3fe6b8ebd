// SPDX-License-Identifier: BSD-3-Clause
// Finds the different triangles that a block's pixels see, and loads their values into lanes, a
// triangle a lane.
#if defined(RASTRUM_RASTER_SURFACE_SEEN_TRIANGLES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_SURFACE_SEEN_TRIANGLES_INL_HPP
#undef RASTRUM_RASTER_SURFACE_SEEN_TRIANGLES_INL_HPP
#else
#define RASTRUM_RASTER_SURFACE_SEEN_TRIANGLES_INL_HPP
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>

#include <hwy/highway.h>

#include <rastrum/raster/kernels/lane_math-inl.hpp>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/raster/surface/seen_triangles.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

constexpr std::size_t kQuads = kLanes / 4;
using F128 = hn::Full128<float>;
using V128 = hn::Vec<F128>;

/// Covered pixels whose left neighbour is in another row or sees another triangle or nothing.
HWY_INLINE std::uint64_t run_starts(const std::uint64_t* keys, std::uint64_t covered) {
  const hn::CappedTag<std::uint64_t, 8> d;
  constexpr int kStep = static_cast<int>(hn::MaxLanes(hn::CappedTag<std::uint64_t, 8>()));
  const auto mask = hn::Set(d, kIdMask);
  std::uint64_t same = 0;
  for (int i = 1; i < 64; i += kStep) {
    const int at = std::min(i, 64 - kStep);
    const auto differ =
        hn::And(hn::Xor(hn::LoadU(d, keys + at), hn::LoadU(d, keys + at - 1)), mask);
    std::uint8_t bits = 0;
    hn::StoreMaskBits(d, hn::Eq(differ, hn::Zero(d)), &bits);
    same |= (std::uint64_t{bits} & ((1U << kStep) - 1)) << at;
  }
  return covered & (~same | ~(covered << 1) | 0x0101010101010101U);
}

HWY_INLINE void set_run(SeenTriangles& seen, int at, std::uint64_t number) {
  const std::uint64_t run = number * 0x0101010101010101U;
  std::memcpy(seen.place + at, &run, sizeof run);
}
/// Lists only the triangles of the runs that begin at `starts`.
HWY_INLINE void list_anew(const std::uint64_t* keys, std::uint64_t starts, SeenTriangles& seen) {
  std::memset(seen.table, 0, sizeof seen.table);
  std::uint64_t count = 0;
  for (; starts != 0; starts &= starts - 1) {
    const int i = std::countr_zero(starts);
    const std::uint64_t low = keys[i] & kIdMask;
    std::uint64_t& entry = seen.table[low % std::size(seen.table)];
    // Branch-free, since the branch is unpredictable and compilers make one of `?:`.
    const std::uint64_t next = low << 8 | count;
    const std::uint64_t is_new = entry >> 8 != low ? 1 : 0;
    const std::uint64_t known = entry ^ ((entry ^ next) & (0U - is_new));
    seen.low[count] = low;
    count += is_new;
    entry = known;
    set_run(seen, i, known & 0xFF);
  }
  seen.count = count;
}
/// Finds the place of each pixel of the runs that begin at `starts`. False: a triangle was new, so
/// the list now has only these, all to be set up.
HWY_INLINE bool find_places(const std::uint64_t* keys, std::uint64_t starts, SeenTriangles& seen) {
  for (std::uint64_t rest = starts; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const std::uint64_t low = keys[i] & kIdMask;
    const std::uint64_t entry = seen.table[low % std::size(seen.table)];
    if (entry >> 8 != low) {
      list_anew(keys, starts, seen);
      return false;
    }
    set_run(seen, i, entry & 0xFF);
  }
  return true;
}
/// The same from nothing; `seen` need not have been set.
HWY_INLINE void find_anew(const std::uint64_t* keys, std::uint64_t covered, SeenTriangles& seen) {
  std::memset(seen.place, 0, sizeof seen.place);
  list_anew(keys, run_starts(keys, covered), seen);
}

/// The pixels of `among` whose key has the low part `low` ≠ 0.
HWY_INLINE std::uint64_t pixels_of(const std::uint64_t* keys, std::uint64_t low,
                                   std::uint64_t among) {
  const hn::CappedTag<std::uint64_t, 8> d;
  constexpr std::size_t kStep = hn::MaxLanes(hn::CappedTag<std::uint64_t, 8>());
  const auto wanted = hn::Set(d, low), mask = hn::Set(d, kIdMask);
  std::uint64_t pixels = 0;
  for (std::size_t i = 0; i < 64; i += kStep) {
    std::uint8_t bits = 0;
    hn::StoreMaskBits(d, hn::Eq(hn::And(hn::Load(d, keys + i), mask), wanted), &bits);
    pixels |= (std::uint64_t{bits} & ((1U << kStep) - 1)) << i;
  }
  return pixels & among;
}

HWY_INLINE F joined(const V128 (&quad)[kQuads]) {
#if RASTRUM_LANE_COUNT == 16
  const hn::Half<F32> half;
  return hn::Combine(F32{}, hn::Combine(half, quad[3], quad[2]),
                     hn::Combine(half, quad[1], quad[0]));
#elif RASTRUM_LANE_COUNT == 8
  return hn::Combine(F32{}, quad[1], quad[0]);
#else
  return quad[0];
#endif
}

/// The four floats at each of at(0) to at(kLanes − 1), transposed.
template <class At>
HWY_INLINE V4 transposed(const At& at) {
  const F32 d;
  const hn::Repartition<double, F32> d64;
  // Takes every fourth one, so that transposing in blocks of 128 bits makes whole quads.
  const auto fourths = [&](std::size_t first) HWY_ATTR {
    V128 quad[kQuads];
    for (std::size_t q = 0; q < kQuads; ++q) quad[q] = hn::LoadU(F128{}, at(q * 4 + first));
    return joined(quad);
  };
  const F v0 = fourths(0), v1 = fourths(1), v2 = fourths(2), v3 = fourths(3);
  const auto xy01 = hn::BitCast(d64, hn::InterleaveLower(d, v0, v1));
  const auto xy23 = hn::BitCast(d64, hn::InterleaveLower(d, v2, v3));
  const auto zw01 = hn::BitCast(d64, hn::InterleaveUpper(d, v0, v1));
  const auto zw23 = hn::BitCast(d64, hn::InterleaveUpper(d, v2, v3));
  return {hn::BitCast(d, hn::InterleaveLower(d64, xy01, xy23)),
          hn::BitCast(d, hn::InterleaveUpper(d64, xy01, xy23)),
          hn::BitCast(d, hn::InterleaveLower(d64, zw01, zw23)),
          hn::BitCast(d, hn::InterleaveUpper(d64, zw01, zw23))};
}

/// For n lanes: more permutations, but cheaper for few lanes.
HWY_INLINE V4 load_transposed(const float* const (&at)[kLanes], std::size_t n) {
  if (n == kLanes) return transposed([&](std::size_t i) HWY_ATTR { return at[i]; });
  const F128 d;
  const hn::Repartition<double, F128> d64;
  V128 x[kQuads], y[kQuads], z[kQuads], w[kQuads];
  for (std::size_t q = 0; q < kQuads; ++q) {
    if (q != 0 && q * 4 >= n) {  // any values
      x[q] = x[0], y[q] = y[0], z[q] = z[0], w[q] = w[0];
      continue;
    }
    const auto load = [&](std::size_t i) HWY_ATTR { return hn::LoadU(d, at[q * 4 + i]); };
    const V128 v0 = load(0), v1 = load(1), v2 = load(2), v3 = load(3);
    const auto xy01 = hn::BitCast(d64, hn::InterleaveLower(d, v0, v1));
    const auto xy23 = hn::BitCast(d64, hn::InterleaveLower(d, v2, v3));
    const auto zw01 = hn::BitCast(d64, hn::InterleaveUpper(d, v0, v1));
    const auto zw23 = hn::BitCast(d64, hn::InterleaveUpper(d, v2, v3));
    x[q] = hn::BitCast(d, hn::InterleaveLower(d64, xy01, xy23));
    y[q] = hn::BitCast(d, hn::InterleaveUpper(d64, xy01, xy23));
    z[q] = hn::BitCast(d, hn::InterleaveLower(d64, zw01, zw23));
    w[q] = hn::BitCast(d, hn::InterleaveUpper(d64, zw01, zw23));
  }
  return {joined(x), joined(y), joined(z), joined(w)};
}

template <class Mask>
HWY_INLINE std::uint64_t bits_of(Mask mask) {
  alignas(8) std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(F32{}, mask, bytes);
  std::uint64_t bits = 0;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits & ((std::uint64_t{1} << kLanes) - 1);
}
/// The lanes of the low bits of `bits`.
HWY_INLINE hn::Mask<F32> mask_of(std::uint64_t bits) {
  bits &= (std::uint64_t{1} << kLanes) - 1;
  std::uint8_t bytes[8];
  std::memcpy(bytes, &bits, sizeof bytes);
  return hn::LoadMaskBits(F32{}, bytes);
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_SURFACE_SEEN_TRIANGLES_INL_HPP
