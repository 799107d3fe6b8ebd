// What cannot be asked of all lanes at once. After lane_math-inl.hpp, in its namespace.

/// What `of` says at each lane, one by one.
template <class Of>
HWY_INLINE F lane_by_lane(const Of& of, const V3& a, const V3& b) {
  const hn::DFromV<F> d;
  constexpr std::size_t kCount = hn::MaxLanes(hn::DFromV<F>());
  HWY_ALIGN float v[6][kCount];
  hn::Store(a.x, d, v[0]);
  hn::Store(a.y, d, v[1]);
  hn::Store(a.z, d, v[2]);
  hn::Store(b.x, d, v[3]);
  hn::Store(b.y, d, v[4]);
  hn::Store(b.z, d, v[5]);
  HWY_ALIGN float said[kCount];
  for (std::size_t i = 0; i < kCount; ++i)
    said[i] = of.at(Vec3{v[0][i], v[1][i], v[2][i]}, Vec3{v[3][i], v[4][i], v[5][i]});
  return hn::Load(d, said);
}
/// The same of a vector and a number, which makes a vector.
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
