// The lit shaders of fragments that lie side by side by triangle (FragmentRuns), compiled once per
// instruction set. A batch of triangles is set up, then each is interpolated along its own
// fragments, a vector at a time, then all of them are lit in full vectors, whatever their triangles
// and pixels.
//
// A vector reaches beyond a triangle's last fragment and is stored whole: the next triangle writes
// over the rest. So nothing is searched, masked or blended, as rows of pixels need it
// (lit_simd.cpp), whose bits these are.

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/shade/lit_runs_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <type_traits>

#include <rastrum/raster/kernels/lanes-inl.hpp>
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

constexpr std::size_t kMostTriangles = 32, kMostFragments = 256;

/// The triangles of a batch: fragments first[i] up to end[i].
struct Batch {
  std::size_t triangles = 0;
  std::size_t begin = 0, end = 0;  ///< of the fragments, also those of triangles left out
  std::size_t first[kMostTriangles], last[kMostTriangles];
};

/// The first of a triangle from fragment i on; `count` if there is none.
HWY_INLINE std::size_t next_first(const FragmentRuns& runs, std::size_t i) {
  if (i >= runs.count) return runs.count;
  std::size_t word = i / 64;
  std::uint64_t bits = runs.firsts[word] >> i % 64;
  while (bits == 0) {
    i = ++word * 64;
    if (i >= runs.count) return runs.count;
    bits = runs.firsts[word];
  }
  return std::min(runs.count, i + static_cast<std::size_t>(std::countr_zero(bits)));
}

HWY_INLINE bool any_wanted(const FragmentRuns& runs, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end;) {
    const std::size_t n = std::min(end - i, 64 - i % 64);
    if ((runs.wanted[i / 64] >> i % 64 & ~std::uint64_t{0} >> (64 - n)) != 0) return true;
    i += n;
  }
  return false;
}

/// The batch that begins at fragment `begin`.
HWY_INLINE void find_batch(const FragmentRuns& runs, std::size_t begin, Batch& batch) {
  const std::size_t most = std::min(runs.count, begin + kMostFragments);
  std::size_t n = 0, i = begin;
  while (n < kMostTriangles && i < most) {
    // What is left of a triangle begins the next batch.
    const std::size_t end = std::min(next_first(runs, i + 1), most);
    batch.first[n] = i;
    batch.last[n] = end;
    n += runs.wanted == nullptr || any_wanted(runs, i, end);
    i = end;
  }
  batch.triangles = n;
  batch.begin = begin;
  batch.end = i;
}

/// What is known of a batch's fragments; a vector may reach beyond them.
struct alignas(64) Surface {
  float px[kMostFragments + kLanes], py[kMostFragments + kLanes];
  float n[3][kMostFragments + kLanes], base[3][kMostFragments + kLanes];
};

HWY_INLINE void find_places(const FragmentRuns& runs, const Batch& batch, Surface& out) {
  const F32 d;
  const hn::Rebind<std::uint16_t, I32> d16;
  const I column = hn::Set(I32{}, kRunPitch - 1);
  const I x0 = hn::Set(I32{}, runs.x0), y0 = hn::Set(I32{}, runs.y0);
  const F half = set(0.5F);
  static_assert(kRunPitch == 64);
  for (std::size_t i = 0; i < batch.end - batch.begin; i += kLanes) {
    const I pixel = hn::PromoteTo(I32{}, hn::LoadU(d16, runs.pixels + batch.begin + i));
    const I x = hn::Add(hn::And(pixel, column), x0);
    const I y = hn::Add(hn::ShiftRight<6>(pixel), y0);
    hn::Store(hn::ConvertTo(d, x) + half, d, out.px + i);
    hn::Store(hn::ConvertTo(d, y) + half, d, out.py + i);
  }
}

/// Of a thin triangle at fragments i … of the batch, of which `n` are its own.
HWY_NOINLINE void exact_weights(const LitTriangle& t, const FragmentRuns& runs, std::size_t i,
                                std::size_t n, float (&b)[3][kLanes]) {
  for (std::size_t lane = 0; lane < n; ++lane) {
    const int pixel = runs.pixels[i + lane];
    const Weights w =
        weights_at(t.planes, runs.x0 + pixel % kRunPitch, runs.y0 + pixel / kRunPitch);
    for (int c = 0; c < 3; ++c) b[c][lane] = static_cast<float>(w.b[c]);
  }
}

HWY_INLINE void store(const V3& v, float (&to)[3][kMostFragments + kLanes], std::size_t at) {
  const F32 d;
  hn::StoreU(v.x, d, to[0] + at);
  hn::StoreU(v.y, d, to[1] + at);
  hn::StoreU(v.z, d, to[2] + at);
}
HWY_INLINE V3 load(const float (&from)[3][kMostFragments + kLanes], std::size_t at) {
  const F32 d;
  return {hn::Load(d, from[0] + at), hn::Load(d, from[1] + at), hn::Load(d, from[2] + at)};
}

/// Of fragments first … last of the batch, which are t's.
template <bool kNormals>
HWY_INLINE void interpolate(const LitTriangle& t, const FragmentRuns& runs, std::size_t begin,
                            std::size_t first, std::size_t last, bool colored, Surface& out) {
  const F32 d;
  for (std::size_t i = first; i < last; i += kLanes) {
    CornerWeights w;
    if (HWY_LIKELY(!t.exact)) {
      w = weights_of(t, hn::LoadU(d, out.px + i), hn::LoadU(d, out.py + i));
    } else {
      HWY_ALIGN float b[3][kLanes] = {};
      exact_weights(t, runs, begin + i, std::min(kLanes, last - i), b);
      w = {hn::Load(d, b[0]), hn::Load(d, b[1]), hn::Load(d, b[2])};
    }
    if constexpr (kNormals) store(w.sum(t.normal), out.n, i);
    if (colored) store(interpolated_color(t, w), out.base, i);
  }
}

HWY_INLINE F depths(const std::uint64_t* keys, std::size_t count) {
  HWY_ALIGN float depth[kLanes] = {};
  for (std::size_t i = 0; i < std::min(count, kLanes); ++i) depth[i] = depth_of_key(keys[i]);
  return hn::Load(F32{}, depth);
}

template <LitModel kModel, bool kFixed>
HWY_INLINE void light_batch(const LitScene& scene, const FragmentRuns& runs, const Batch& batch,
                            const Surface& surface, bool colored, float alpha, Vec4* colors) {
  const F32 d;
  const ViewRays rays = scene.rays;
  const std::size_t count = batch.end - batch.begin;
  V3 base = set(kDefaultBase);
  for (std::size_t i = 0; i < count; i += kLanes) {
    const std::size_t f = batch.begin + i;
    if (runs.wanted != nullptr && !any_wanted(runs, f, f + std::min(kLanes, count - i))) continue;
    if (colored) base = load(surface.base, i);
    const V3 n = kModel != LitModel::flat ? load(surface.n, i) : base;
    const F px = hn::Load(d, surface.px + i), py = hn::Load(d, surface.py + i);
    V3 c;
    if constexpr (kFixed)
      c = light(kModel, rays, px, py, n, base);
    else
      c = light_by(*scene.lights, kModel, rays, px, py, depths(runs.keys + f, count - i), n, base);
    const V4 color = V4{c.x, c.y, c.z, set(1)} * set(alpha);
    if (runs.wanted == nullptr) {
      // What reaches beyond the batch is written over by the next.
      hn::StoreInterleaved4(color.x, color.y, color.z, color.w, d, &colors[f].x);
      continue;
    }
    Vec4 shaded[kLanes];
    hn::StoreInterleaved4(color.x, color.y, color.z, color.w, d, &shaded[0].x);
    for (std::size_t lane = 0; lane < std::min(kLanes, count - i); ++lane)
      if ((runs.wanted[(f + lane) / 64] >> (f + lane) % 64 & 1) != 0)
        colors[f + lane] = shaded[lane];
  }
}

template <LitModel kModel>
void shade_model(const LitScene& scene, const FrameGeometry& frame, const FragmentRuns& runs,
                 float alpha, Vec4* colors) {
  constexpr bool kNormals = kModel != LitModel::flat;
  constexpr bool kLit = kModel == LitModel::lambert || kModel == LitModel::phong;
  const bool colored = kModel != LitModel::normal && scene.colored;
  const bool asks = kNormals || colored;
  LitTriangle triangles[kMostTriangles];
  Surface surface;
  Batch batches[2];
  Batch* now = &batches[0];
  Batch* next = &batches[1];
  find_batch(runs, 0, *now);
  while (now->begin < runs.count) {
    // While this batch is shaded, the vertices of the next come from memory.
    find_batch(runs, now->end, *next);
    if (asks)
      for (std::size_t t = 0; t < next->triangles; ++t)
        prefetch_triangle(scene, frame, id_of_key(runs.keys[next->first[t]]), kNormals);
    find_places(runs, *now, surface);
    if (asks) {
      for (std::size_t t = 0; t < now->triangles; ++t)
        fetch_triangle(scene, frame, runs.keys[now->first[t]] & kIdMask, kNormals, triangles[t]);
      for (std::size_t t = 0; t < now->triangles; ++t)
        interpolate<kNormals>(triangles[t], runs, now->begin, now->first[t] - now->begin,
                              now->last[t] - now->begin, colored, surface);
    }
    if (kLit && scene.lights != nullptr)
      light_batch<kModel, !kLit>(scene, runs, *now, surface, colored, alpha, colors);
    else
      light_batch<kModel, true>(scene, runs, *now, surface, colored, alpha, colors);
    std::swap(now, next);
  }
}

bool shade(const LitShading& lit, const FrameGeometry& frame, const FragmentRuns& runs, float alpha,
           Vec4* colors) noexcept {
  const LitScene& scene = *lit.scene;
  switch (lit.model) {
    case LitModel::flat:
      shade_model<LitModel::flat>(scene, frame, runs, alpha, colors);
      return true;
    case LitModel::normal:
      shade_model<LitModel::normal>(scene, frame, runs, alpha, colors);
      return true;
    case LitModel::lambert:
      shade_model<LitModel::lambert>(scene, frame, runs, alpha, colors);
      return true;
    case LitModel::phong:
      shade_model<LitModel::phong>(scene, frame, runs, alpha, colors);
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
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::raster {

bool shade_lit_runs(Isa isa, const LitShading& lit, const FrameGeometry& frame,
                    const FragmentRuns& runs, float alpha, Vec4* colors) noexcept {
  using Shade = bool (*)(const LitShading&, const FrameGeometry&, const FragmentRuns&, float, Vec4*);
  static constexpr Shade kShade[] = RASTRUM_BY_ISA(shade, nullptr);
  const Shade shade = kShade[static_cast<std::size_t>(isa)];
  return shade != nullptr && shade(lit, frame, runs, alpha, colors);
}

}  // namespace rastrum::raster
#endif
