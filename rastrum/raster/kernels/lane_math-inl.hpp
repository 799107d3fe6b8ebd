// Names for arithmetic in lanes, so that a body of plain operators serves floats and vectors: F is
// the lanes, V3 and V4 three and four of them. Include it in a namespace of an instruction set
// (HWY_NAMESPACE) that has said what F is; scalar_lane.hpp is the same of one float. A body that is
// written in these names (shade/lit_light-inl.hpp, say) is included after either, in the same
// namespace. So it is compiled for each instruction set, which a template in a common header would
// not be.
//
// No guard: each source of each instruction set has its own.

#define RASTRUM_LANES HWY_INLINE

struct V3 {
  F x, y, z;
};
struct V4 {
  F x, y, z, w;
};

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
/// The smaller, the larger. Not defined for NaN, where processors differ.
HWY_INLINE F min_of(F a, F b) {
  return hn::Min(a, b);
}
HWY_INLINE F max_of(F a, F b) {
  return hn::Max(a, b);
}
/// Lanes of `mask` from `yes`, the rest from `no`.
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
/// The same where `no` is 0.
template <class Mask>
HWY_INLINE F choose_or_zero(Mask mask, F yes) {
  return hn::IfThenElseZero(mask, yes);
}
template <class Mask>
HWY_INLINE V4 choose_or_zero(Mask mask, const V4& yes) {
  return {choose_or_zero(mask, yes.x), choose_or_zero(mask, yes.y), choose_or_zero(mask, yes.z),
          choose_or_zero(mask, yes.w)};
}
