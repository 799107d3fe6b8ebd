// SPDX-License-Identifier: BSD-3-Clause
// Vectors of a block's colours, its Seen, and packed fragments.
#if defined(RASTRUM_TRANSPARENCY_BLEND_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_TRANSPARENCY_BLEND_LANES_INL_HPP
#undef RASTRUM_TRANSPARENCY_BLEND_LANES_INL_HPP
#else
#define RASTRUM_TRANSPARENCY_BLEND_LANES_INL_HPP
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <rastrum/raster/kernels/lane_math-inl.hpp>
#include <rastrum/transparency/blend_kernels.hpp>
#include <rastrum/transparency/packed_kernels.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::transparency::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace raster::HWY_NAMESPACE;  // NOLINT: the lanes' names

#define RASTRUM_LANES HWY_INLINE
#include <rastrum/transparency/over.inl>
#undef RASTRUM_LANES

HWY_INLINE V4 load(const raster::BlockColors& c, std::size_t i) {
  const F32 d;
  return {hn::Load(d, c.r + i), hn::Load(d, c.g + i), hn::Load(d, c.b + i), hn::Load(d, c.a + i)};
}
HWY_INLINE SeenPixel load(const Seen& s, std::size_t i) {
  const F32 d;
  return {{hn::Load(d, s.r + i), hn::Load(d, s.g + i), hn::Load(d, s.b + i), hn::Load(d, s.a + i)},
          hn::Load(d, s.through + i)};
}
template <class Planes>
HWY_INLINE void store(const V4& v, Planes& to, std::size_t i) {
  const F32 d;
  hn::Store(v.x, d, to.r + i);
  hn::Store(v.y, d, to.g + i);
  hn::Store(v.z, d, to.b + i);
  hn::Store(v.w, d, to.a + i);
}
HWY_INLINE void store(const SeenPixel& pixel, Seen& to, std::size_t i) {
  store(pixel.color, to, i);
  hn::Store(pixel.through, F32{}, to.through + i);
}

/// Loads and a transposition take a fifth of the time of four gathers (Zen 3).
HWY_INLINE V4 load_colors(const std::uint64_t* sort_keys, const Vec4* colors) {
  const F32 d;
  const hn::RepartitionToWide<U32> wide;
  const auto color = [&](std::size_t i) HWY_ATTR {
    const float* const at = &colors[color_of_sort_key(sort_keys[i])].x;
#if HWY_MAX_BYTES >= 32
    const hn::Half<F32> half;
    return hn::Combine(d, hn::LoadU(half, &colors[color_of_sort_key(sort_keys[i + 4])].x),
                       hn::LoadU(half, at));
#else
    return hn::LoadU(d, at);
#endif
  };
  const auto c0 = color(0), c1 = color(1), c2 = color(2), c3 = color(3);
  const auto rg0 = hn::BitCast(wide, hn::InterleaveLower(d, c0, c1));
  const auto rg1 = hn::BitCast(wide, hn::InterleaveLower(d, c2, c3));
  const auto ba0 = hn::BitCast(wide, hn::InterleaveUpper(d, c0, c1));
  const auto ba1 = hn::BitCast(wide, hn::InterleaveUpper(d, c2, c3));
  return {hn::BitCast(d, hn::InterleaveLower(wide, rg0, rg1)),
          hn::BitCast(d, hn::InterleaveUpper(wide, rg0, rg1)),
          hn::BitCast(d, hn::InterleaveLower(wide, ba0, ba1)),
          hn::BitCast(d, hn::InterleaveUpper(wide, ba0, ba1))};
}

}  // namespace
}  // namespace rastrum::transparency::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_TRANSPARENCY_BLEND_LANES_INL_HPP
