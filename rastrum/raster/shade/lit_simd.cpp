// The lit shaders a row of samples at a time, compiled once per instruction set.
//
// What a triangle brings to a row (its normal, its colour) is interpolated for the whole row and
// blended into the samples that see it; the lighting then runs once for the row. So a sample's bits
// do not depend on its neighbours. Setting up a triangle is scalar float32, kept for the block.
//
// The arithmetic is lit_light-inl.hpp's, which the scalar form shares.

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/shade/lit_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <bit>
#include <type_traits>

#include <rastrum/raster/kernels/lanes-inl.hpp>
#include <rastrum/raster/shade/interpolate.hpp>
#include <rastrum/raster/shade/light_set.hpp>
#include <rastrum/raster/shade/lit_constants.hpp>
#include <rastrum/raster/shade/lit_triangle.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster {
namespace HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2
namespace hn = hwy::HWY_NAMESPACE;

#include <rastrum/raster/kernels/lane_math-inl.hpp>

#include <rastrum/raster/kernels/lookups-inl.hpp>
#include <rastrum/raster/shade/lights-inl.hpp>

#include <rastrum/raster/shade/lit_light-inl.hpp>  // after the lights
#undef RASTRUM_LANES

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
    const F centre = hn::Iota(d, static_cast<float>(x)) + set(0.5F);
    return dx == nullptr ? centre : centre + hn::Load(d, dx);
  }
  [[nodiscard]] HWY_INLINE F py() const {
    const F centre = set(static_cast<float>(y) + 0.5F);
    return dy == nullptr ? centre : centre + hn::Load(F32{}, dy);
  }
};

/// Weights of triangle `t` at the pixels `wanted` of a row; at the others they may be anything.
HWY_INLINE CornerWeights row_weights(const LitTriangle& t, const Row& row, std::uint32_t wanted) {
  if (!t.exact) return weights_of(t, row.px(), row.py());
  // One by one, since most triangles that are so thin have few samples in a row.
  const F32 d;
  HWY_ALIGN float b[3][kLanes] = {};
  for (; wanted != 0; wanted &= wanted - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(wanted));
    const Vec2 from_centre = row.dx == nullptr ? Vec2{0, 0} : Vec2{row.dx[lane], row.dy[lane]};
    const Weights w = weights_at(t.planes, row.x + static_cast<int>(lane), row.y, from_centre);
    for (int c = 0; c < 3; ++c) b[c][lane] = static_cast<float>(w.b[c]);
  }
  return {hn::Load(d, b[0]), hn::Load(d, b[1]), hn::Load(d, b[2])};
}

/// The lanes of `covered` whose keys hold the triangle `low`.
HWY_INLINE std::uint32_t same_triangle(const std::uint64_t* keys, std::uint64_t low) {
  const hn::RebindToUnsigned<I64> d;
  std::uint32_t same = 0;
  for (std::size_t i = 0; i < kLanes; i += kLanes64) {
    std::uint8_t bits = 0;
    const auto mine = hn::And(hn::Load(d, keys + i), hn::Set(d, kIdMask));
    hn::StoreMaskBits(d, hn::Eq(mine, hn::Set(d, low)), &bits);
    same |= (bits & ((1U << kLanes64) - 1)) << i;
  }
  return same;
}

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

/// Normals (not normalized) and colours of a row, each triangle's blended into its samples. `cut`:
/// triangles may not cover them.
HWY_INLINE void interpolate_row(const LitScene& scene, const FrameGeometry& frame,
                                const VisibleBlock& block, std::size_t first, std::uint32_t rest,
                                bool wants_normals, bool wants_colors, bool cut,
                                LitBlock& surface) {
  const F32 d;
  KeptTriangles& kept = *static_cast<KeptTriangles*>(block.scratch);
  const std::uint64_t* keys = block.keys + first;
  const Row row(block, first);
  V3 n = set(Vec3{}), base = n;
  while (rest != 0) {
    const std::uint64_t low = keys[std::countr_zero(rest)] & kIdMask;
    const LitTriangle& t = kept.find(scene, frame, low, wants_normals);
    const std::uint32_t same = same_triangle(keys, low) & rest;
    const auto mask = hn::RebindMask(d, lane_mask(same));
    rest &= ~same;
    CornerWeights w = row_weights(t, row, same);
    if (cut) w = inside(w);
    if (wants_normals) n = choose(mask, w.sum(t.normal), n);
    if (wants_colors) base = choose(mask, interpolated_color(t, w), base);
  }
  if (wants_normals) store(n, surface.n, first);
  if (wants_colors) store(base, surface.base, first);
}

/// Depths of a row; of samples that hold nothing they may be anything.
HWY_INLINE F row_depth(const std::uint64_t* keys) {
  HWY_ALIGN float depth[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) depth[i] = depth_of_key(keys[i]);
  return hn::Load(F32{}, depth);
}

/// Lights what `surface` holds, by the fixed light or those of `lights`; without `colored` it has
/// the default base colour.
template <LitModel kModel, bool kFixed>
HWY_NOINLINE void light_rows(const ViewRays& rays, const LightSet* lights,
                             const VisibleBlock& block, const LitBlock& surface, bool colored,
                             BlockColors& colors) {
  const F32 d;
  constexpr std::uint64_t kRow = (1U << kLanes) - 1;
  V3 base = set(kDefaultBase);
  for (std::size_t first = 0; first < 64; first += kLanes) {
    if ((block.covered >> first & kRow) == 0) continue;
    if (colored) base = load(surface.base, first);
    const V3 n = kModel != LitModel::flat ? load(surface.n, first) : base;
    const Row row(block, first);
    V3 color;
    if constexpr (kFixed)
      color = light(kModel, rays, row.px(), row.py(), n, base);
    else
      color = light_by(*lights, kModel, rays, row.px(), row.py(), row_depth(block.keys + first), n,
                       base);
    hn::Store(color.x, d, colors.r + first);
    hn::Store(color.y, d, colors.g + first);
    hn::Store(color.z, d, colors.b + first);
  }
}

template <LitModel kModel>
HWY_INLINE void light_block(const ViewRays& rays, const LightSet* lights, const VisibleBlock& block,
                            const LitBlock& surface, bool colored, BlockColors& colors) {
  constexpr bool kLit = kModel == LitModel::lambert || kModel == LitModel::phong;
  if (kLit && lights != nullptr)
    light_rows<kModel, !kLit>(rays, lights, block, surface, colored, colors);
  else
    light_rows<kModel, true>(rays, nullptr, block, surface, colored, colors);
}

/// Two loops: a row's lighting is one long chain of square roots and divisions, and the processor
/// overlaps the chains of several rows only where little else stands between them. `own_base`:
/// `surface` holds the base colours.
template <LitModel kModel>
void shade_block(const LitScene& scene, const FrameGeometry& frame, const VisibleBlock& block,
                 LitBlock& surface, bool own_base, BlockColors& colors) {
  constexpr bool kNormals = kModel != LitModel::flat;
  constexpr std::uint64_t kRow = (1U << kLanes) - 1;
  const bool colored = !own_base && kModel != LitModel::normal && scene.colored;
  if (kNormals || colored)
    for (std::size_t first = 0; first < 64; first += kLanes)
      if (const std::uint64_t row = block.covered >> first & kRow; row != 0)
        interpolate_row(scene, frame, block, first, static_cast<std::uint32_t>(row), kNormals,
                        colored, false, surface);
  light_block<kModel>(scene.rays, scene.lights, block, surface, own_base || colored, colors);
}

/// Calls use(constant of the model); returns whether it is one that lanes have.
template <class Use>
HWY_INLINE bool with_model(LitModel model, const Use& use) {
  switch (model) {
    case LitModel::flat:
      use(std::integral_constant<LitModel, LitModel::flat>{});
      return true;
    case LitModel::normal:
      use(std::integral_constant<LitModel, LitModel::normal>{});
      return true;
    case LitModel::lambert:
      use(std::integral_constant<LitModel, LitModel::lambert>{});
      return true;
    case LitModel::phong:
      use(std::integral_constant<LitModel, LitModel::phong>{});
      return true;
    default:
      return false;
  }
}

bool shade(LitModel model, const LitScene& scene, const FrameGeometry& frame,
           const VisibleBlock& block, BlockColors& colors) noexcept {
  return with_model(model, [&](auto m) HWY_ATTR {
    LitBlock own;
    LitBlock& surface = block.lit != nullptr ? *block.lit : own;
    shade_block<decltype(m)::value>(scene, frame, block, surface, false, colors);
    if (model != LitModel::flat) surface.normals = block.covered;
  });
}

bool seen_normals(const LitScene& scene, const FrameGeometry& frame, const VisibleBlock& block,
                  LitBlock& surface, bool cut, const float (*to_camera)[3],
                  SeenNormals& out) noexcept {
  const F32 d;
  constexpr std::uint64_t kRow = (1U << kLanes) - 1;
  for (std::size_t first = 0; first < 64; first += kLanes) {
    const std::uint64_t row = block.covered >> first & kRow;
    if (row == 0) continue;
    if (surface.normals != block.covered)
      interpolate_row(scene, frame, block, first, static_cast<std::uint32_t>(row), true, false, cut,
                      surface);
    const Row at(block, first);
    const V3 n = seen_normal(scene.rays, at.px(), at.py(), load(surface.n, first));
    hn::StoreInterleaved3(n.x, n.y, n.z, d, &out.world[first].x);
    if (to_camera == nullptr) continue;
    const V3 c = turned(to_camera, n);
    hn::StoreInterleaved3(c.x, c.y, c.z, d, &out.camera[first].x);
  }
  return true;
}

bool shade_own_base(LitModel model, const LitScene& scene, const FrameGeometry& frame,
                    const VisibleBlock& block, LitBlock& surface, BlockColors& colors) noexcept {
  return with_model(model, [&](auto m) HWY_ATTR {
    shade_block<decltype(m)::value>(scene, frame, block, surface, true, colors);
  });
}

bool light_all(LitModel model, const ViewRays& rays, const LightSet* lights,
               const VisibleBlock& block, const LitBlock& surface, BlockColors& colors) noexcept {
  return with_model(model, [&](auto m) HWY_ATTR {
    light_block<decltype(m)::value>(rays, lights, block, surface, true, colors);
  });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace rastrum::raster
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::raster {

bool shade_lit_simd(Isa isa, LitModel model, const LitScene& scene, const FrameGeometry& frame,
                    const VisibleBlock& block, BlockColors& colors) noexcept {
  using Shade =
      bool (*)(LitModel, const LitScene&, const FrameGeometry&, const VisibleBlock&, BlockColors&);
  static constexpr Shade kShade[] = RASTRUM_BY_ISA(shade, nullptr);
  const Shade shade = kShade[static_cast<std::size_t>(isa)];
  return shade != nullptr && shade(model, scene, frame, block, colors);
}

bool shade_own_base_simd(Isa isa, LitModel model, const LitScene& scene, const FrameGeometry& frame,
                         const VisibleBlock& block, LitBlock& surface,
                         BlockColors& colors) noexcept {
  using Shade = bool (*)(LitModel, const LitScene&, const FrameGeometry&, const VisibleBlock&,
                         LitBlock&, BlockColors&);
  static constexpr Shade kShade[] = RASTRUM_BY_ISA(shade_own_base, nullptr);
  const Shade shade = kShade[static_cast<std::size_t>(isa)];
  return shade != nullptr && shade(model, scene, frame, block, surface, colors);
}

bool seen_normals_simd(Isa isa, const LitScene& scene, const FrameGeometry& frame,
                       const VisibleBlock& block, LitBlock& surface, bool cut,
                       const float (*to_camera)[3], SeenNormals& out) noexcept {
  using Seen = bool (*)(const LitScene&, const FrameGeometry&, const VisibleBlock&, LitBlock&, bool,
                        const float(*)[3], SeenNormals&);
  static constexpr Seen kSeen[] = RASTRUM_BY_ISA(seen_normals, nullptr);
  const Seen seen = kSeen[static_cast<std::size_t>(isa)];
  return seen != nullptr && seen(scene, frame, block, surface, cut, to_camera, out);
}

bool light_lit_simd(Isa isa, LitModel model, const ViewRays& rays, const LightSet* lights,
                    const VisibleBlock& block, const LitBlock& surface,
                    BlockColors& colors) noexcept {
  using Light = bool (*)(LitModel, const ViewRays&, const LightSet*, const VisibleBlock&,
                         const LitBlock&, BlockColors&);
  static constexpr Light kLights[] = RASTRUM_BY_ISA(light_all, nullptr);
  const Light light = kLights[static_cast<std::size_t>(isa)];
  return light != nullptr && light(model, rays, lights, block, surface, colors);
}

}  // namespace rastrum::raster
#endif
