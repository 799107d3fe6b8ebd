// The lit shaders a block at a time, compiled once per instruction set.
//
// Where a block sees a few triangles, each is interpolated at once for all of its pixels. Else the
// triangles that it sees are set up a lane each (lit_seen-inl.hpp); kLanes pixels at a
// time look up what their triangles bring (normals, colours), interpolate it, and are lit. So a
// pixel's bits do not depend on its neighbours.
//
// The arithmetic is lit_light-inl.hpp's, which the scalar form shares.

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/shade/lit_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>

#include <rastrum/raster/shade/interpolate.hpp>
#include <rastrum/raster/shade/light_set.hpp>
#include <rastrum/raster/shade/lit_constants.hpp>
#include <rastrum/raster/shade/lit_lanes-inl.hpp>
#include <rastrum/raster/shade/lit_triangle.hpp>
#include <rastrum/raster/shade/material_constants.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster {
namespace HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2
namespace hn = hwy::HWY_NAMESPACE;

using F32 = hn::CappedTag<float, RASTRUM_LIT_LANES>;
using I32 = hn::RebindToSigned<F32>;
using F = hn::Vec<F32>;
constexpr std::size_t kLanes = RASTRUM_LIT_LANES;
static_assert(hn::MaxLanes(F32{}) == kLanes);

#include <rastrum/raster/kernels/lane_math-inl.hpp>

#include <rastrum/raster/kernels/lookups-inl.hpp>
#include <rastrum/raster/shade/lights-inl.hpp>

#include <rastrum/raster/shade/lit_light-inl.hpp>  // after the lights

namespace pairs {
#include <rastrum/raster/kernels/pair_math-inl.hpp>

#include <rastrum/raster/shade/lit_fixed-inl.hpp>  // after pairs
}  // namespace pairs

#include <rastrum/raster/shade/pack-inl.hpp>
#include <rastrum/raster/shade/seen_triangles-inl.hpp>

#include <rastrum/raster/shade/lit_seen-inl.hpp>  // after the triangles
#undef RASTRUM_LANES

/// Where in pixels first to first + kLanes of a block is shaded.
struct Points {
  F px, py;

  HWY_INLINE Points(const VisibleBlock& block, std::size_t first)
      : px(set(static_cast<float>(block.x0)) + hn::Load(F32{}, kSample.x + first)),
        py(set(static_cast<float>(block.y0)) + hn::Load(F32{}, kSample.y + first)) {
    if (block.points == nullptr) return;
    px = px + hn::Load(F32{}, block.points->dx + first);
    py = py + hn::Load(F32{}, block.points->dy + first);
  }
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

/// Weights at the pixels `wanted` of a triangle that is `exact`; at the others they are 0. One by
/// one, since most triangles that are so thin have few samples.
HWY_INLINE CornerWeights exact_weights(const WeightPlanes& planes, const VisibleBlock& block,
                                       std::size_t first, std::uint64_t wanted) {
  const F32 d;
  HWY_ALIGN float b[3][kLanes] = {};
  for (; wanted != 0; wanted &= wanted - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(wanted));
    const std::size_t i = first + lane;
    const Vec2 from_centre =
        block.points == nullptr ? Vec2{0, 0} : Vec2{block.points->dx[i], block.points->dy[i]};
    const Weights w = weights_at(planes, block.x0 + static_cast<int>(i % kBlockSize),
                                 block.y0 + static_cast<int>(i / kBlockSize), from_centre);
    for (int c = 0; c < 3; ++c) b[c][lane] = static_cast<float>(w.b[c]);
  }
  return {hn::Load(d, b[0]), hn::Load(d, b[1]), hn::Load(d, b[2])};
}

/// The triangles of the block, set up; `starts`: where its runs begin.
HWY_INLINE SeenLanes& seen_lanes(const LitScene& scene, const FrameGeometry& frame,
                                 const VisibleBlock& block, std::uint64_t starts,
                                 bool wants_normals, KeptTriangles& kept) {
  auto& own = *reinterpret_cast<SeenLanes*>(kept.lanes);
  SeenTriangles& seen = own.seen;
  if (seen.find_runs(block.keys, starts)) return own;
  DrawOfTriangle of(scene, frame);
  for (std::size_t i = 0; i < seen.count; ++i) of.prefetch(seen.low[i]);
  own.exact = 0;
  for (std::size_t g = 0; g < own.groups(); ++g) {
    const std::size_t first = g * kLanes;
    fetch_triangles(of, seen.low + first, std::min(kLanes, seen.count - first), wants_normals,
                    own.lanes[g]);
    own.exact |= own.lanes[g].exact << first;
  }
  return own;
}

/// The pixels of `among` whose key has the low part `low`, which is not 0.
HWY_INLINE std::uint64_t pixels_of(const std::uint64_t* keys, std::uint64_t low,
                                   std::uint64_t among) {
  const hn::CappedTag<std::uint64_t, 8> d;
  constexpr std::size_t kStep = hn::MaxLanes(hn::CappedTag<std::uint64_t, 8>());
  const auto own = hn::Set(d, low), mask = hn::Set(d, kIdMask);
  std::uint64_t pixels = 0;
  for (std::size_t i = 0; i < 64; i += kStep) {
    std::uint8_t bits = 0;
    hn::StoreMaskBits(d, hn::Eq(hn::And(hn::Load(d, keys + i), mask), own), &bits);
    pixels |= (std::uint64_t{bits} & ((1U << kStep) - 1)) << i;
  }
  return pixels & among;
}

/// Interpolates what triangle `t` brings to the pixels `own`. Of `before` others have been set;
/// whose vector has none of these may be set, too.
HWY_INLINE void interpolate_one(const LitTriangle& t, const VisibleBlock& block, std::uint64_t own,
                                std::uint64_t before, bool wants_normals, bool wants_colors,
                                bool cut, LitBlock& surface) {
  constexpr std::uint64_t kAll = (std::uint64_t{1} << kLanes) - 1;
  for (std::size_t i = 0; i < 64; i += kLanes) {
    const std::uint64_t mine = own >> i & kAll;
    if (mine == 0) continue;
    const Points at(block, i);
    CornerWeights w =
        t.exact ? exact_weights(t.planes, block, i, mine) : weights_of(t, at.px, at.py);
    if (cut) w = inside(w);
    const auto lanes = mask_of(mine);
    const bool first = (before >> i & kAll) == 0;
    if (wants_normals) {
      const V3 n = w.sum(t.normal);
      store(first ? n : choose(lanes, n, load(surface.n, i)), surface.n, i);
    }
    if (wants_colors) {
      const V3 base = interpolated_color(t, w);
      store(first ? base : choose(lanes, base, load(surface.base, i)), surface.base, i);
    }
  }
}

/// So many triangles of a block are interpolated one after the other, each at once for all of its
/// pixels: cheaper than looking them up, and they are set up once a bin.
constexpr std::size_t kFew = 4;
/// Who has more runs of pixels in its rows mostly sees more of them.
constexpr int kFewRuns = 20;

/// interpolate(), where the block sees no more than a few triangles; else returns false.
HWY_NOINLINE bool interpolate_few(const LitScene& scene, const FrameGeometry& frame,
                                  const VisibleBlock& block, bool wants_normals, bool wants_colors,
                                  bool cut, LitBlock& surface) {
  std::uint64_t low[kFew], own[kFew];
  std::size_t count = 0;
  for (std::uint64_t rest = block.covered; rest != 0; ++count) {
    if (count == kFew) return false;
    low[count] = block.keys[std::countr_zero(rest)] & kIdMask;
    own[count] = pixels_of(block.keys, low[count], rest);
    rest &= ~own[count];
  }
  auto& kept = *static_cast<KeptTriangles*>(block.scratch);
  std::uint64_t before = 0;
  for (std::size_t k = 0; k < count; before |= own[k++])
    interpolate_one(kept.find(scene, frame, low[k], wants_normals), block, own[k], before,
                    wants_normals, wants_colors, cut, surface);
  return true;
}

/// Normals (not normalized) and colours of the covered pixels. `cut`: triangles may not cover them.
HWY_NOINLINE void interpolate(const LitScene& scene, const FrameGeometry& frame,
                              const VisibleBlock& block, bool wants_normals, bool wants_colors,
                              bool cut, LitBlock& surface) {
  const std::uint64_t starts = SeenTriangles::run_starts(block.keys, block.covered);
  if (std::popcount(starts) <= kFewRuns &&
      interpolate_few(scene, frame, block, wants_normals, wants_colors, cut, surface))
    return;
  const F32 d;
  const I32 di;
  const hn::Rebind<std::uint8_t, I32> du8;
  constexpr std::uint64_t kAll = (std::uint64_t{1} << kLanes) - 1;
  auto& kept = *static_cast<KeptTriangles*>(block.scratch);
  SeenLanes& of_block = seen_lanes(scene, frame, block, starts, wants_normals, kept);
  const SeenTriangles& seen = of_block.seen;
  const std::size_t groups = of_block.groups();
  for (std::size_t first = 0; first < 64; first += kLanes) {
    const std::uint64_t covered = block.covered >> first & kAll;
    if (covered == 0) continue;
    const Points at(block, first);
    const auto place = hn::PromoteTo(di, hn::Load(du8, seen.place + first));
    const Lookup look{hn::IndicesFromVec(d, hn::And(place, hn::Set(di, int{kLanes} - 1)))};
    V3 n = set(Vec3{}), base = n;
    for (std::size_t g = 0; g < groups; ++g) {
      const auto last = hn::Or(place, hn::Set(di, int{kLanes} - 1));
      const auto mine =
          hn::RebindMask(d, hn::Eq(last, hn::Set(di, static_cast<int>(g * kLanes + kLanes - 1))));
      if (groups > 1 && (bits_of(mine) & covered) == 0) continue;
      const LitLanes& t = of_block.lanes[g];
      CornerWeights w = look.weights(t, at.px, at.py);
      if (cut) w = inside(w);
      if (wants_normals) n = choose(mine, look.sum(w, t.normal), n);
      if (wants_colors)
        base = choose(mine, look.sum(w, t.color) * (set(1) / (w.b0 + w.b1 + w.b2)), base);
    }
    for (std::uint64_t rest = of_block.exact; rest != 0; rest &= rest - 1) {
      const int number = std::countr_zero(rest);
      const auto mine = hn::RebindMask(d, hn::Eq(place, hn::Set(di, number)));
      const std::uint64_t own = bits_of(mine) & covered;
      if (own == 0) continue;
      const LitTriangle& t = kept.find(scene, frame, seen.low[number], wants_normals);
      CornerWeights w = exact_weights(t.planes, block, first, own);
      if (cut) w = inside(w);
      if (wants_normals) n = choose(mine, w.sum(t.normal), n);
      if (wants_colors) base = choose(mine, interpolated_color(t, w), base);
    }
    if (wants_normals) store(n, surface.n, first);
    if (wants_colors) store(base, surface.base, first);
  }
}

/// Takes the colours of kLanes pixels, from `first` on.
struct ToBlock {
  BlockColors& colors;

  HWY_INLINE void operator()(std::size_t first, std::uint64_t /*covered*/, const V3& c) const {
    const F32 d;
    hn::Store(c.x, d, colors.r + first);
    hn::Store(c.y, d, colors.g + first);
    hn::Store(c.z, d, colors.b + first);
  }
  HWY_INLINE void nothing(std::size_t /*first*/) const {}
};
/// The same, to a picture of 8 bits.
struct ToPixels {
  BlockPixels to;
  Rgba8 empty;

  HWY_INLINE void operator()(std::size_t first, std::uint64_t covered, const V3& c) const {
    const hn::RebindToUnsigned<F32> d;
    const auto pixel = packed(c.x, c.y, c.z, 0xff000000U);
    put(first, hn::IfThenElse(hn::RebindMask(d, mask_of(covered)), pixel, behind()));
  }
  HWY_INLINE void nothing(std::size_t first) const { put(first, behind()); }

 private:
  HWY_INLINE hn::Vec<hn::RebindToUnsigned<F32>> behind() const {
    return hn::Set(hn::RebindToUnsigned<F32>(), std::bit_cast<std::uint32_t>(empty));
  }
  HWY_INLINE void put(std::size_t first, hn::Vec<hn::RebindToUnsigned<F32>> pixels) const {
    const hn::RebindToUnsigned<F32> d;
    auto* const at = reinterpret_cast<std::uint32_t*>(
        to.data + static_cast<std::ptrdiff_t>(first / kBlockSize) * to.stride + first % kBlockSize);
#if RASTRUM_LIT_LANES == 16
    const hn::Half<hn::RebindToUnsigned<F32>> row;
    hn::StoreU(hn::LowerHalf(row, pixels), row, at);
    hn::StoreU(hn::UpperHalf(row, pixels), row, at + to.stride);
#else
    hn::StoreU(pixels, d, at);
#endif
  }
};

/// Lights pixels [first, first + 2 kLanes) by the fixed light, two vectors side by side; `along`:
/// along_column of pixels' centres.
template <LitModel kModel, class Put>
HWY_INLINE void light_pair(const ViewRays& rays, const V3& along, const VisibleBlock& block,
                           const LitBlock& surface, bool colored, std::size_t first,
                           const Put& put) {
  constexpr std::uint64_t kAll = (std::uint64_t{1} << kLanes) - 1;
  const auto both = [&](const float(&from)[3][64]) HWY_ATTR {
    const V3 a = load(from, first), b = load(from, first + kLanes);
    return pairs::V3{{a.x, b.x}, {a.y, b.y}, {a.z, b.z}};
  };
  const pairs::V3 base = colored ? both(surface.base) : pairs::set(kDefaultBase);
  const pairs::V3 n = kModel != LitModel::flat ? both(surface.n) : base;
  const Points a(block, first), b(block, first + kLanes);
  const pairs::V3 columns =
      block.points == nullptr ? pairs::twice(along) : pairs::along_column(rays, {a.px, b.px});
  const pairs::V3 c = pairs::light(kModel, pairs::to_viewer(columns, rays, {a.py, b.py}), n, base);
  put(first, block.covered >> first & kAll, {c.x.a, c.y.a, c.z.a});
  put(first + kLanes, block.covered >> (first + kLanes) & kAll, {c.x.b, c.y.b, c.z.b});
}

/// Lights what `surface` holds, by the fixed light or those of `lights`; without `colored` it has
/// the default base colour.
template <LitModel kModel, bool kFixed, class Put>
HWY_NOINLINE void light_rows(const ViewRays& rays, const LightSet* lights,
                             const VisibleBlock& block, const LitBlock& surface, bool colored,
                             const Put& put) {
  constexpr std::uint64_t kAll = (std::uint64_t{1} << kLanes) - 1;
  // Two vectors want some thirty registers.
  constexpr bool kPairs = kFixed && kLanes == 16;
  const V3 along = along_column(rays, Points(block, 0).px);
  V3 base = set(kDefaultBase);
  for (std::size_t first = 0; first < 64; first += kLanes) {
    const std::uint64_t covered = block.covered >> first & kAll;
    if (covered == 0) {
      put.nothing(first);
      continue;
    }
    if constexpr (kPairs)
      if (first + kLanes < 64 && (block.covered >> (first + kLanes) & kAll) != 0) {
        light_pair<kModel>(rays, along, block, surface, colored, first, put);
        first += kLanes;
        continue;
      }
    if (colored) base = load(surface.base, first);
    const V3 n = kModel != LitModel::flat ? load(surface.n, first) : base;
    const Points at(block, first);
    V3 color;
    if constexpr (kFixed)
      color = light(kModel, rays, at.px, at.py, n, base);
    else
      color = light_by(*lights, kModel, rays, at.px, at.py, depths(block.keys + first), n, base);
    put(first, covered, color);
  }
}

template <LitModel kModel, class Put>
HWY_INLINE void light_block(const ViewRays& rays, const LightSet* lights, const VisibleBlock& block,
                            const LitBlock& surface, bool colored, const Put& put) {
  constexpr bool kLit = kModel == LitModel::lambert || kModel == LitModel::phong;
  if (kLit && lights != nullptr)
    light_rows<kModel, !kLit>(rays, lights, block, surface, colored, put);
  else
    light_rows<kModel, true>(rays, nullptr, block, surface, colored, put);
}

/// Two loops: lighting is one long chain of square roots and divisions, and the processor overlaps
/// several such chains only where little else stands between them. `own_base`: `surface` holds the
/// base colours.
template <LitModel kModel, class Put>
HWY_INLINE void shade_block(const LitScene& scene, const FrameGeometry& frame,
                            const VisibleBlock& block, LitBlock& surface, bool own_base,
                            const Put& put) {
  constexpr bool kNormals = kModel != LitModel::flat;
  const bool colored = !own_base && kModel != LitModel::normal && scene.colored;
  if (kNormals || colored) interpolate(scene, frame, block, kNormals, colored, false, surface);
  light_block<kModel>(scene.rays, scene.lights, block, surface, own_base || colored, put);
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
    shade_block<decltype(m)::value>(scene, frame, block, surface, false, ToBlock{colors});
    if (model != LitModel::flat) surface.normals = block.covered;
  });
}

bool shade_pixels(LitModel model, const LitScene& scene, const FrameGeometry& frame,
                  const VisibleBlock& block, Rgba8 empty, BlockPixels to) noexcept {
  return with_model(model, [&](auto m) HWY_ATTR {
    LitBlock surface;
    shade_block<decltype(m)::value>(scene, frame, block, surface, false, ToPixels{to, empty});
  });
}

bool seen_normals(const LitScene& scene, const FrameGeometry& frame, const VisibleBlock& block,
                  LitBlock& surface, bool cut, const float (*to_camera)[3],
                  SeenNormals& out) noexcept {
  const F32 d;
  constexpr std::uint64_t kAll = (std::uint64_t{1} << kLanes) - 1;
  if (surface.normals != block.covered) interpolate(scene, frame, block, true, false, cut, surface);
  for (std::size_t first = 0; first < 64; first += kLanes) {
    if ((block.covered >> first & kAll) == 0) continue;
    const Points at(block, first);
    const V3 n = seen_normal(scene.rays, at.px, at.py, load(surface.n, first));
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
    shade_block<decltype(m)::value>(scene, frame, block, surface, true, ToBlock{colors});
  });
}

bool light_all(LitModel model, const ViewRays& rays, const LightSet* lights,
               const VisibleBlock& block, const LitBlock& surface, BlockColors& colors) noexcept {
  return with_model(model, [&](auto m) HWY_ATTR {
    light_block<decltype(m)::value>(rays, lights, block, surface, true, ToBlock{colors});
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

bool store_lit_simd(Isa isa, LitModel model, const LitScene& scene, const FrameGeometry& frame,
                    const VisibleBlock& block, Rgba8 empty, BlockPixels to) noexcept {
  using Shade = bool (*)(LitModel, const LitScene&, const FrameGeometry&, const VisibleBlock&,
                         Rgba8, BlockPixels);
  static constexpr Shade kShade[] = RASTRUM_BY_ISA(shade_pixels, nullptr);
  const Shade shade = kShade[static_cast<std::size_t>(isa)];
  return shade != nullptr && shade(model, scene, frame, block, empty, to);
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
