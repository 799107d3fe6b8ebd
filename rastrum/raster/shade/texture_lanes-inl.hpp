// Texture lookups for the fragments of a triangle, once for each instruction set: coordinates and
// levels of detail in lanes, texels one fragment at a time (they are gathers, bound by loads). What
// is done at each is texture_lookup.hpp's.

#if defined(RASTRUM_TEXTURE_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_TEXTURE_LANES_INL_HPP
#undef RASTRUM_TEXTURE_LANES_INL_HPP
#else
#define RASTRUM_TEXTURE_LANES_INL_HPP
#endif

#include <hwy/highway.h>

#include <rastrum/raster/shade/texture_lookup.hpp>

HWY_BEFORE_NAMESPACE();
namespace rastrum::raster {
namespace HWY_NAMESPACE {

/// Loops take so many fragments at a time, so that compilers turn them into whole vectors.
constexpr int kGroup = 8;

/// Texture coordinates of up to 64 fragments and their change per px.
struct alignas(64) Coordinates {
  float u[64], v[64];
  float u_dx[64], u_dy[64], v_dx[64], v_dy[64];
};

struct alignas(64) Texels {
  float r[64], g[64], b[64], a[64];
};

template <Wrap kWrap>
HWY_INLINE void fold_all(const float* HWY_RESTRICT in, int padded, float* HWY_RESTRICT out) {
  for (int k = 0; k < padded; k += kGroup)
    for (int j = k; j < k + kGroup; ++j) out[j] = fold<kWrap>(in[j]);
}

HWY_INLINE void fold_all(Wrap wrap, const float* in, int padded, float* out) {
  switch (wrap) {
    case Wrap::repeat:
      return fold_all<Wrap::repeat>(in, padded, out);
    case Wrap::mirrored_repeat:
      return fold_all<Wrap::mirrored_repeat>(in, padded, out);
    case Wrap::clamp_to_edge:
      return fold_all<Wrap::clamp_to_edge>(in, padded, out);
  }
}

/// log2 of the longer axis of a pixel's footprint, in texels of level 0.
HWY_INLINE void levels_of_detail(const MipChain& chain, const Coordinates& at, int padded,
                                 float* HWY_RESTRICT lod) {
  const float width = static_cast<float>(chain.level[0].width);
  const float height = static_cast<float>(chain.level[0].height);
  for (int k = 0; k < padded; k += kGroup)
    for (int j = k; j < k + kGroup; ++j)
      lod[j] = level_of_detail(width, height, at.u_dx[j], at.v_dx[j], at.u_dy[j], at.v_dy[j]);
}

/// Calls out(k, value) for fragments k in [0, n).
template <class Decode, class Out>
HWY_INLINE void sample(const MipChain& chain, const Coordinates& at, int n, int padded, Out&& out) {
  alignas(64) float u[64], v[64], lod[64];
  fold_all(chain.wrap_u, at.u, padded, u);
  fold_all(chain.wrap_v, at.v, padded, v);
  levels_of_detail(chain, at, padded, lod);
  const Lookup<Decode> lookup(chain);
  for (int k = 0; k < n; ++k) out(k, lookup(u[k], v[k], lod[k]));
}

}  // namespace HWY_NAMESPACE
}  // namespace rastrum::raster
HWY_AFTER_NAMESPACE();

#endif
