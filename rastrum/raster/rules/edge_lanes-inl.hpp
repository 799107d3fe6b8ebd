// SPDX-License-Identifier: BSD-3-Clause
// edge_value (coverage.hpp) in lanes, once per instruction set.
#if defined(RASTRUM_RASTER_RULES_EDGE_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_RULES_EDGE_LANES_INL_HPP
#undef RASTRUM_RASTER_RULES_EDGE_LANES_INL_HPP
#else
#define RASTRUM_RASTER_RULES_EDGE_LANES_INL_HPP
#endif

#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {  // each source has its own

/// `V`: vectors of int32. No product may overflow.
template <class V>
HWY_INLINE V edge_lanes(V a, V b, V dx, V dy) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::DFromV<V> d;
  const V zero = hn::Zero(d);
  const auto top_left = hn::Or(hn::Gt(a, zero), hn::And(hn::Eq(a, zero), hn::Gt(b, zero)));
  const V value = hn::Add(hn::Mul(a, dx), hn::Mul(b, dy));
  return hn::Sub(value, hn::IfThenZeroElse(top_left, hn::Set(d, 1)));
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_RULES_EDGE_LANES_INL_HPP
