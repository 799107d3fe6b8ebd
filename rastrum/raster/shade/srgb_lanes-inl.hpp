// srgb_from_linear in lanes, the same bits; once for each instruction set.

#if defined(RASTRUM_SRGB_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_SRGB_LANES_INL_HPP
#undef RASTRUM_SRGB_LANES_INL_HPP
#else
#define RASTRUM_SRGB_LANES_INL_HPP
#endif

#include <hwy/highway.h>

#include <rastrum/raster/shade/srgb.hpp>

HWY_BEFORE_NAMESPACE();
namespace rastrum::raster {
namespace HWY_NAMESPACE {

template <class Floats>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<Floats> srgb_lanes(Floats d,
                                                      hwy::HWY_NAMESPACE::Vec<Floats> linear) {
  namespace hn = hwy::HWY_NAMESPACE;
  const auto constant = [&](float c) HWY_ATTR { return hn::Set(d, c); };
  const auto at_least_0 = hn::IfThenElseZero(linear > hn::Zero(d), linear);
  const auto x = hn::Min(at_least_0, constant(1));
  const auto s2 = hn::Sqrt(x);
  const auto s4 = hn::Sqrt(s2);
  const auto s8 = hn::Sqrt(s4);
  const auto curve = constant(kSrgbRoot2) * s2 + constant(kSrgbRoot4) * s4 -
                     constant(kSrgbRoot8) * s8 -
                     (constant(kSrgbLinear) * x + constant(kSrgbConstant));
  return hn::IfThenElse(x < constant(kSrgbKnee), x * constant(kSrgbSlope), curve);
}

}  // namespace HWY_NAMESPACE
}  // namespace rastrum::raster
HWY_AFTER_NAMESPACE();

#endif
