// SPDX-License-Identifier: BSD-3-Clause
// Packed fragments in vectors with Highway, compiled once per instruction set.
//
// SortKeys are sorted by networks, a vector of pixels at once: lists are short, their order is
// unpredictable, and a network has no branches. Up to 8 it runs in registers; beyond it is
// Batcher's merge exchange (Knuth, TAOCP 3, 5.2.2 M), O(n log² n).
#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/transparency/packed_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <type_traits>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/cover/quadric_kernels-inl.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/rules/make_piece.hpp>
#include <rastrum/transparency/blend_lanes-inl.hpp>
#include <rastrum/transparency/packed_kernels.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::transparency::HWY_NAMESPACE {
namespace {
using U64 = hn::RebindToUnsigned<I64>;

HWY_INLINE F to_float(I v) {
  return hn::ConvertTo(F32{}, v);
}

HWY_NOINLINE std::size_t pack_quadric(const raster::Piece& p, std::uint64_t mask, int x, int y,
                                      std::uint32_t first, std::uint64_t* keys,
                                      std::uint16_t* pixels) {
  HWY_ALIGN std::uint64_t of_block[64];
  raster::HWY_NAMESPACE::quadric_keys(p,
                                      {0, static_cast<std::uint16_t>(x / raster::kBlockSize),
                                       static_cast<std::uint16_t>(y / raster::kBlockSize), mask},
                                      of_block);
  std::size_t n = 0;
  for (; mask != 0; mask &= mask - 1, ++n) {
    const int i = std::countr_zero(mask);
    keys[n] = of_block[i];
    pixels[n] = static_cast<std::uint16_t>(
        first +
        static_cast<std::uint32_t>(i / raster::kBlockSize * kPackedPitch + i % raster::kBlockSize));
  }
  return n;
}

/// Whole rows of 8 pixels if vectors are long enough.
using S64 = hn::CappedTag<std::int64_t, 8>;
using SortKeys = hn::Vec<S64>;
constexpr std::size_t kLanesS64 = hn::MaxLanes(S64{});
using Pixels = hn::CappedTag<std::uint16_t, kLanesS64>;

template <class Mask>
HWY_INLINE std::size_t leading_true(Mask mask) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(S64{}, mask, bits);
  const std::uint32_t are_false = ~std::uint32_t{bits[0]} | 1U << kLanesS64;
  return static_cast<std::size_t>(std::countr_zero(are_false));
}

std::size_t take(std::span<const raster::BinFragment> fragments, std::uint32_t first,
                 std::uint64_t* keys, std::uint16_t* pixels) noexcept {
  const hn::RebindToUnsigned<S64> d;
  static_assert(sizeof(raster::BinFragment) == 16 && kPackedPitch == raster::kBinSize);
  const auto field = [&](std::uint64_t bits) HWY_ATTR { return hn::Set(d, bits); };
  std::size_t n = 0;
  while (n + kLanesS64 <= fragments.size()) {
    hn::Vec<decltype(d)> key, other;
    hn::LoadInterleaved2(d, reinterpret_cast<const std::uint64_t*>(fragments.data() + n), key,
                         other);
    // From (block row, block column, row, column) to (block row, row, block column, column).
    const auto at = hn::ShiftRight<32>(other);
    const auto pixel =
        hn::Or(hn::Or(hn::And(at, field(0xE07)), hn::And(hn::ShiftRight<3>(at), field(0x38))),
               hn::And(hn::ShiftLeft<3>(at), field(0x1C0)));
    hn::StoreU(key, d, keys + n);
    hn::StoreU(hn::TruncateTo(Pixels{}, hn::Sub(pixel, field(first))), Pixels{}, pixels + n);
    const auto flag = hn::And(at, field(raster::kTranslucentFragment));
    const std::size_t count = leading_true(hn::RebindMask(S64{}, hn::Ne(flag, hn::Zero(d))));
    n += count;
    if (count < kLanesS64) return n;
  }
  for (; n < fragments.size() && is_translucent(fragments[n]); ++n) {
    keys[n] = fragments[n].key;
    pixels[n] = packed_pixel(fragments[n], first);
  }
  return n;
}

/// Windows do not depend on each other, so the processor overlaps them.
std::size_t pack(std::span<const Window> windows, const MicroFragments& micro,
                 const PackedPlace& place, std::uint64_t* keys, std::uint16_t* pixels) noexcept {
  constexpr float kPxPerSubpixel = 1.0F / raster::kSubpixels;
  const F32 d;
  const hn::Rebind<std::uint8_t, I32> d8;
  const hn::Rebind<std::uint16_t, I32> d16;
  using Bytes = std::conditional_t<kLanes == 8, std::uint64_t, std::uint32_t>;
  const hn::CappedTag<Bytes, 1> one;
  const I last = hn::Set(I32{}, kPackedPitch - 1), seven = hn::Set(I32{}, raster::kBlockSize - 1);
  // Sums of small multiples of 1/2 are exact in any order.
  const F half = hn::Set(d, 0.5F);
  const auto id = hn::Set(S64{}, static_cast<std::int64_t>(raster::kIdMask));
  std::size_t n = 0, m = 0;
  // Fragments of micro triangles with smaller ids, so larger low parts.
  const auto add_micro = [&](std::uint64_t low) HWY_ATTR {
    const auto of_window = hn::Set(S64{}, static_cast<std::int64_t>(low));
    while (m < micro.count) {
      const auto own = hn::LoadU(S64{}, reinterpret_cast<const std::int64_t*>(micro.keys) + m);
      hn::StoreU(own, S64{}, reinterpret_cast<std::int64_t*>(keys) + n);
      hn::StoreU(hn::LoadU(Pixels{}, micro.pixels + m), Pixels{}, pixels + n);
      const std::size_t count = leading_true(hn::Gt(hn::And(own, id), of_window));
      m += count;
      n += count;
      if (count < kLanesS64) return;
    }
  };
  for (const Window& w : windows) {
    const raster::Piece& p = *w.piece;
    add_micro(p.low);
    std::uint64_t mask = w.mask;
    const std::uint32_t first = w.pixel;
    if (HWY_UNLIKELY(raster::is_quadric(p))) {
      n += pack_quadric(p, mask, place.x + static_cast<int>(first % kPackedPitch),
                        place.y + static_cast<int>(first / kPackedPitch), first, keys + n,
                        pixels + n);
      continue;
    }
    const auto count = static_cast<std::size_t>(parallel::popcount(mask));
    const F x0 = hn::Set(d, static_cast<float>(p.x[0]) * kPxPerSubpixel);
    const F y0 = hn::Set(d, static_cast<float>(p.y[0]) * kPxPerSubpixel);
    const F z0 = hn::Set(d, p.z0), zx = hn::Set(d, p.zx), zy = hn::Set(d, p.zy);
    const I base = hn::Set(I32{}, static_cast<std::int32_t>(first));
    const I x = hn::Set(I32{}, place.x), y = hn::Set(I32{}, place.y);
    for (std::size_t i = 0; i < count; i += kLanes) {
      // In a register: a vector load of bytes just written would wait for all of them.
      Bytes samples = 0;
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        samples |= static_cast<Bytes>(std::countr_zero(mask) & 63) << (8 * lane);
        mask &= mask - 1;
      }
      const I sample = hn::PromoteTo(I32{}, hn::BitCast(d8, hn::Set(one, samples)));
      const I column = hn::And(sample, seven), row = hn::ShiftRight<3>(sample);
      const I pixel = hn::Add(base, hn::Or(hn::ShiftLeft<6>(row), column));
      const F dx = hn::Sub(hn::Add(to_float(hn::Add(hn::And(pixel, last), x)), half), x0);
      const F dy = hn::Sub(hn::Add(to_float(hn::Add(hn::ShiftRight<6>(pixel), y)), half), y0);
      const F depth = hn::Add(hn::Add(z0, hn::Mul(zx, dx)), hn::Mul(zy, dy));
      for_each_half(depth, p.low, [&](std::size_t h, const auto key) HWY_ATTR {
        hn::StoreU(key, U64{}, keys + n + i + h * kLanes64);
      });
      hn::StoreU(hn::DemoteTo(d16, pixel), d16, pixels + n + i);
    }
    n += count;
  }
  add_micro(0);  // no key has that
  return n;
}

bool find_firsts(std::uint64_t* keys, std::size_t count, std::uint64_t* firsts) noexcept {
  const hn::CappedTag<std::int64_t, 8> d;
  constexpr std::size_t kStep = hn::MaxLanes(hn::CappedTag<std::int64_t, 8>());
  const auto id = hn::Set(d, static_cast<std::int64_t>(raster::kIdMask));
  std::fill_n(keys + count, kPackSlack, 0U);
  const auto* const at = reinterpret_cast<const std::int64_t*>(keys);
  auto rises = hn::Ne(id, id);  // low parts fall where ids rise
  std::uint64_t carry = 1;
  for (std::size_t word = 0; word * 64 < count; ++word) {
    std::uint64_t lasts = 0;
    for (std::size_t i = 0; i < 64 && word * 64 + i < count; i += kStep) {
      const auto own = hn::And(hn::LoadU(d, at + word * 64 + i), id);
      const auto next = hn::And(hn::LoadU(d, at + word * 64 + i + 1), id);
      rises = hn::Or(rises, hn::Gt(next, own));
      std::uint8_t bits = 0;
      hn::StoreMaskBits(d, hn::Ne(own, next), &bits);
      lasts |= (std::uint64_t{bits} & ((1U << kStep) - 1)) << i;
    }
    firsts[word] = lasts << 1 | carry;
    carry = lasts >> 63;
  }
  return hn::AllFalse(d, rises);
}

void count_pixels(const std::uint16_t* pixels, std::size_t count, std::size_t rows,
                  std::uint16_t* of_pixel, std::uint16_t* most) noexcept {
  const hn::CappedTag<std::uint16_t, 8> d;
  std::fill_n(of_pixel, rows * 8, std::uint16_t{0});
  for (std::size_t f = 0; f < count; ++f) ++of_pixel[pixels[f]];
  for (std::size_t r = 0; r < rows; ++r)
    most[r] = hn::GetLane(hn::MaxOfLanes(d, hn::Load(d, of_pixel + r * 8)));
}

void points(const std::uint16_t* pixels, raster::ShadingPoints& points) noexcept {
  const F32 d;
  const hn::Rebind<std::uint16_t, I32> d16;
  const I last = hn::Set(I32{}, kPackedPitch - 1), seven = hn::Set(I32{}, raster::kBlockSize - 1);
  for (std::size_t i = 0; i < 64; i += kLanes) {
    const I pixel = hn::PromoteTo(I32{}, hn::LoadU(d16, pixels + i));
    const I element = hn::Iota(I32{}, static_cast<std::int32_t>(i));
    hn::Store(to_float(hn::Sub(hn::And(pixel, last), hn::And(element, seven))), d, points.dx + i);
    hn::Store(to_float(hn::Sub(hn::ShiftRight<6>(pixel), hn::ShiftRight<3>(element))), d,
              points.dy + i);
  }
}

/// SortKeys stay below 2^63, so AVX2's signed comparisons suffice.
HWY_INLINE void larger_first(SortKeys& a, SortKeys& b) {
#if HWY_TARGET == HWY_AVX3
  const SortKeys larger = hn::Max(a, b);
  b = hn::Min(a, b);
#else
  const auto swaps = hn::Gt(b, a);
  const SortKeys larger = hn::IfThenElse(swaps, b, a);
  b = hn::IfThenElse(swaps, a, b);
#endif
  a = larger;
}

HWY_INLINE SortKeys load_sort_keys(const std::int64_t* column, std::size_t k) {
  return hn::Load(S64{}, column + k * 8);
}
HWY_INLINE void store_sort_keys(SortKeys v, std::int64_t* column, std::size_t k) {
  hn::Store(v, S64{}, column + k * 8);
}

void sort_2(std::int64_t* column) {
  SortKeys a = load_sort_keys(column, 0), b = load_sort_keys(column, 1);
  larger_first(a, b);
  store_sort_keys(a, column, 0);
  store_sort_keys(b, column, 1);
}

HWY_INLINE void network_4(SortKeys& a, SortKeys& b, SortKeys& c, SortKeys& d) {
  larger_first(a, b);
  larger_first(c, d);
  larger_first(a, c);
  larger_first(b, d);
  larger_first(b, c);
}

void sort_4(std::int64_t* column, std::size_t n) {
  SortKeys a = load_sort_keys(column, 0), b = load_sort_keys(column, 1),
           c = load_sort_keys(column, 2);
  SortKeys d = n > 3 ? load_sort_keys(column, 3) : hn::Zero(S64{});
  network_4(a, b, c, d);
  store_sort_keys(a, column, 0);
  store_sort_keys(b, column, 1);
  store_sort_keys(c, column, 2);
  if (n > 3) store_sort_keys(d, column, 3);
}

/// Two networks of 4, merged: 19 exchanges.
void sort_8(std::int64_t* column, std::size_t n) {
  const auto load = [&](std::size_t k)
                        HWY_ATTR { return k < n ? load_sort_keys(column, k) : hn::Zero(S64{}); };
  SortKeys a = load(0), b = load(1), c = load(2), d = load(3);
  SortKeys e = load(4), f = load(5), g = load(6), h = load(7);
  network_4(a, b, c, d);
  network_4(e, f, g, h);
  larger_first(a, e);
  larger_first(b, f);
  larger_first(c, g);
  larger_first(d, h);
  larger_first(c, e);
  larger_first(d, f);
  larger_first(b, c);
  larger_first(d, e);
  larger_first(f, g);
  const SortKeys sorted[8] = {a, b, c, d, e, f, g, h};
  for (std::size_t k = 0; k < n; ++k) store_sort_keys(sorted[k], column, k);
}

void merge_exchange(std::int64_t* column, std::size_t n) {
  const std::size_t top = std::bit_ceil(n) / 2;
  for (std::size_t p = top; p > 0; p /= 2) {
    std::size_t q = top, r = 0, d = p;
    for (;;) {
      for (std::size_t run = r; run < n - d; run += 2 * p)
        for (std::size_t i = run; i < std::min(run + p, n - d); ++i) {
          SortKeys a = load_sort_keys(column, i), b = load_sort_keys(column, i + d);
          larger_first(a, b);
          store_sort_keys(a, column, i);
          store_sort_keys(b, column, i + d);
        }
      if (q == p) break;
      d = q - p;
      q /= 2;
      r = p;
    }
  }
}

void sort(std::uint64_t* sort_keys, std::size_t layers) noexcept {
  for (std::size_t i = 0; i < 8; i += hn::MaxLanes(S64{})) {
    auto* const column = reinterpret_cast<std::int64_t*>(sort_keys + i);
    if (layers == 2)
      sort_2(column);
    else if (layers <= 4)
      sort_4(column, layers);
    else if (layers <= 8)
      sort_8(column, layers);
    else
      merge_exchange(column, layers);
  }
}

std::uint8_t filter(std::uint64_t* sort_keys, std::size_t layers, std::size_t filter) noexcept {
  std::uint8_t misplaced = 0;
  for (std::size_t i = 0; i < 8; i += kLanesS64) {
    auto* const column = reinterpret_cast<std::int64_t*>(sort_keys + i);
    auto too_far = hn::Gt(hn::Zero(S64{}), hn::Zero(S64{}));
    for (std::size_t n = 1; n < layers; ++n) {
      SortKeys own = load_sort_keys(column, n);
      const std::size_t first = n > filter ? n - filter : 0;
      // In an ordered list a key that passes this one passes all behind it, too.
      if (first > 0) too_far = hn::Or(too_far, hn::Gt(own, load_sort_keys(column, first - 1)));
      for (std::size_t k = first; k < n; ++k) {
        SortKeys other = load_sort_keys(column, k);
        larger_first(other, own);
        store_sort_keys(other, column, k);
      }
      store_sort_keys(own, column, n);
    }
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(S64{}, too_far, bits);
    misplaced = static_cast<std::uint8_t>(misplaced | bits[0] << i);
  }
  return misplaced;
}

void interleave(const raster::BlockColors& colors, Vec4* out) noexcept {
  const F32 d;
  for (std::size_t i = 0; i < 64; i += kLanes)
    hn::StoreInterleaved4(hn::Load(d, colors.r + i), hn::Load(d, colors.g + i),
                          hn::Load(d, colors.b + i), hn::Load(d, colors.a + i), d, &out[i].x);
}

void gather(const PackedRow& row, std::size_t first, raster::BlockColors& out) noexcept {
  for (std::size_t part = 0; part < 8; part += kLanes)
    store(load_colors(row.sort_keys + part, row.colors), out, first + part);
}

template <bool kStops>
HWY_INLINE void add_layers(const PackedRow& row, std::size_t part, float opaque_at,
                           SeenPixel& pixel) {
  for (std::size_t k = 0; k < row.layers; ++k) {
    V4 c = load_colors(row.sort_keys + k * 8 + part, row.colors);
    if constexpr (kStops) {
      // Layers behind a finished pixel may never have been shaded.
      const auto unfinished = hn::Not(pixel.through <= set(opaque_at));
      if (hn::AllFalse(F32{}, unfinished)) break;
      c = choose_or_zero(unfinished, c);
    }
    add_behind(pixel, c);
  }
}

template <bool kStops>
HWY_INLINE void behind_rows(const PackedRow& row, std::size_t first, float opaque_at, Seen& seen) {
  for (std::size_t part = 0; part < 8; part += kLanes) {
    SeenPixel pixel = load(seen, first + part);
    add_layers<kStops>(row, part, opaque_at, pixel);
    store(pixel, seen, first + part);
  }
}

template <bool kStops>
HWY_INLINE void over_rows(const PackedRow (&rows)[8], const raster::BlockColors* behind,
                          float opaque_at, raster::BlockColors& out) {
  const F zero = set(0);
  for (std::size_t y = 0; y < 8; ++y)
    for (std::size_t part = 0; part < 8; part += kLanes) {
      SeenPixel pixel{{zero, zero, zero, zero}, set(1)};
      add_layers<kStops>(rows[y], part, opaque_at, pixel);
      const std::size_t at = y * 8 + part;
      const V4 nothing{zero, zero, zero, zero};
      store(over(pixel, behind == nullptr ? nothing : load(*behind, at)), out, at);
    }
}

void behind(const PackedRow& row, std::size_t first, float opaque_at, Seen& seen) noexcept {
  if (opaque_at > 0)
    behind_rows<true>(row, first, opaque_at, seen);
  else
    behind_rows<false>(row, first, opaque_at, seen);
}

void put_over(const PackedRow (&rows)[8], const raster::BlockColors* behind, float opaque_at,
              raster::BlockColors& out) noexcept {
  if (opaque_at > 0)
    over_rows<true>(rows, behind, opaque_at, out);
  else
    over_rows<false>(rows, behind, opaque_at, out);
}

void put_before(const PackedRow& row, std::size_t first, raster::BlockColors& colors) noexcept {
  for (std::size_t part = 0; part < 8; part += kLanes) {
    V4 color = load(colors, first + part);
    for (std::size_t k = 0; k < row.layers; ++k)
      color = before(load_colors(row.sort_keys + k * 8 + part, row.colors), color);
    store(color, colors, first + part);
  }
}

constexpr PackedKernels kTable{take,   pack,       find_firsts, count_pixels, points,   sort,
                               filter, interleave, gather,      behind,       put_over, put_before};

}  // namespace
}  // namespace rastrum::transparency::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::transparency {
namespace {

std::size_t take_scalar(std::span<const raster::BinFragment> fragments, std::uint32_t first,
                        std::uint64_t* keys, std::uint16_t* pixels) noexcept {
  std::size_t n = 0;
  for (; n < fragments.size() && is_translucent(fragments[n]); ++n) {
    keys[n] = fragments[n].key;
    pixels[n] = packed_pixel(fragments[n], first);
  }
  return n;
}

std::size_t pack_scalar(std::span<const Window> windows, const MicroFragments& micro,
                        const PackedPlace& place, std::uint64_t* keys,
                        std::uint16_t* pixels) noexcept {
  std::size_t n = 0, m = 0;
  const auto add_micro = [&](std::uint64_t low) {
    for (; m < micro.count && (micro.keys[m] & raster::kIdMask) > low; ++m, ++n) {
      keys[n] = micro.keys[m];
      pixels[n] = micro.pixels[m];
    }
  };
  for (const Window& w : windows) {
    add_micro(w.piece->low);
    const std::uint32_t first = w.pixel;
    for (std::uint64_t mask = w.mask; mask != 0; mask &= mask - 1, ++n) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(mask));
      const std::uint32_t pixel =
          first + i / raster::kBlockSize * kPackedPitch + i % raster::kBlockSize;
      keys[n] = raster::make_key(
          raster::depth_at(*w.piece, place.x + static_cast<int>(pixel % kPackedPitch),
                           place.y + static_cast<int>(pixel / kPackedPitch)),
          w.piece->low);
      pixels[n] = static_cast<std::uint16_t>(pixel);
    }
  }
  add_micro(0);  // no key has that
  return n;
}

bool find_firsts_scalar(std::uint64_t* keys, std::size_t count, std::uint64_t* firsts) noexcept {
  std::fill_n(keys + count, kPackSlack, 0U);
  std::fill_n(firsts, (count + 63) / 64, 0U);
  std::uint64_t last = raster::kIdMask;
  bool rises = false;
  for (std::size_t f = 0; f < count; ++f) {
    const std::uint64_t own = keys[f] & raster::kIdMask;
    rises |= own > last;
    firsts[f / 64] |= std::uint64_t{f == 0 || own != last} << f % 64;
    last = own;
  }
  return !rises;
}

void count_scalar(const std::uint16_t* pixels, std::size_t count, std::size_t rows,
                  std::uint16_t* of_pixel, std::uint16_t* most) noexcept {
  std::fill_n(of_pixel, rows * 8, std::uint16_t{0});
  for (std::size_t f = 0; f < count; ++f) ++of_pixel[pixels[f]];
  for (std::size_t r = 0; r < rows; ++r)
    most[r] = *std::max_element(of_pixel + r * 8, of_pixel + r * 8 + 8);
}

void points_scalar(const std::uint16_t* pixels, raster::ShadingPoints& points) noexcept {
  for (int i = 0; i < 64; ++i) {
    const int pixel = pixels[i];
    points.dx[i] = static_cast<float>(pixel % kPackedPitch - i % raster::kBlockSize);
    points.dy[i] = static_cast<float>(pixel / kPackedPitch - i / raster::kBlockSize);
  }
}

void sort_scalar(std::uint64_t* sort_keys, std::size_t layers) noexcept {
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t n = 1; n < layers; ++n) {
      const std::uint64_t sort_key = sort_keys[n * 8 + i];
      std::size_t k = n;
      for (; k > 0 && sort_keys[(k - 1) * 8 + i] < sort_key; --k)
        sort_keys[k * 8 + i] = sort_keys[(k - 1) * 8 + i];
      sort_keys[k * 8 + i] = sort_key;
    }
}

std::uint8_t filter_scalar(std::uint64_t* sort_keys, std::size_t layers,
                           std::size_t filter) noexcept {
  unsigned misplaced = 0;
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t n = 1; n < layers; ++n) {
      const std::uint64_t own = sort_keys[n * 8 + i];
      const std::size_t first = n > filter ? n - filter : 0;
      std::size_t k = n;
      for (; k > first && sort_keys[(k - 1) * 8 + i] < own; --k)
        sort_keys[k * 8 + i] = sort_keys[(k - 1) * 8 + i];
      sort_keys[k * 8 + i] = own;
      if (k == first && first > 0 && sort_keys[(k - 1) * 8 + i] < own) misplaced |= 1U << i;
    }
  return static_cast<std::uint8_t>(misplaced);
}

void interleave_scalar(const raster::BlockColors& colors, Vec4* out) noexcept {
  for (std::size_t i = 0; i < 64; ++i)
    out[i] = {colors.r[i], colors.g[i], colors.b[i], colors.a[i]};
}

const Vec4& color_at(const PackedRow& row, std::size_t k) {
  return row.colors[color_of_sort_key(row.sort_keys[k])];
}

void gather_scalar(const PackedRow& row, std::size_t first, raster::BlockColors& out) noexcept {
  for (std::size_t i = 0; i < 8; ++i) out.set(static_cast<int>(first + i), color_at(row, i));
}

void behind_scalar(const PackedRow& row, std::size_t first, float opaque_at, Seen& seen) noexcept {
  for (std::size_t k = 0; k < row.layers; ++k)
    for (std::size_t i = 0; i < 8; ++i) {
      const int at = static_cast<int>(first + i);
      SeenPixel pixel = seen.at(at);
      if (opaque_at > 0 && pixel.through <= opaque_at) continue;
      add_behind(pixel, color_at(row, k * 8 + i));
      seen.set(at, pixel);
    }
}

void over_scalar(const PackedRow (&rows)[8], const raster::BlockColors* behind, float opaque_at,
                 raster::BlockColors& out) noexcept {
  Seen seen{};
  std::fill_n(seen.through, 64, 1.0F);
  for (std::size_t y = 0; y < 8; ++y) behind_scalar(rows[y], y * 8, opaque_at, seen);
  for (int i = 0; i < 64; ++i)
    out.set(i, over(seen.at(i), behind == nullptr ? Vec4{} : behind->at(i)));
}

void before_scalar(const PackedRow& row, std::size_t first, raster::BlockColors& colors) noexcept {
  for (std::size_t k = 0; k < row.layers; ++k)
    for (std::size_t i = 0; i < 8; ++i) {
      const int at = static_cast<int>(first + i);
      colors.set(at, before(color_at(row, k * 8 + i), colors.at(at)));
    }
}

constexpr PackedKernels kScalar{take_scalar,   pack_scalar,   find_firsts_scalar, count_scalar,
                                points_scalar, sort_scalar,   filter_scalar,      interleave_scalar,
                                gather_scalar, behind_scalar, over_scalar,        before_scalar};

}  // namespace

const PackedKernels& packed_kernels(Isa isa) noexcept {
  static constexpr const PackedKernels* kTables[] = RASTRUM_BY_ISA(kTable, &kScalar);
  return *kTables[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::transparency
#endif
