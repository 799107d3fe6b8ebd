// Texture look-ups of kLanes pixels, whatever their triangles, with the bits of Lookup
// (texture_lookup.hpp): levels, places and filter weights in lanes; then a pixel at a time, with
// the channels of a texel in the lanes, because its codes are decoded by loads (gathers and
// permutations of the sRGB table are slower: docs/log/shaders.md).
//
// Include it in the lanes' namespace, after lane_math-inl.hpp and texture_lanes-inl.hpp.

/// Codes 0 to 255 as code / 255, rounded as the division is (Material.CodesOfDataAreExact).
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

/// Where kLanes pixels read a level, and the weights of what is to the right and below.
struct Taps {
  HWY_ALIGN std::int32_t left_top[kLanes], right_top[kLanes], left_bottom[kLanes],
      right_bottom[kLanes];
  HWY_ALIGN float right[kLanes], below[kLanes];

  /// `u`, `v`: folded. Levels are halves of those before, rounded down, and at least 1.
  HWY_INLINE Taps(const MipChain& chain, I level, F u, F v) {
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
      hn::Store(at - hn::ConvertTo(d, begin), d, axis == 0 ? right : below);
      const I end = hn::Add(begin, one);
      first[axis] = hn::IfThenElse(hn::Lt(begin, zero), repeats ? last : zero, begin);
      second[axis] = hn::IfThenElse(hn::Gt(end, last), repeats ? zero : last, end);
      if (axis == 0) width = size;
    }
    const I top = hn::Mul(first[1], width), bottom = hn::Mul(second[1], width);
    hn::Store(hn::Add(top, first[0]), di, left_top);
    hn::Store(hn::Add(top, second[0]), di, right_top);
    hn::Store(hn::Add(bottom, first[0]), di, left_bottom);
    hn::Store(hn::Add(bottom, second[0]), di, right_bottom);
  }
};

using Texel128 = hn::Full128<float>;
using TexelLanes = hn::Vec<Texel128>;

/// Red, green and blue of a texel; the fourth is anything.
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

template <class Decode>
HWY_INLINE V3 sample_linear(const MipChain& chain, F u, F v, F level_of_detail,
                            std::uint64_t wanted) {
  const F32 d;
  const I32 di;
  const Texel128 d4;
  const F most = set(static_cast<float>(chain.levels - 1));
  const auto is_smaller = level_of_detail > set(0);
  const F level = choose_or_zero(is_smaller, choose(level_of_detail < most, level_of_detail, most));
  const I finer = hn::ConvertTo(di, level);
  const F share = level - hn::ConvertTo(d, finer);
  HWY_ALIGN std::int32_t number[kLanes];
  HWY_ALIGN float coarser_share[kLanes];
  hn::Store(finer, di, number);
  hn::Store(share, d, coarser_share);
  const Taps fine(chain, finer, u, v);
  const Taps coarse(chain, hn::Add(finer, hn::Set(di, 1)), u, v);  // where share > 0
  const Decode decode(chain);
  const auto mix = [](TexelLanes p, TexelLanes q, TexelLanes f)
                       HWY_ATTR { return p + (q - p) * f; };
  const auto linear = [&](const Rgba8* texels, const Taps& at, std::size_t i) HWY_ATTR {
    const TexelLanes right = hn::Set(d4, at.right[i]);
    return mix(mix(decode(texels[at.left_top[i]]), decode(texels[at.right_top[i]]), right),
               mix(decode(texels[at.left_bottom[i]]), decode(texels[at.right_bottom[i]]), right),
               hn::Set(d4, at.below[i]));
  };
  HWY_ALIGN float texel[kLanes][4] = {};
  for (; wanted != 0; wanted &= wanted - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(wanted));
    const MipLevel* const of = chain.level + number[i];
    TexelLanes t = linear(of[0].texels, fine, i);
    if (coarser_share[i] > 0)
      t = mix(t, linear(of[1].texels, coarse, i), hn::Set(d4, coarser_share[i]));
    hn::Store(t, d4, texel[i]);
  }
  V3 out;
  F fourth;
  hn::LoadInterleaved4(d, &texel[0][0], out.x, out.y, out.z, fourth);
  return out;
}

/// Red, green and blue of a texture at the pixels `wanted` of first to first + kLanes; at the
/// others they are 0.
HWY_INLINE V3 sample(const MipChain& chain, const Coordinates& at, std::size_t first,
                     std::uint64_t wanted) {
  const F32 d;
  const auto of = [&](const float* p) HWY_ATTR { return hn::Load(d, p + first); };
  const F u = folded(chain.wrap_u, of(at.u)), v = folded(chain.wrap_v, of(at.v));
  const F width = set(static_cast<float>(chain.level[0].width));
  const F height = set(static_cast<float>(chain.level[0].height));
  // level_of_detail.
  const F ux = of(at.u_dx) * width, vx = of(at.v_dx) * height;
  const F uy = of(at.u_dy) * width, vy = of(at.v_dy) * height;
  const F along_x = ux * ux + vx * vx, along_y = uy * uy + vy * vy;
  const F lod = set(0.5F) * log2_of(choose(along_x > along_y, along_x, along_y));
  if (chain.mag == TextureFilter::linear && chain.min == TextureFilter::linear) {
    if (chain.use == TexelUse::data) return sample_linear<DecodeData>(chain, u, v, lod, wanted);
    return sample_linear<DecodeColor>(chain, u, v, lod, wanted);
  }
  HWY_ALIGN float each[3][kLanes], texel[3][kLanes] = {};
  hn::Store(u, d, each[0]);
  hn::Store(v, d, each[1]);
  hn::Store(lod, d, each[2]);
  const Lookup<AllChannels> lookup(chain);
  for (; wanted != 0; wanted &= wanted - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(wanted));
    const Texel t = lookup(each[0][i], each[1][i], each[2][i]);
    texel[0][i] = t.r;
    texel[1][i] = t.g;
    texel[2][i] = t.b;
  }
  return {hn::Load(d, texel[0]), hn::Load(d, texel[1]), hn::Load(d, texel[2])};
}
