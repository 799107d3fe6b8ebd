// SPDX-License-Identifier: BSD-3-Clause
// A texture at one point, in one body for the host's lanes (texture_pixels-inl.hpp) and devices, so
// their pictures agree. Filters follow OpenGL 4.6, sections 8.14 and 8.15.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include <rastrum/config.hpp>
#include <rastrum/raster/shade/texture.hpp>

namespace rastrum::raster {

struct Texel {
  float r, g, b, a;
};

/// code / 255 is exactly code · kOf256 + code · kOf65280, without a division.
inline constexpr float kOf256 = 1.0F / 256, kOf65280 = 1.0F / 65280;

namespace texture_detail {

RASTRUM_HD_LEAF float mix(float p, float q, float f) {
  return p + (q - p) * f;
}
RASTRUM_HD_LEAF Texel mix(Texel p, Texel q, float f) {
  return {p.r + (q.r - p.r) * f, p.g + (q.g - p.g) * f, p.b + (q.b - p.b) * f,
          p.a + (q.a - p.a) * f};
}

/// log2 to 1.5e-5, minimax on the mantissa; below −60 at 0, 128 at infinity and NaN.
RASTRUM_HD_LEAF float log2_of(float x) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x);
  const float exponent = static_cast<float>(static_cast<std::int32_t>(bits >> 23 & 255U) - 127);
  const float m = std::bit_cast<float>((bits & 0x7fffffU) | 0x3f800000U) - 1;
  const float fraction =
      m *
      (1.4419655F + m * (-0.70966190F + m * (0.41759279F + m * (-0.19626580F + m * 0.046383667F))));
  return exponent + ((bits & 0x7fffffffU) > 0x7f800000U ? 0 : fraction);
}

}  // namespace texture_detail

/// The coordinate within one copy of the picture, in [0, 1]; NaN and infinity give 0.
template <Wrap kWrap>
RASTRUM_HD_LEAF float fold(float t) {
  float f = t;
  if constexpr (kWrap == Wrap::repeat) f = t - std::floor(t);
  if constexpr (kWrap == Wrap::mirrored_repeat) {
    const float period = t - 2 * std::floor(t * 0.5F);
    f = period > 1 ? 2 - period : period;
  }
  return f > 0 ? (f < 1 ? f : 1.0F) : 0.0F;
}
RASTRUM_HD inline float fold(Wrap wrap, float t) {
  return wrap == Wrap::repeat            ? fold<Wrap::repeat>(t)
         : wrap == Wrap::mirrored_repeat ? fold<Wrap::mirrored_repeat>(t)
                                         : fold<Wrap::clamp_to_edge>(t);
}

/// log2 of a pixel footprint's longer axis, in texels of a level 0 of `width` × `height`, from the
/// coordinates' change per px.
RASTRUM_HD_LEAF float level_of_detail(float width, float height, float u_dx, float v_dx, float u_dy,
                                      float v_dy) {
  const float ux = u_dx * width, vx = v_dx * height;
  const float uy = u_dy * width, vy = v_dy * height;
  const float along_x = ux * ux + vx * vx;
  const float along_y = uy * uy + vy * vy;
  return 0.5F * texture_detail::log2_of(along_x > along_y ? along_x : along_y);
}

/// Decode the wanted channels of a texel.
struct AllChannels {
  const float* decode;
  RASTRUM_HD_LEAF Texel operator()(Rgba8 t) const {
    return {decode[t.r], decode[t.g], decode[t.b], static_cast<float>(t.a) * (1.0F / 255.0F)};
  }
};
struct RedChannel {
  const float* decode;
  RASTRUM_HD_LEAF float operator()(Rgba8 t) const { return decode[t.r]; }
};
struct AlphaChannel {
  const float* decode;
  RASTRUM_HD_LEAF float operator()(Rgba8 t) const {
    return static_cast<float>(t.a) * (1.0F / 255.0F);
  }
};

/// Lookups at folded coordinates. The edge of a mirrored picture is its own neighbour, as when
/// clamped.
template <class Decode>
class Lookup {
 public:
  RASTRUM_HD_LEAF explicit Lookup(const MipChain& chain)
      : chain_(chain),
        decode_{chain.decode},
        wrap_u_(chain.wrap_u == Wrap::repeat),
        wrap_v_(chain.wrap_v == Wrap::repeat),
        last_level_(static_cast<float>(chain.levels - 1)) {}

  RASTRUM_HD_LEAF auto operator()(float u, float v, float level_of_detail) const {
    if (!(level_of_detail > 0))
      return chain_.mag == TextureFilter::linear ? linear(chain_.level[0], u, v)
                                                 : nearest(chain_.level[0], u, v);
    const float level = level_of_detail < last_level_ ? level_of_detail : last_level_;
    if (chain_.min == TextureFilter::nearest)
      return nearest(chain_.level[static_cast<int>(level + 0.5F)], u, v);
    const int finer = static_cast<int>(level);
    const float f = level - static_cast<float>(finer);
    auto texel = linear(chain_.level[finer], u, v);
    if (f > 0) texel = texture_detail::mix(texel, linear(chain_.level[finer + 1], u, v), f);
    return texel;
  }

 private:
  RASTRUM_HD_LEAF auto nearest(const MipLevel& level, float u, float v) const {
    std::int32_t x = static_cast<std::int32_t>(u * static_cast<float>(level.width));
    std::int32_t y = static_cast<std::int32_t>(v * static_cast<float>(level.height));
    if (x >= level.width) x = wrap_u_ ? 0 : level.width - 1;
    if (y >= level.height) y = wrap_v_ ? 0 : level.height - 1;
    return decode_(level.texels[y * level.width + x]);
  }

  RASTRUM_HD_LEAF auto linear(const MipLevel& level, float u, float v) const {
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
    using texture_detail::mix;
    return mix(mix(decode_(top[x0]), decode_(top[x1]), fx),
               mix(decode_(bottom[x0]), decode_(bottom[x1]), fx), fy);
  }

  const MipChain& chain_;
  Decode decode_;
  bool wrap_u_, wrap_v_;
  float last_level_;
};

}  // namespace rastrum::raster
