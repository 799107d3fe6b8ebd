// SPDX-License-Identifier: BSD-3-Clause
// Names for arithmetic in lanes, so that one body of plain operators serves floats and vectors. F
// is the lanes, V3 and V4 three and four of them; rules/scalar_lane.hpp has the same for one float.
// A body in these names is a NAME.inl. It includes only bodies, and headers include it into a
// namespace of lanes or of one float (decision 0124).
#if defined(RASTRUM_RASTER_KERNELS_LANE_MATH_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_KERNELS_LANE_MATH_INL_HPP
#undef RASTRUM_RASTER_KERNELS_LANE_MATH_INL_HPP
#else
#define RASTRUM_RASTER_KERNELS_LANE_MATH_INL_HPP
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <rastrum/raster/kernels/lanes-inl.hpp>
#include <rastrum/raster/rules/srgb.hpp>
#include <rastrum/vec.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

struct V3 {
  F x, y, z;
};
struct V4 {
  F x, y, z, w;
};

HWY_INLINE V3 load(const float* x, const float* y, const float* z) {
  return {hn::Load(hn::DFromV<F>(), x), hn::Load(hn::DFromV<F>(), y), hn::Load(hn::DFromV<F>(), z)};
}
HWY_INLINE void store(const V3& v, float* x, float* y, float* z) {
  hn::Store(v.x, hn::DFromV<F>(), x);
  hn::Store(v.y, hn::DFromV<F>(), y);
  hn::Store(v.z, hn::DFromV<F>(), z);
}
template <std::size_t kCount>
HWY_INLINE V3 load(const float (&v)[3][kCount], std::size_t at = 0) {
  return load(v[0] + at, v[1] + at, v[2] + at);
}
template <std::size_t kCount>
HWY_INLINE void store(const V3& v, float (&to)[3][kCount], std::size_t at = 0) {
  store(v, to[0] + at, to[1] + at, to[2] + at);
}

HWY_INLINE F set(float v) {
  return hn::Set(hn::DFromV<F>(), v);
}
HWY_INLINE V3 set(Vec3 v) {
  return {set(v.x), set(v.y), set(v.z)};
}
HWY_INLINE V3 operator+(const V3& a, const V3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE V3 operator-(const V3& a, const V3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE V3 operator-(const V3& a) {
  return {hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z)};
}
HWY_INLINE V3 operator*(const V3& a, F s) {
  return {a.x * s, a.y * s, a.z * s};
}
HWY_INLINE V3 operator*(const V3& a, const V3& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
HWY_INLINE F dot(const V3& a, const V3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE V4 operator+(const V4& a, const V4& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
}
HWY_INLINE V4 operator*(const V4& a, F s) {
  return {a.x * s, a.y * s, a.z * s, a.w * s};
}
HWY_INLINE F square_root(F v) {
  return hn::Sqrt(v);
}
/// Not defined for NaN, where processors differ.
HWY_INLINE F min_of(F a, F b) {
  return hn::Min(a, b);
}
HWY_INLINE F max_of(F a, F b) {
  return hn::Max(a, b);
}
template <class Mask>
HWY_INLINE F choose(Mask mask, F yes, F no) {
  return hn::IfThenElse(mask, yes, no);
}
template <class Mask>
HWY_INLINE V3 choose(Mask mask, const V3& yes, const V3& no) {
  return {choose(mask, yes.x, no.x), choose(mask, yes.y, no.y), choose(mask, yes.z, no.z)};
}
template <class Mask>
HWY_INLINE V4 choose(Mask mask, const V4& yes, const V4& no) {
  return {choose(mask, yes.x, no.x), choose(mask, yes.y, no.y), choose(mask, yes.z, no.z),
          choose(mask, yes.w, no.w)};
}
template <class Mask>
HWY_INLINE F choose_or_zero(Mask mask, F yes) {
  return hn::IfThenElseZero(mask, yes);
}
template <class Mask>
HWY_INLINE V4 choose_or_zero(Mask mask, const V4& yes) {
  return {choose_or_zero(mask, yes.x), choose_or_zero(mask, yes.y), choose_or_zero(mask, yes.z),
          choose_or_zero(mask, yes.w)};
}

// Look-ups: loads by lane, and calls that cannot be made for all lanes at once.

using Whole = hn::Vec<hn::RebindToSigned<hn::DFromV<F>>>;
/// Towards 0; `v` must fit an int.
HWY_INLINE Whole truncated(F v) {
  return hn::ConvertTo(hn::RebindToSigned<hn::DFromV<F>>(), v);
}
HWY_INLINE F as_float(Whole v) {
  return hn::ConvertTo(hn::DFromV<F>(), v);
}
HWY_INLINE Whole times_plus(Whole a, int by, Whole b) {
  return hn::Add(hn::Mul(a, hn::Set(hn::DFromV<Whole>(), by)), b);
}
HWY_INLINE Whole plus(Whole a, int b) {
  return hn::Add(a, hn::Set(hn::DFromV<Whole>(), b));
}
HWY_INLINE F looked_up(const float* table, Whole place) {
  return hn::GatherIndex(hn::DFromV<F>(), table, place);
}
template <class Mask>
HWY_INLINE Mask both(Mask a, Mask b) {
  return hn::And(a, b);
}
template <class Mask>
HWY_INLINE bool none(Mask mask) {
  return hn::AllFalse(hn::DFromV<F>(), mask);
}

/// Calls use(value, mask of the lanes that have it) for each value in `v`, none a NaN.
template <class Use>
HWY_INLINE void for_each_value(F v, const Use& use) {
  const hn::DFromV<F> d;
  for (auto rest = v == v;;) {
    const float value = hn::ExtractLane(v, hn::FindKnownFirstTrue(d, rest));
    const auto here = v == set(value);
    use(value, here);
    rest = hn::AndNot(here, rest);
    if (none(rest)) return;
  }
}

/// Calls of.at for each lane. It makes a vector from a vector and a number.
template <class Of>
HWY_INLINE V3 lane_by_lane(const Of& of, const V3& a, F b) {
  const hn::DFromV<F> d;
  constexpr std::size_t kCount = hn::MaxLanes(hn::DFromV<F>());
  HWY_ALIGN float v[4][kCount];
  hn::Store(a.x, d, v[0]);
  hn::Store(a.y, d, v[1]);
  hn::Store(a.z, d, v[2]);
  hn::Store(b, d, v[3]);
  HWY_ALIGN float said[3][kCount];
  for (std::size_t i = 0; i < kCount; ++i) {
    const Vec3 of_lane = of.at(Vec3{v[0][i], v[1][i], v[2][i]}, v[3][i]);
    said[0][i] = of_lane.x;
    said[1][i] = of_lane.y;
    said[2][i] = of_lane.z;
  }
  return {hn::Load(d, said[0]), hn::Load(d, said[1]), hn::Load(d, said[2])};
}

#define RASTRUM_LANES HWY_INLINE
#include <rastrum/raster/rules/srgb_curve.inl>
#undef RASTRUM_LANES

// Colours to 8 bits: quantize (color.hpp).

/// The result is in the lowest 8 bits, below the bits of 2²³. A sum of that size has no fraction
/// bits, so it is rounded to the nearest whole number, ties to even.
template <class V>
HWY_INLINE auto quantize_lanes(V v) {
  const hn::DFromV<V> d;
  const V low = hn::IfThenElseZero(hn::Gt(v, hn::Zero(d)), v);
  const V scaled = hn::Mul(hn::Min(low, hn::Set(d, 1.0F)), hn::Set(d, 255.0F));
  return hn::BitCast(hn::RebindToUnsigned<hn::DFromV<V>>(),
                     hn::Add(scaled, hn::Set(d, 8388608.0F)));
}

/// Pixels whose alpha is in the highest 8 bits of `alpha`; its other bits are 0.
template <class V>
HWY_INLINE auto packed(V r, V g, V b, std::uint32_t alpha) {
  const hn::RebindToUnsigned<hn::DFromV<V>> d;
  const auto green_blue =
      hn::Or(hn::ShiftLeft<8>(quantize_lanes(g)), hn::ShiftLeft<16>(quantize_lanes(b)));
  // The shifts drop the 2²³ bits from green and blue; red's become the alpha.
  constexpr std::uint32_t kSum = 0x4B000000;
  const auto red = hn::Add(quantize_lanes(r), hn::Set(d, alpha - kSum));
  return hn::Or(red, green_blue);
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_KERNELS_LANE_MATH_INL_HPP
