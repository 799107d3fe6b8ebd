// Look-ups: loads from memory by lanes, and calls that cannot be made for all lanes at once.
// Include it after lane_math-inl.hpp, in its namespace; lights_scalar.hpp has the same for one
// float.

/// Whole numbers.
using Whole = hn::Vec<hn::RebindToSigned<hn::DFromV<F>>>;
/// Rounds towards 0; `v` must fit in an int.
HWY_INLINE Whole truncated(F v) {
  return hn::ConvertTo(hn::RebindToSigned<hn::DFromV<F>>(), v);
}
HWY_INLINE F as_float(Whole v) {
  return hn::ConvertTo(hn::DFromV<F>(), v);
}
/// a · by + b.
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

/// Calls of.at for each lane, one by one. It makes a vector from a vector and a number.
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
