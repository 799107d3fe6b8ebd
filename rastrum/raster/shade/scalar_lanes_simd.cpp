// SPDX-License-Identifier: BSD-3-Clause
// Colours of scalars with Highway, compiled once per instruction set.

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/shade/scalar_lanes_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <rastrum/raster/shade/scalar_lanes.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2
namespace hn = hwy::HWY_NAMESPACE;

using F64 = hn::CappedTag<double, 8>;
using I64 = hn::RebindToSigned<F64>;
using D = hn::Vec<F64>;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(F64{}));
static_assert(64 % kLanes == 0);

void map(const ScalarRamp& ramp, const double* numbers, MappedColors& colors) noexcept {
  const F64 d;
  const I64 di;
  const hn::Rebind<float, F64> df;
  const D zero = hn::Zero(d), one = hn::Set(d, 1.0);
  const D low = hn::Set(d, ramp.low), high = hn::Set(d, ramp.high);
  const D span = hn::Set(d, ramp.span), last = hn::Set(d, ramp.last);
  float* const to[4] = {colors.r, colors.g, colors.b, colors.a};
  const float below[4] = {ramp.below.x, ramp.below.y, ramp.below.z, ramp.below.w};
  const float above[4] = {ramp.above.x, ramp.above.y, ramp.above.z, ramp.above.w};
  const float no[4] = {ramp.nan.x, ramp.nan.y, ramp.nan.z, ramp.nan.w};
  for (int k = 0; k < 64; k += kLanes) {
    const D value = hn::Load(d, numbers + k);
    D part = hn::Set(d, 0.5);
    if (ramp.span > 0) {
      part = (value - low) / span;
      part = hn::IfThenElse(part < zero, zero, hn::IfThenElse(one < part, one, part));
    }
    // NaN and numbers out of range read the first colour, which is replaced below.
    const auto is_nan = hn::IsNaN(value);
    const auto is_below = value<low, is_above = value> high;
    part = hn::IfThenZeroElse(hn::Or(is_nan, hn::Or(is_below, is_above)), part);
    const D at = part * last;
    const D from = hn::Floor(at);
    const D next = hn::IfThenElse(from + one < last, from + one, last);
    const D between = at - from;
    const auto i = hn::ShiftLeft<2>(hn::ConvertTo(di, from));
    const auto j = hn::ShiftLeft<2>(hn::ConvertTo(di, next));
    for (int c = 0; c < 4; ++c) {
      const D a = hn::GatherIndex(d, ramp.colors.data() + c, i);
      const D b = hn::GatherIndex(d, ramp.colors.data() + c, j);
      D color = a + (b - a) * between;
      color = hn::IfThenElse(is_above, hn::Set(d, static_cast<double>(above[c])), color);
      color = hn::IfThenElse(is_below, hn::Set(d, static_cast<double>(below[c])), color);
      color = hn::IfThenElse(is_nan, hn::Set(d, static_cast<double>(no[c])), color);
      hn::Store(hn::DemoteTo(df, color), df, to[c] + k);
    }
  }
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::raster {

ScalarRamp::ScalarRamp(const ScalarColors& of)
    : low(of.range().low),
      high(of.range().high),
      span(high - low),
      below(of.below()),
      above(of.above()),
      nan(of.nan()),
      last(static_cast<double>(of.colors().size() - 1)) {
  for (const Vec4 c : of.colors())
    for (const float channel : {c.x, c.y, c.z, c.w}) colors.push_back(static_cast<double>(channel));
}

MapNumbers map_numbers(Isa isa) noexcept {
  static constexpr MapNumbers kMaps[] = RASTRUM_BY_ISA(map, nullptr);
  return kMaps[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::raster
#endif
