// SPDX-License-Identifier: BSD-3-Clause
// Greys of depths with Highway, per instruction set (depth_greys.hpp).

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/render/depth_greys_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstdint>

#include <rastrum/render/depth_greys.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2
namespace hn = hwy::HWY_NAMESPACE;

using F32 = hn::CappedTag<float, 16>;
using I32 = hn::RebindToSigned<F32>;
using F = hn::Vec<F32>;
constexpr std::size_t kLanes = hn::MaxLanes(F32{});

/// Calls use(at, depths, count) for n depths. Lanes from `count` on are 0, no depth.
template <class Use>
HWY_INLINE void for_each_vector(const float* depth, std::size_t n, const Use& use) {
  const F32 d;
  std::size_t x = 0;
  for (; x + kLanes <= n; x += kLanes) use(x, hn::LoadU(d, depth + x), kLanes);
  if (x == n) return;
  HWY_ALIGN float rest[kLanes] = {};
  std::copy_n(depth + x, n - x, rest);
  use(x, hn::Load(d, rest), n - x);
}

void widen(const float* depth, std::size_t n, DepthRange& range) noexcept {
  const F32 d;
  const F zero = hn::Zero(d), one = hn::Set(d, 1.0F);
  F nearest = zero, farthest = one;
  for_each_vector(depth, n, [&](std::size_t, F v, std::size_t) HWY_ATTR {
    const auto is_one = v > zero;
    nearest = hn::Max(nearest, hn::IfThenElseZero(is_one, v));
    farthest = hn::Min(farthest, hn::IfThenElse(is_one, v, one));
  });
  range.nearest = std::max(range.nearest, hn::GetLane(hn::MaxOfLanes(d, nearest)));
  range.farthest = std::min(range.farthest, hn::GetLane(hn::MinOfLanes(d, farthest)));
}

void grey_row(const float* depth, std::size_t n, const DepthGreys& greys, Rgba8* out) noexcept {
  const F32 d;
  const I32 di;
  const F zero = hn::Zero(d), one = hn::Set(d, 1.0F), full = hn::Set(d, 255.0F);
  const F nearest = hn::Set(d, greys.nearest), scale = hn::Set(d, greys.scale);
  const auto behind = hn::Set(di, std::bit_cast<std::int32_t>(greys.behind8));
  const auto opaque = hn::Set(di, std::bit_cast<std::int32_t>(Rgba8{0, 0, 0, 255}));
  for_each_vector(depth, n, [&](std::size_t x, F v, std::size_t count) HWY_ATTR {
    const F grey = one - (nearest - v) * scale;
    const F cut = hn::IfThenElseZero(grey > zero, hn::IfThenElse(grey < one, grey, one));
    const auto level = hn::NearestInt(cut * full);
    const auto twice = hn::Or(level, hn::ShiftLeft<8>(level));
    const auto color = hn::Or(hn::Or(twice, hn::ShiftLeft<16>(level)), opaque);
    const auto picked = hn::IfThenElse(hn::RebindMask(di, v > zero), color, behind);
    auto* const to = reinterpret_cast<std::int32_t*>(out + x);
    if (count == kLanes) {
      hn::StoreU(picked, di, to);
      return;
    }
    HWY_ALIGN std::int32_t rest[kLanes];
    hn::Store(picked, di, rest);
    for (std::size_t i = 0; i < count; ++i) out[x + i] = std::bit_cast<Rgba8>(rest[i]);
  });
}

[[maybe_unused]] constexpr DepthLanes kDepthLanes{widen, grey_row};

}  // namespace
}  // namespace rastrum::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum {

const DepthLanes& depth_lanes(Isa isa) noexcept {
  static constexpr const DepthLanes* kAll[] = RASTRUM_BY_ISA(kDepthLanes, &kScalarDepthLanes);
  return *kAll[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum
#endif
