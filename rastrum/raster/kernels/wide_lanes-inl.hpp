// SPDX-License-Identifier: BSD-3-Clause
// Names for arithmetic in float64 lanes, and the quadrics of rules/ in them. `scalar_wide` in
// rules/quadric.hpp has both for doubles.
#if defined(RASTRUM_RASTER_KERNELS_WIDE_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_KERNELS_WIDE_LANES_INL_HPP
#undef RASTRUM_RASTER_KERNELS_WIDE_LANES_INL_HPP
#else
#define RASTRUM_RASTER_KERNELS_WIDE_LANES_INL_HPP
#endif

#include <hwy/highway.h>

#include <rastrum/raster/kernels/lanes-inl.hpp>
#include <rastrum/raster/rules/make_quadric.hpp>
#include <rastrum/raster/rules/quadric.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

using W = D;
using WideMask = hn::Mask<F64>;

struct WideVec {
  W x, y, z;
};

HWY_INLINE W wide(double v) {
  return hn::Set(F64{}, v);
}
HWY_INLINE WideVec wide(const Vec3d& v) {
  return {wide(v.x), wide(v.y), wide(v.z)};
}
HWY_INLINE W square_root(W v) {
  return hn::Sqrt(v);
}
HWY_INLINE W absolute(W v) {
  return hn::Abs(v);
}
HWY_INLINE W floor_of(W v) {
  return hn::Floor(v);
}
HWY_INLINE W lesser(W a, W b) {
  return hn::Min(a, b);
}
HWY_INLINE W greater(W a, W b) {
  return hn::Max(a, b);
}
HWY_INLINE WideMask below(W a, W b) {
  return hn::Lt(a, b);
}
HWY_INLINE WideMask at_most(W a, W b) {
  return hn::Le(a, b);
}
HWY_INLINE WideMask both(WideMask a, WideMask b) {
  return hn::And(a, b);
}
HWY_INLINE WideMask either(WideMask a, WideMask b) {
  return hn::Or(a, b);
}
HWY_INLINE WideMask opposite(WideMask a) {
  return hn::Not(a);
}
HWY_INLINE bool is_any(WideMask a) {
  return !hn::AllFalse(F64{}, a);
}
HWY_INLINE W choose(WideMask mask, W yes, W no) {
  return hn::IfThenElse(mask, yes, no);
}
HWY_INLINE WideVec operator+(const WideVec& a, const WideVec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE WideVec operator-(const WideVec& a, const WideVec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE WideVec operator*(const WideVec& a, W s) {
  return {a.x * s, a.y * s, a.z * s};
}
HWY_INLINE W dot(const WideVec& a, const WideVec& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE WideVec cross(const WideVec& a, const WideVec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

#define RASTRUM_LANES HWY_INLINE
#define RASTRUM_LAMBDA HWY_ATTR
#include <rastrum/raster/rules/quadric_depth.inl>
#include <rastrum/raster/rules/quadric_form.inl>
#undef RASTRUM_LAMBDA
#undef RASTRUM_LANES

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_KERNELS_WIDE_LANES_INL_HPP
