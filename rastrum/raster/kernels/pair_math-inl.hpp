// SPDX-License-Identifier: BSD-3-Clause
// The names of lane_math-inl.hpp for two vectors at once. One long chain of operations
// (shade/lit_fixed.inl) waits for each of them; two chains side by side overlap their waits. A
// processor does not overlap them by itself, since it looks ahead by less than a chain.
#if defined(RASTRUM_RASTER_KERNELS_PAIR_MATH_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_KERNELS_PAIR_MATH_INL_HPP
#undef RASTRUM_RASTER_KERNELS_PAIR_MATH_INL_HPP
#else
#define RASTRUM_RASTER_KERNELS_PAIR_MATH_INL_HPP
#endif

#include <hwy/highway.h>

#include <rastrum/raster/kernels/lane_math-inl.hpp>
#include <rastrum/vec.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

namespace pairs {

using One = hn::Vec<F32>;
struct F {
  One a, b;
};
struct Mask {
  hn::Mask<F32> a, b;
};
struct V3 {
  F x, y, z;
};

HWY_INLINE F set(float v) {
  const One one = hn::Set(F32(), v);
  return {one, one};
}
HWY_INLINE V3 set(Vec3 v) {
  return {set(v.x), set(v.y), set(v.z)};
}
/// v in both.
HWY_INLINE V3 twice(const HWY_NAMESPACE::V3& v) {
  return {{v.x, v.x}, {v.y, v.y}, {v.z, v.z}};
}
HWY_INLINE F operator+(const F& a, const F& b) {
  return {a.a + b.a, a.b + b.b};
}
HWY_INLINE F operator-(const F& a, const F& b) {
  return {a.a - b.a, a.b - b.b};
}
HWY_INLINE F operator*(const F& a, const F& b) {
  return {a.a * b.a, a.b * b.b};
}
HWY_INLINE F operator/(const F& a, const F& b) {
  return {a.a / b.a, a.b / b.b};
}
HWY_INLINE Mask operator>(const F& a, const F& b) {
  return {a.a > b.a, a.b > b.b};
}
HWY_INLINE Mask operator<(const F& a, const F& b) {
  return {a.a < b.a, a.b < b.b};
}
HWY_INLINE V3 operator+(const V3& a, const V3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE V3 operator-(const V3& a, const V3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE V3 operator-(const V3& a) {
  const auto minus = [](const F& v) HWY_ATTR { return F{hn::Neg(v.a), hn::Neg(v.b)}; };
  return {minus(a.x), minus(a.y), minus(a.z)};
}
HWY_INLINE V3 operator*(const V3& a, const F& s) {
  return {a.x * s, a.y * s, a.z * s};
}
HWY_INLINE V3 operator*(const V3& a, const V3& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
HWY_INLINE F dot(const V3& a, const V3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE F square_root(const F& v) {
  return {hn::Sqrt(v.a), hn::Sqrt(v.b)};
}
HWY_INLINE F max_of(const F& a, const F& b) {
  return {hn::Max(a.a, b.a), hn::Max(a.b, b.b)};
}
HWY_INLINE F choose(const Mask& mask, const F& yes, const F& no) {
  return {hn::IfThenElse(mask.a, yes.a, no.a), hn::IfThenElse(mask.b, yes.b, no.b)};
}
HWY_INLINE V3 choose(const Mask& mask, const V3& yes, const V3& no) {
  return {choose(mask, yes.x, no.x), choose(mask, yes.y, no.y), choose(mask, yes.z, no.z)};
}
HWY_INLINE F choose_or_zero(const Mask& mask, const F& yes) {
  return {hn::IfThenElseZero(mask.a, yes.a), hn::IfThenElseZero(mask.b, yes.b)};
}

}  // namespace pairs

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_KERNELS_PAIR_MATH_INL_HPP
