// SPDX-License-Identifier: BSD-3-Clause
// Darkens 8-bit colours with Highway, per instruction set. A lane is a pixel.
#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/overlay/effects/darken_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include <rastrum/overlay/effects/darken.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::overlay::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

void darken(const float* factor, Vec3 ink, int count, Rgba8* colors) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const hn::RebindToSigned<decltype(d)> di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto one = hn::Set(d, 1.0F), most = hn::Set(d, 255.0F);
  const auto low = hn::Set(du, 255U);
  int i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto f = hn::LoadU(d, factor + i);
    if (hn::AllTrue(d, hn::Eq(f, one))) continue;
    const auto left = hn::Sub(one, f);
    auto* const place = reinterpret_cast<std::uint32_t*>(colors + i);
    const auto pixel = hn::LoadU(du, place);
    const auto mixed = [&](auto channel, float to) HWY_ATTR {
      const auto from = hn::ConvertTo(d, hn::BitCast(di, hn::And(channel, low)));
      const auto v = hn::Add(hn::Mul(from, f), hn::Mul(hn::Set(d, to), left));
      return hn::BitCast(du, hn::NearestInt(hn::Min(hn::Max(v, hn::Zero(d)), most)));
    };
    const auto red = mixed(pixel, ink.x), green = mixed(hn::ShiftRight<8>(pixel), ink.y),
               blue = mixed(hn::ShiftRight<16>(pixel), ink.z);
    const auto alpha = hn::And(pixel, hn::Set(du, 0xff000000U));
    hn::StoreU(hn::Or(hn::Or(red, hn::ShiftLeft<8>(green)), hn::Or(hn::ShiftLeft<16>(blue), alpha)),
               du, place);
  }
  darken_plain(factor + i, ink, count - i, colors + i);
}

}  // namespace
}  // namespace rastrum::overlay::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::overlay {

void darken_plain(const float* factor, Vec3 ink, int count, Rgba8* colors) {
  for (int i = 0; i < count; ++i) {
    const float f = factor[i], left = 1 - f;
    if (f == 1) continue;
    const auto mixed = [&](std::uint8_t from, float to) {
      const float v = static_cast<float>(from) * f + to * left;
      return static_cast<std::uint8_t>(std::nearbyint(std::clamp(v, 0.0F, 255.0F)));
    };
    Rgba8& c = colors[i];
    c = {mixed(c.r, ink.x), mixed(c.g, ink.y), mixed(c.b, ink.z), c.a};
  }
}

DarkenKernel darken_kernel(Isa isa) noexcept {
  static constexpr DarkenKernel kKernels[] = RASTRUM_BY_ISA(darken, &darken_plain);
  return kKernels[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::overlay
#endif
