// The lit shaders a row of samples at a time, compiled once per instruction set.
//
// What a triangle brings to a row (its normal, its colour) is interpolated for the whole row and
// blended into the samples that see it; the lighting then runs once for the row. So a sample's bits
// do not depend on its neighbours. Setting up a triangle is scalar float32, kept for the block.
//
// float32 weights lose about |longest edge|² / |twice the area| ulps to cancellation, so thin and
// clipped triangles are interpolated in float64 (interpolate.hpp) instead. Square roots and
// divisions are the exact ones: approximate reciprocals differ between makers of the same
// instruction set.

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/shade/lit_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include <rastrum/raster/shade/interpolate.hpp>
#include <rastrum/raster/shade/lit_constants.hpp>
#include <rastrum/raster/shade/lit_triangle.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster {
namespace HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2
namespace hn = hwy::HWY_NAMESPACE;

using F32 = hn::CappedTag<float, 8>;
using F = hn::Vec<F32>;
constexpr std::size_t kLanes = hn::MaxLanes(F32{});

struct V3 {
  F x, y, z;
};

HWY_INLINE F set(float v) {
  return hn::Set(F32{}, v);
}
HWY_INLINE F dot(const V3& a, const V3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE V3 scale(const V3& a, F s) {
  return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}
HWY_INLINE V3 normalize(const V3& a) {
  const F32 d;
  const F square = dot(a, a);
  const F inverse = hn::Div(set(1.0F), hn::Sqrt(square));
  return scale(a, hn::IfThenElse(hn::Gt(square, hn::Zero(d)), inverse, set(1.0F)));
}
/// max(v, 0), and 0 for NaN.
HWY_INLINE F positive(F v) {
  return hn::IfThenElseZero(hn::Gt(v, hn::Zero(F32{})), v);
}

HWY_INLINE F corner_sum(float c0, float c1, float c2, F b0, F b1, F b2) {
  return hn::Add(hn::Add(hn::Mul(set(c0), b0), hn::Mul(set(c1), b1)), hn::Mul(set(c2), b2));
}
HWY_INLINE V3 corner_sum(const Vec3 (&v)[3], F b0, F b1, F b2) {
  return {corner_sum(v[0].x, v[1].x, v[2].x, b0, b1, b2),
          corner_sum(v[0].y, v[1].y, v[2].y, b0, b1, b2),
          corner_sum(v[0].z, v[1].z, v[2].z, b0, b1, b2)};
}
HWY_INLINE V3 blend(hn::Mask<F32> mask, const V3& yes, const V3& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}
HWY_INLINE hn::Mask<F32> lane_mask(std::uint32_t bits) {
  // LoadMaskBits reads whole bytes.
  const std::uint8_t memory[8] = {static_cast<std::uint8_t>(bits)};
  return hn::LoadMaskBits(F32{}, memory);
}

/// kLanes pixels of a row, and where in them is shaded.
struct Row {
  int x, y;
  const float *dx, *dy;  ///< null: at the centres

  Row(const VisibleBlock& block, std::size_t first)
      : x(block.x0 + static_cast<int>(first % 8)),
        y(block.y0 + static_cast<int>(first / 8)),
        dx(block.points == nullptr ? nullptr : block.points->dx + first),
        dy(block.points == nullptr ? nullptr : block.points->dy + first) {}

  [[nodiscard]] HWY_INLINE F px() const {
    const F32 d;
    const F centre = hn::Add(hn::Iota(d, static_cast<float>(x)), set(0.5F));
    return dx == nullptr ? centre : hn::Add(centre, hn::Load(d, dx));
  }
  [[nodiscard]] HWY_INLINE F py() const {
    const F centre = set(static_cast<float>(y) + 0.5F);
    return dy == nullptr ? centre : hn::Add(centre, hn::Load(F32{}, dy));
  }
};

/// Weights of triangle `t` at the pixels `wanted` of a row, up to a common positive factor; at the
/// others they may be anything.
HWY_INLINE void row_weights(const LitTriangle& t, const Row& row, std::uint32_t wanted, F& b0,
                            F& b1, F& b2) {
  const F32 d;
  if (t.exact) {
    // One by one, since most triangles that are so thin have few samples in a row.
    HWY_ALIGN float b[3][kLanes] = {};
    for (; wanted != 0; wanted &= wanted - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(wanted));
      const Vec2 from_centre = row.dx == nullptr ? Vec2{0, 0} : Vec2{row.dx[lane], row.dy[lane]};
      const Weights w = weights_at(t.planes, row.x + static_cast<int>(lane), row.y, from_centre);
      for (int c = 0; c < 3; ++c) b[c][lane] = static_cast<float>(w.b[c]);
    }
    b0 = hn::Load(d, b[0]);
    b1 = hn::Load(d, b[1]);
    b2 = hn::Load(d, b[2]);
    return;
  }
  const F dx = hn::Sub(row.px(), set(t.x0)), dy = hn::Sub(row.py(), set(t.y0));
  const F l1 = hn::Add(hn::Mul(set(t.p1), dx), hn::Mul(set(t.q1), dy));
  const F l2 = hn::Add(hn::Mul(set(t.p2), dx), hn::Mul(set(t.q2), dy));
  b0 = hn::Mul(hn::Sub(hn::Sub(set(1.0F), l1), l2), set(t.inv_w[0]));
  b1 = hn::Mul(l1, set(t.inv_w[1]));
  b2 = hn::Mul(l2, set(t.inv_w[2]));
}

/// The lighting of a row whose normals (not normalized) and base colours are known.
template <LitModel kModel>
HWY_INLINE V3 light_row(const ViewRays& rays, const Row& row, V3 n, const V3& base) {
  const F32 d;
  if (kModel == LitModel::flat) return base;
  n = normalize(n);
  const F half = set(0.5F);
  if (kModel == LitModel::normal)
    return {hn::Add(hn::Mul(n.x, half), half), hn::Add(hn::Mul(n.y, half), half),
            hn::Add(hn::Mul(n.z, half), half)};

  const F px = row.px(), py = row.py();
  const auto ray = [&](float origin, float dx, float dy) HWY_ATTR {
    return hn::Neg(hn::Add(hn::Add(set(origin), hn::Mul(set(dx), px)), hn::Mul(set(dy), py)));
  };
  const V3 v = normalize({ray(rays.d.x, rays.dx.x, rays.dy.x), ray(rays.d.y, rays.dx.y, rays.dy.y),
                          ray(rays.d.z, rays.dx.z, rays.dy.z)});
  n = scale(n, hn::IfThenElse(hn::Lt(dot(n, v), hn::Zero(d)), set(-1.0F), set(1.0F)));
  const V3 light{set(kLight.x), set(kLight.y), set(kLight.z)};
  const F diffuse = hn::Add(set(kAmbient), hn::Mul(set(kDiffuse), positive(dot(n, light))));
  const V3 lit = scale(base, diffuse);
  if (kModel == LitModel::lambert) return lit;
  // (n·h)³² = ((n·u)² / u·u)¹⁶ with u = v + l: the half vector needs no square root.
  const V3 u{hn::Add(v.x, light.x), hn::Add(v.y, light.y), hn::Add(v.z, light.z)};
  const F n_u = positive(dot(n, u));
  F s = hn::Div(hn::Mul(n_u, n_u), hn::Max(dot(u, u), set(1e-20F)));
  for (int i = 0; i < 4; ++i) s = hn::Mul(s, s);
  const F specular = hn::Mul(s, set(kSpecular));
  return {hn::Add(lit.x, specular), hn::Add(lit.y, specular), hn::Add(lit.z, specular)};
}

/// The lanes of `covered` whose keys hold the triangle `low`.
HWY_INLINE std::uint32_t same_triangle(const std::uint64_t* keys, std::uint64_t low) {
  constexpr std::size_t kLanes64 = hn::MaxLanes(hn::CappedTag<std::uint64_t, 4>{});
  const hn::CappedTag<std::uint64_t, 4> d;
  std::uint32_t same = 0;
  for (std::size_t i = 0; i < kLanes; i += kLanes64) {
    std::uint8_t bits = 0;
    const auto mine = hn::And(hn::Load(d, keys + i), hn::Set(d, kIdMask));
    hn::StoreMaskBits(d, hn::Eq(mine, hn::Set(d, low)), &bits);
    same |= (bits & ((1U << kLanes64) - 1)) << i;
  }
  return same;
}

/// What the lighting of a block needs, by sample.
struct BlockSurface {
  HWY_ALIGN float n[3][64];
  HWY_ALIGN float base[3][64];
};

HWY_INLINE void store(const V3& v, float (&to)[3][64], std::size_t at) {
  const F32 d;
  hn::Store(v.x, d, to[0] + at);
  hn::Store(v.y, d, to[1] + at);
  hn::Store(v.z, d, to[2] + at);
}
HWY_INLINE V3 load(const float (&from)[3][64], std::size_t at) {
  const F32 d;
  return {hn::Load(d, from[0] + at), hn::Load(d, from[1] + at), hn::Load(d, from[2] + at)};
}

/// Normals (not normalized) and colours of a row, each triangle's blended into its samples.
HWY_INLINE void interpolate_row(const LitScene& scene, const FrameGeometry& frame,
                                const VisibleBlock& block, std::size_t first, std::uint32_t rest,
                                bool wants_normals, bool wants_colors, BlockSurface& surface) {
  const F32 d;
  KeptTriangles& kept = *static_cast<KeptTriangles*>(block.scratch);
  const std::uint64_t* keys = block.keys + first;
  const Row row(block, first);
  V3 n{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  V3 base = n;
  while (rest != 0) {
    const std::uint64_t low = keys[std::countr_zero(rest)] & kIdMask;
    const LitTriangle& t = kept.find(scene, frame, low, wants_normals);
    const std::uint32_t same = same_triangle(keys, low) & rest;
    const auto mask = lane_mask(same);
    rest &= ~same;
    F b0, b1, b2;
    row_weights(t, row, same, b0, b1, b2);
    if (wants_normals) n = blend(mask, corner_sum(t.normal, b0, b1, b2), n);
    if (wants_colors) {
      const F inverse = hn::Div(set(1.0F), hn::Add(hn::Add(b0, b1), b2));
      base = blend(mask, scale(corner_sum(t.color, b0, b1, b2), inverse), base);
    }
  }
  if (wants_normals) store(n, surface.n, first);
  if (wants_colors) store(base, surface.base, first);
}

/// Two loops: a row's lighting is one long chain of square roots and divisions, and the processor
/// overlaps the chains of several rows only where little else stands between them.
template <LitModel kModel>
void shade_block(const LitScene& scene, const FrameGeometry& frame, const VisibleBlock& block,
                 BlockColors& colors) {
  const F32 d;
  constexpr bool kNormals = kModel != LitModel::flat;
  constexpr std::uint64_t kRow = (1U << kLanes) - 1;
  const bool colored = kModel != LitModel::normal && scene.colored;
  BlockSurface surface;
  if (kNormals || colored)
    for (std::size_t first = 0; first < 64; first += kLanes)
      if (const std::uint64_t row = block.covered >> first & kRow; row != 0)
        interpolate_row(scene, frame, block, first, static_cast<std::uint32_t>(row), kNormals,
                        colored, surface);

  V3 base{set(kDefaultBase.x), set(kDefaultBase.y), set(kDefaultBase.z)};
  for (std::size_t first = 0; first < 64; first += kLanes) {
    if ((block.covered >> first & kRow) == 0) continue;
    if (colored) base = load(surface.base, first);
    const V3 n = kNormals ? load(surface.n, first) : base;
    const V3 color = light_row<kModel>(scene.rays, Row(block, first), n, base);
    hn::Store(color.x, d, colors.r + first);
    hn::Store(color.y, d, colors.g + first);
    hn::Store(color.z, d, colors.b + first);
  }
}

bool shade(LitModel model, const LitScene& scene, const FrameGeometry& frame,
           const VisibleBlock& block, BlockColors& colors) noexcept {
  switch (model) {
    case LitModel::flat:
      shade_block<LitModel::flat>(scene, frame, block, colors);
      return true;
    case LitModel::normal:
      shade_block<LitModel::normal>(scene, frame, block, colors);
      return true;
    case LitModel::lambert:
      shade_block<LitModel::lambert>(scene, frame, block, colors);
      return true;
    case LitModel::phong:
      shade_block<LitModel::phong>(scene, frame, block, colors);
      return true;
    default:
      return false;
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace rastrum::raster
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
namespace rastrum::raster {

bool shade_lit_simd(Isa isa, LitModel model, const LitScene& scene, const FrameGeometry& frame,
                    const VisibleBlock& block, BlockColors& colors) noexcept {
  switch (isa) {
#if HWY_TARGETS & HWY_SSE4
    case Isa::sse4:
      return N_SSE4::shade(model, scene, frame, block, colors);
#endif
#if HWY_TARGETS & HWY_AVX2
    case Isa::avx2:
      return N_AVX2::shade(model, scene, frame, block, colors);
#endif
#if HWY_TARGETS & HWY_AVX3
    case Isa::avx512:
      return N_AVX3::shade(model, scene, frame, block, colors);
#endif
#if HWY_TARGETS & HWY_NEON
    case Isa::neon:
      return N_NEON::shade(model, scene, frame, block, colors);
#endif
    default:
      return false;
  }
}

}  // namespace rastrum::raster
#endif
