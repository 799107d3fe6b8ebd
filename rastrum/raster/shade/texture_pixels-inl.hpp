// SPDX-License-Identifier: BSD-3-Clause
// Texture look-ups of a block's pixels, whatever their triangles, with Lookup's bits
// (texture_lookup.hpp). Levels, places and filter weights are found in lanes. Then each pixel in
// turn has its texel's channels in lanes, because codes are decoded by loads (gathers and
// permutations of the sRGB table are slower: docs/log/shaders.md). All places of a block are found
// before its first texel is read: the chain to a place is longer than a processor looks ahead.
#if defined(RASTRUM_RASTER_SHADE_TEXTURE_PIXELS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_SHADE_TEXTURE_PIXELS_INL_HPP
#undef RASTRUM_RASTER_SHADE_TEXTURE_PIXELS_INL_HPP
#else
#define RASTRUM_RASTER_SHADE_TEXTURE_PIXELS_INL_HPP
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <rastrum/raster/shade/material_light-inl.hpp>
#include <rastrum/raster/shade/texture_lookup.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

/// For up to 64 pixels, with their change per px.
struct alignas(64) Coordinates {
  float u[64], v[64];
  float u_dx[64], u_dy[64], v_dx[64], v_dy[64];
};

/// code / 255, rounded as the division is (Material.CodesOfDataAreExact).
template <class V>
HWY_INLINE V of_255(V code) {
  const hn::DFromV<V> d;
  return code * hn::Set(d, kOf256) + code * hn::Set(d, kOf65280);
}

HWY_INLINE F folded(Wrap wrap, F t) {
  F f = t;
  if (wrap == Wrap::repeat) f = t - hn::Floor(t);
  if (wrap == Wrap::mirrored_repeat) {
    const F period = t - set(2) * hn::Floor(t * set(0.5F));
    f = choose(period > set(1), set(2) - period, period);
  }
  return choose_or_zero(f > set(0), choose(f < set(1), f, set(1)));
}

/// texture_detail::log2_of.
HWY_INLINE F log2_of(F x) {
  const F32 d;
  const I32 di;
  const I bits = hn::BitCast(di, x);
  const auto constant = [&](std::int32_t v) HWY_ATTR { return hn::Set(di, v); };
  const F exponent =
      hn::ConvertTo(d, hn::Sub(hn::And(hn::ShiftRight<23>(bits), constant(255)), constant(127)));
  const F m =
      hn::BitCast(d, hn::Or(hn::And(bits, constant(0x7fffff)), constant(0x3f800000))) - set(1);
  const F fraction =
      m * (set(1.4419655F) +
           m * (set(-0.70966190F) +
                m * (set(0.41759279F) + m * (set(-0.19626580F) + m * set(0.046383667F)))));
  const auto is_nan =
      hn::RebindMask(d, hn::Gt(hn::And(bits, constant(0x7fffffff)), constant(0x7f800000)));
  return exponent + choose(is_nan, set(0), fraction);
}

/// Where a block's pixels read a level, and the weights of the texels to the right and below.
struct Taps {
  HWY_ALIGN std::int32_t left_top[64], right_top[64], left_bottom[64], right_bottom[64];
  HWY_ALIGN float right[64], below[64];

  /// Sets the taps of kLanes pixels. `u`, `v`: folded. A level is half of the one before, rounded
  /// down, at least 1.
  HWY_INLINE void find(const MipChain& chain, std::size_t pixel, I level, F u, F v) {
    const I32 di;
    const F32 d;
    I first[2], second[2];
    I width = hn::Zero(di);
    for (int axis = 0; axis < 2; ++axis) {
      const bool repeats = (axis == 0 ? chain.wrap_u : chain.wrap_v) == Wrap::repeat;
      const std::int32_t of_0 = axis == 0 ? chain.level[0].width : chain.level[0].height;
      const I one = hn::Set(di, 1), zero = hn::Zero(di);
      const I size = hn::Max(hn::Shr(hn::Set(di, of_0), level), one);
      const I last = hn::Sub(size, one);
      const F at = (axis == 0 ? u : v) * hn::ConvertTo(d, size) - set(0.5F);
      const I begin = hn::Sub(hn::ConvertTo(di, at + set(1)), one);  // floor, at ≥ −0.5
      hn::Store(at - hn::ConvertTo(d, begin), d, (axis == 0 ? right : below) + pixel);
      const I end = hn::Add(begin, one);
      first[axis] = hn::IfThenElse(hn::Lt(begin, zero), repeats ? last : zero, begin);
      second[axis] = hn::IfThenElse(hn::Gt(end, last), repeats ? zero : last, end);
      if (axis == 0) width = size;
    }
    const I top = hn::Mul(first[1], width), bottom = hn::Mul(second[1], width);
    hn::Store(hn::Add(top, first[0]), di, left_top + pixel);
    hn::Store(hn::Add(top, second[0]), di, right_top + pixel);
    hn::Store(hn::Add(bottom, first[0]), di, left_bottom + pixel);
    hn::Store(hn::Add(bottom, second[0]), di, right_bottom + pixel);
  }
};

using Texel128 = hn::Full128<float>;
using TexelLanes = hn::Vec<Texel128>;

/// Red, green and blue of a texel; the fourth lane is undefined.
struct DecodeData {
  HWY_INLINE explicit DecodeData(const MipChain& /*chain*/) {}
  HWY_INLINE TexelLanes operator()(const Rgba8& t) const {
    const Texel128 d;
    const hn::RebindToSigned<Texel128> di;
    const hn::Rebind<std::uint8_t, Texel128> d8;
    return of_255(hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(d8, &t.r))));
  }
};
struct DecodeColor {
  const float* table;
  HWY_INLINE explicit DecodeColor(const MipChain& chain) : table(chain.decode) {}
  HWY_INLINE TexelLanes operator()(const Rgba8& t) const {
    const Texel128 d;
    const TexelLanes rg = hn::InterleaveLower(d, hn::Set(d, table[t.r]), hn::Set(d, table[t.g]));
    return hn::ConcatLowerLower(d, hn::Set(d, table[t.b]), rg);
  }
};

struct BlockTexels {
  HWY_ALIGN float texel[64][4];

  [[nodiscard]] HWY_INLINE V3 at(std::size_t first) const {
    V3 out;
    F fourth;
    hn::LoadInterleaved4(F32{}, &texel[first][0], out.x, out.y, out.z, fourth);
    return out;
  }
};

/// Folded coordinates and levels of detail of kLanes pixels.
struct Looks {
  F u, v, level_of_detail;

  HWY_INLINE Looks(const MipChain& chain, const Coordinates& at, std::size_t first) {
    const auto of = [&](const float* p) HWY_ATTR { return hn::Load(F32{}, p + first); };
    u = folded(chain.wrap_u, of(at.u));
    v = folded(chain.wrap_v, of(at.v));
    const F width = set(static_cast<float>(chain.level[0].width));
    const F height = set(static_cast<float>(chain.level[0].height));
    // level_of_detail.
    const F ux = of(at.u_dx) * width, vx = of(at.v_dx) * height;
    const F uy = of(at.u_dy) * width, vy = of(at.v_dy) * height;
    const F along_x = ux * ux + vx * vx, along_y = uy * uy + vy * vy;
    level_of_detail = set(0.5F) * log2_of(choose(along_x > along_y, along_x, along_y));
  }
};

/// The same for a block, for code that looks up pixel by pixel.
struct EachLook {
  HWY_ALIGN float u[64], v[64], level_of_detail[64];

  HWY_INLINE void find(const MipChain& chain, const Coordinates& at, std::size_t first) {
    const F32 d;
    const Looks look(chain, at, first);
    hn::Store(look.u, d, u + first);
    hn::Store(look.v, d, v + first);
    hn::Store(look.level_of_detail, d, level_of_detail + first);
  }
  template <class Channel>
  [[nodiscard]] HWY_INLINE auto texel(const Lookup<Channel>& lookup, std::size_t i) const {
    return lookup(u[i], v[i], level_of_detail[i]);
  }
};

/// Calls use(first) for each kLanes pixels with some `wanted`.
template <class Use>
HWY_INLINE void for_wanted(std::uint64_t wanted, const Use& use) {
  constexpr std::uint64_t kAll = (std::uint64_t{1} << kLanes) - 1;
  for (std::size_t first = 0; first < 64; first += kLanes)
    if ((wanted >> first & kAll) != 0) use(first);
}

/// Where pixels read between texels, in two levels.
struct Places {
  HWY_ALIGN std::int32_t finer[64];  ///< the level of `fine`
  HWY_ALIGN float coarser_share[64];
  Taps fine, coarse;  ///< of the next level, if its share is above 0

  HWY_INLINE void find(const MipChain& chain, const Coordinates& at, std::size_t first) {
    const F32 d;
    const I32 di;
    const F most = set(static_cast<float>(chain.levels - 1));
    const Looks look(chain, at, first);
    const F lod = look.level_of_detail;
    const F level = choose_or_zero(lod > set(0), choose(lod < most, lod, most));
    const I number = hn::ConvertTo(di, level);
    hn::Store(number, di, finer + first);
    hn::Store(level - hn::ConvertTo(d, number), d, coarser_share + first);
    fine.find(chain, first, number, look.u, look.v);
    coarse.find(chain, first, hn::Add(number, hn::Set(di, 1)), look.u, look.v);
  }
};

template <class Decode>
HWY_INLINE void sample_linear(const MipChain& chain, const Coordinates& at, std::uint64_t wanted,
                              BlockTexels& out) {
  const I32 di;
  const Texel128 d4;
  Places places;
  auto& [finer, coarser_share, fine, coarse] = places;
  if (wanted != ~std::uint64_t{0})  // others are prefetched, too
    for (std::int32_t* const place : {finer, fine.left_top, fine.left_bottom})
      for (std::size_t i = 0; i < 64; i += kLanes) hn::Store(hn::Zero(di), di, place + i);
  for_wanted(wanted, [&](std::size_t first) HWY_ATTR { places.find(chain, at, first); });
  const Decode decode(chain);
  const auto mix = [](TexelLanes p, TexelLanes q, TexelLanes f)
                       HWY_ATTR { return p + (q - p) * f; };
  const auto linear = [&](const Rgba8* texels, const Taps& taps, std::size_t i) HWY_ATTR {
    const TexelLanes right = hn::Set(d4, taps.right[i]);
    return mix(
        mix(decode(texels[taps.left_top[i]]), decode(texels[taps.right_top[i]]), right),
        mix(decode(texels[taps.left_bottom[i]]), decode(texels[taps.right_bottom[i]]), right),
        hn::Set(d4, taps.below[i]));
  };
  for (; wanted != 0; wanted &= wanted - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(wanted));
    // A row of texels may begin another page, so some pixels of a block have to wait for one.
    const std::size_t ahead = std::min<std::size_t>(i + 8, 63);
    const Rgba8* const next = chain.level[finer[ahead]].texels;
    __builtin_prefetch(next + fine.left_top[ahead]);
    __builtin_prefetch(next + fine.left_bottom[ahead]);
    const MipLevel* const of = chain.level + finer[i];
    TexelLanes t = linear(of[0].texels, fine, i);
    if (coarser_share[i] > 0)
      t = mix(t, linear(of[1].texels, coarse, i), hn::Set(d4, coarser_share[i]));
    hn::Store(t, d4, out.texel[i]);
  }
}

/// A texture at the `wanted` pixels of a block; of the others it is 0.
HWY_NOINLINE void sample(const MipChain& chain, const Coordinates& at, std::uint64_t wanted,
                         BlockTexels& out) {
  if (wanted != ~std::uint64_t{0}) out = {};
  if (chain.mag == TextureFilter::linear && chain.min == TextureFilter::linear) {
    if (chain.use == TexelUse::data) return sample_linear<DecodeData>(chain, at, wanted, out);
    return sample_linear<DecodeColor>(chain, at, wanted, out);
  }
  EachLook each;
  for_wanted(wanted, [&](std::size_t first) HWY_ATTR { each.find(chain, at, first); });
  const Lookup<AllChannels> lookup(chain);
  for (; wanted != 0; wanted &= wanted - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(wanted));
    const Texel t = each.texel(lookup, i);
    out.texel[i][0] = t.r;
    out.texel[i][1] = t.g;
    out.texel[i][2] = t.b;
  }
}

/// One channel of texels as it is loaded, and as a number.
struct AlphaCodes {
  HWY_INLINE explicit AlphaCodes(const MipChain& /*chain*/) {}
  HWY_INLINE std::int32_t load(const Rgba8& t) const { return t.a; }
  static HWY_INLINE F number(I codes) { return hn::ConvertTo(F32{}, codes) * set(1.0F / 255.0F); }
};
struct RedCodes {
  const float* table;
  HWY_INLINE explicit RedCodes(const MipChain& chain) : table(chain.decode) {}
  HWY_INLINE std::int32_t load(const Rgba8& t) const {
    return std::bit_cast<std::int32_t>(table[t.r]);
  }
  static HWY_INLINE F number(I codes) { return hn::BitCast(F32{}, codes); }
};

/// Multiplies the first n values by one channel of a texture. Reads and writes whole vectors.
template <class Codes, class Channel>
HWY_NOINLINE void multiply_by(const MipChain& chain, const Coordinates& at, int n, float* values) {
  const I32 di;
  const F32 d;
  const auto count = static_cast<std::size_t>(n);
  if (chain.mag != TextureFilter::linear || chain.min != TextureFilter::linear) {
    EachLook each;
    for (std::size_t first = 0; first < count; first += kLanes) each.find(chain, at, first);
    const Lookup<Channel> lookup(chain);
    for (std::size_t i = 0; i < count; ++i) values[i] *= each.texel(lookup, i);
    return;
  }
  Places places;
  for (std::size_t first = 0; first < count; first += kLanes) places.find(chain, at, first);
  const Codes codes(chain);
  HWY_ALIGN std::int32_t loaded[2][4][kLanes] = {};
  for (std::size_t first = 0; first < count; first += kLanes) {
    bool any_coarser = false;
    for (std::size_t k = 0; k < std::min(kLanes, count - first); ++k) {
      const std::size_t i = first + k;
      const auto load = [&](const Rgba8* texels, const Taps& taps, std::int32_t(&to)[4][kLanes]) {
        to[0][k] = codes.load(texels[taps.left_top[i]]);
        to[1][k] = codes.load(texels[taps.right_top[i]]);
        to[2][k] = codes.load(texels[taps.left_bottom[i]]);
        to[3][k] = codes.load(texels[taps.right_bottom[i]]);
      };
      const MipLevel* const of = chain.level + places.finer[i];
      load(of[0].texels, places.fine, loaded[0]);
      if (!(places.coarser_share[i] > 0)) continue;
      load(of[1].texels, places.coarse, loaded[1]);
      any_coarser = true;
    }
    const auto linear = [&](const Taps& taps, const std::int32_t(&from)[4][kLanes]) HWY_ATTR {
      const auto number = [&](int corner)
                              HWY_ATTR { return Codes::number(hn::Load(di, from[corner])); };
      const F right = hn::Load(d, taps.right + first), below = hn::Load(d, taps.below + first);
      return mix(mix(number(0), number(1), right), mix(number(2), number(3), right), below);
    };
    F value = linear(places.fine, loaded[0]);
    if (any_coarser) {
      const F share = hn::Load(d, places.coarser_share + first);
      value = choose(share > set(0), mix(value, linear(places.coarse, loaded[1]), share), value);
    }
    hn::Store(hn::Load(d, values + first) * value, d, values + first);
  }
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_SHADE_TEXTURE_PIXELS_INL_HPP
