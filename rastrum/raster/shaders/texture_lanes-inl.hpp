// Texture lookups for the fragments of a triangle, once for each instruction set: coordinates and
// levels of detail in lanes, texels one fragment at a time (they are gathers, bound by loads).
// Filtering follows the OpenGL 4.6 specification, sections 8.14 and 8.15.

#if defined(RASTRUM_TEXTURE_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_TEXTURE_LANES_INL_HPP
#undef RASTRUM_TEXTURE_LANES_INL_HPP
#else
#define RASTRUM_TEXTURE_LANES_INL_HPP
#endif

#include <bit>
#include <cmath>
#include <cstdint>

#include <hwy/highway.h>

#include <rastrum/raster/shaders/srgb.hpp>
#include <rastrum/raster/shaders/texture.hpp>

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

struct Texel {
  float r, g, b, a;
};

HWY_INLINE float mix(float p, float q, float f) {
  return p + (q - p) * f;
}
HWY_INLINE Texel mix(Texel p, Texel q, float f) {
  return {p.r + (q.r - p.r) * f, p.g + (q.g - p.g) * f, p.b + (q.b - p.b) * f,
          p.a + (q.a - p.a) * f};
}

/// log2 to 1.5e-5, minimax on the mantissa; at 0 below −60, at infinity and NaN 128.
HWY_INLINE float log2_lanes(float x) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x);
  const float exponent = static_cast<float>(static_cast<std::int32_t>(bits >> 23 & 255U) - 127);
  const float m = std::bit_cast<float>((bits & 0x7fffffU) | 0x3f800000U) - 1;
  const float fraction =
      m *
      (1.4419655F + m * (-0.70966190F + m * (0.41759279F + m * (-0.19626580F + m * 0.046383667F))));
  return exponent + ((bits & 0x7fffffffU) > 0x7f800000U ? 0 : fraction);
}

/// The coordinate inside one copy of the picture, in [0, 1]; NaN and infinity become 0.
template <Wrap kWrap>
HWY_INLINE float fold(float t) {
  float f = t;
  if constexpr (kWrap == Wrap::repeat) f = t - std::floor(t);
  if constexpr (kWrap == Wrap::mirrored_repeat) {
    const float period = t - 2 * std::floor(t * 0.5F);
    f = period > 1 ? 2 - period : period;
  }
  return f > 0 ? (f < 1 ? f : 1.0F) : 0.0F;
}

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
    for (int j = k; j < k + kGroup; ++j) {
      const float ux = at.u_dx[j] * width, vx = at.v_dx[j] * height;
      const float uy = at.u_dy[j] * width, vy = at.v_dy[j] * height;
      const float along_x = ux * ux + vx * vx;
      const float along_y = uy * uy + vy * vy;
      lod[j] = 0.5F * log2_lanes(along_x > along_y ? along_x : along_y);
    }
}

/// What of a texel is wanted, decoded.
struct AllChannels {
  const float* decode;
  HWY_INLINE Texel operator()(Rgba8 t) const {
    return {decode[t.r], decode[t.g], decode[t.b], static_cast<float>(t.a) * (1.0F / 255.0F)};
  }
};
struct RedChannel {
  const float* decode;
  HWY_INLINE float operator()(Rgba8 t) const { return decode[t.r]; }
};
struct AlphaChannel {
  const float* decode;
  HWY_INLINE float operator()(Rgba8 t) const { return static_cast<float>(t.a) * (1.0F / 255.0F); }
};

/// Lookups at folded coordinates. A mirrored picture's edge is its own neighbour, as a clamped
/// one's.
template <class Decode>
class Lookup {
 public:
  explicit Lookup(const MipChain& chain)
      : decode_{chain.decode},
        wrap_u_(chain.wrap_u == Wrap::repeat),
        wrap_v_(chain.wrap_v == Wrap::repeat) {}

  HWY_INLINE auto nearest(const MipLevel& level, float u, float v) const {
    std::int32_t x = static_cast<std::int32_t>(u * static_cast<float>(level.width));
    std::int32_t y = static_cast<std::int32_t>(v * static_cast<float>(level.height));
    if (x >= level.width) x = wrap_u_ ? 0 : level.width - 1;
    if (y >= level.height) y = wrap_v_ ? 0 : level.height - 1;
    return decode_(level.texels[y * level.width + x]);
  }

  HWY_INLINE auto linear(const MipLevel& level, float u, float v) const {
    const float x = u * static_cast<float>(level.width) - 0.5F;
    const float y = v * static_cast<float>(level.height) - 0.5F;
    std::int32_t x0 = static_cast<std::int32_t>(x + 1) - 1;  // floor, x ≥ −0.5
    std::int32_t y0 = static_cast<std::int32_t>(y + 1) - 1;
    const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
    std::int32_t x1 = x0 + 1, y1 = y0 + 1;
    x0 = x0 < 0 ? (wrap_u_ ? level.width - 1 : 0) : x0;
    y0 = y0 < 0 ? (wrap_v_ ? level.height - 1 : 0) : y0;
    x1 = x1 >= level.width ? (wrap_u_ ? 0 : level.width - 1) : x1;
    y1 = y1 >= level.height ? (wrap_v_ ? 0 : level.height - 1) : y1;
    const Rgba8* const top = level.texels + y0 * level.width;
    const Rgba8* const bottom = level.texels + y1 * level.width;
    return mix(mix(decode_(top[x0]), decode_(top[x1]), fx),
               mix(decode_(bottom[x0]), decode_(bottom[x1]), fx), fy);
  }

 private:
  Decode decode_;
  bool wrap_u_, wrap_v_;
};

/// Calls out(k, value) for fragments k in [0, n).
template <class Decode, class Out>
HWY_INLINE void sample(const MipChain& chain, const Coordinates& at, int n, int padded, Out&& out) {
  alignas(64) float u[64], v[64], lod[64];
  fold_all(chain.wrap_u, at.u, padded, u);
  fold_all(chain.wrap_v, at.v, padded, v);
  levels_of_detail(chain, at, padded, lod);
  const Lookup<Decode> lookup(chain);
  const float last_level = static_cast<float>(chain.levels - 1);
  for (int k = 0; k < n; ++k) {
    if (!(lod[k] > 0)) {
      out(k, chain.mag == Filter::linear ? lookup.linear(chain.level[0], u[k], v[k])
                                         : lookup.nearest(chain.level[0], u[k], v[k]));
      continue;
    }
    const float level = lod[k] < last_level ? lod[k] : last_level;
    if (chain.min == Filter::nearest) {
      out(k, lookup.nearest(chain.level[static_cast<int>(level + 0.5F)], u[k], v[k]));
      continue;
    }
    const int finer = static_cast<int>(level);
    const float f = level - static_cast<float>(finer);
    auto texel = lookup.linear(chain.level[finer], u[k], v[k]);
    if (f > 0) texel = mix(texel, lookup.linear(chain.level[finer + 1], u[k], v[k]), f);
    out(k, texel);
  }
}

/// All channels; what follows the nth fragment in its group is set, to nothing in particular.
HWY_INLINE void sample(const MipChain& chain, const Coordinates& at, int n, int padded,
                       Texels& out) {
  for (int k = padded - kGroup; k < padded; ++k) out.r[k] = out.g[k] = out.b[k] = out.a[k] = 0;
  sample<AllChannels>(chain, at, n, padded, [&](int k, Texel t) HWY_ATTR {
    out.r[k] = t.r;
    out.g[k] = t.g;
    out.b[k] = t.b;
    out.a[k] = t.a;
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace rastrum::raster
HWY_AFTER_NAMESPACE();

#endif
