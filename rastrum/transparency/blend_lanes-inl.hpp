// Vectors of a block's colours and of what is seen of its pixels. Include it in a namespace of an
// instruction set that has lanes-inl.hpp's names.

#include <rastrum/raster/kernels/lane_math-inl.hpp>
#include <rastrum/transparency/over-inl.hpp>
#undef RASTRUM_LANES

HWY_INLINE V4 load(const raster::BlockColors& c, std::size_t i) {
  const F32 d;
  return {hn::Load(d, c.r + i), hn::Load(d, c.g + i), hn::Load(d, c.b + i), hn::Load(d, c.a + i)};
}
HWY_INLINE SeenPixel load(const Seen& s, std::size_t i) {
  const F32 d;
  return {{hn::Load(d, s.r + i), hn::Load(d, s.g + i), hn::Load(d, s.b + i), hn::Load(d, s.a + i)},
          hn::Load(d, s.through + i)};
}
/// To a BlockColors or a Seen.
template <class Planes>
HWY_INLINE void store(const V4& v, Planes& to, std::size_t i) {
  const F32 d;
  hn::Store(v.x, d, to.r + i);
  hn::Store(v.y, d, to.g + i);
  hn::Store(v.z, d, to.b + i);
  hn::Store(v.w, d, to.a + i);
}
HWY_INLINE void store(const SeenPixel& pixel, Seen& to, std::size_t i) {
  store(pixel.color, to, i);
  hn::Store(pixel.through, F32{}, to.through + i);
}
