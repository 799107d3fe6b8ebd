// SPDX-License-Identifier: BSD-3-Clause
// The lit shaders for fragments sorted by triangle (FragmentRuns). kLanes triangles are set up at
// once, their fragments look them up by vectors, and a whole batch is lit in full vectors. A vector
// that reaches beyond its group's last fragment is stored whole; the next overwrites the rest.
#if defined(RASTRUM_RASTER_SHADE_LIT_RUNS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_SHADE_LIT_RUNS_INL_HPP
#undef RASTRUM_RASTER_SHADE_LIT_RUNS_INL_HPP
#else
#define RASTRUM_RASTER_SHADE_LIT_RUNS_INL_HPP
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <hwy/highway.h>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/shade/lit_seen-inl.hpp>
#include <rastrum/raster/shade/shader.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

/// A batch of groups is lit at once when it has so many fragments. A group has at most
/// kMostOfGroup.
constexpr std::size_t kBatch = 128, kMostOfGroup = 256;

/// kLanes triangles and their fragments, each with its triangle's lane.
struct RunGroup {
  std::size_t triangles = 0;
  std::size_t batch = 0;  ///< first fragment of its batch
  std::size_t begin = 0, end = 0;
  /// After this group the batch is lit up to here, in full vectors except for the last batch. The
  /// rest begins the next batch. 0: the batch goes on.
  std::size_t lit_up_to = 0;
  bool wanted = false;
  std::uint64_t low[kLanes];
  std::size_t first[kLanes + 1];
  std::uint8_t lane_of[kMostOfGroup + 64];
  LitSources from;
  LitLanes lanes;
};

/// Byte j of element b counts the bits of b up to bit j.
constexpr auto kBitsUpTo = [] {
  std::array<std::uint64_t, 256> table{};
  for (std::uint64_t b = 0; b < 256; ++b)
    for (std::uint64_t j = 0; j < 8; ++j)
      table[b] |= static_cast<std::uint64_t>(std::popcount(b & ((2U << j) - 1))) << 8 * j;
  return table;
}();

/// Which of the 64 fragments from i < count on are the first of a triangle. Bits beyond the end are
/// undefined.
HWY_INLINE std::uint64_t firsts_from(const FragmentRuns& runs, std::size_t i) {
  const std::size_t word = i / 64, shift = i % 64;
  const std::uint64_t low = runs.firsts[word] >> shift;
  const bool more = shift != 0 && (word + 1) * 64 < runs.count;
  return more ? low | runs.firsts[word + 1] << (64 - shift) : low;
}

HWY_INLINE bool any_wanted(const FragmentRuns& runs, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end;) {
    const std::size_t n = std::min(end - i, 64 - i % 64);
    if ((runs.wanted[i / 64] >> i % 64 & ~std::uint64_t{0} >> (64 - n)) != 0) return true;
    i += n;
  }
  return false;
}

/// Takes the next triangles behind `last`, up to kLanes.
HWY_INLINE void find_group(const FragmentRuns& runs, const RunGroup& last, RunGroup& group) {
  const std::size_t begin = last.end, most = std::min(runs.count, begin + kMostOfGroup);
  group.batch = last.lit_up_to != 0 ? last.lit_up_to : last.batch;
  group.begin = begin;
  std::size_t n = 0, i = begin;
  for (std::size_t end = begin; i < most && end == i;) {
    end = std::min(i + 64, most);
    std::uint64_t bits = firsts_from(runs, i) & ~std::uint64_t{0} >> (64 - (end - i));
    if (i == begin) bits |= 1;  // also of a triangle that is split
    std::uint64_t rest = bits;
    const std::size_t triangles =
        std::min(static_cast<std::size_t>(parallel::popcount(bits)), kLanes - n);
    for (const std::size_t last_one = n + triangles; n < last_one; ++n, rest &= rest - 1) {
      const std::size_t at = i + static_cast<std::size_t>(std::countr_zero(rest));
      group.first[n] = at;
      group.low[n] = runs.keys[at] & kIdMask;
    }
    const std::size_t stop = rest != 0 ? i + static_cast<std::size_t>(std::countr_zero(rest)) : end;
    // Starts at 0: the sum of all bytes is right, whatever is carried between.
    std::uint64_t before = n - triangles - 1;
    for (std::size_t k = i; k < stop; k += 8, bits >>= 8) {
      const std::uint64_t run = kBitsUpTo[bits & 0xFF] + before * 0x0101010101010101U;
      std::memcpy(group.lane_of + (k - begin), &run, sizeof run);
      before += static_cast<std::uint64_t>(parallel::popcount(bits & 0xFF));
    }
    i = stop;
  }
  group.first[n] = i;
  group.triangles = n;
  group.end = i;
  const std::size_t in_batch = i - group.batch;
  group.lit_up_to = 0;
  if (i == runs.count)
    group.lit_up_to = i;
  else if (in_batch >= kBatch)
    group.lit_up_to = group.batch + in_batch / kLanes * kLanes;
  group.wanted = n != 0 && (runs.wanted == nullptr || any_wanted(runs, begin, i));
}

HWY_INLINE void prefetch_vertices(LitOfTriangle& finder, bool wants_normals, RunGroup& group) {
  const std::size_t n = group.triangles;
  find_all_sources(finder, group.low, n, (n + 3) / 4 * 4, wants_normals, group.from, group.lanes);
  prefetch_sources(group.from, n, wants_normals);
}

/// The surface at a batch's fragments; vectors may reach beyond.
struct alignas(64) RunSurface {
  static constexpr std::size_t kSize = kBatch + kMostOfGroup + kLanes;
  float px[kSize], py[kSize];
  float n[3][kSize], base[3][kSize];

  /// Moves the vector at `at` to the front.
  HWY_INLINE void begin_with(std::size_t at, bool wants_normals, bool colored) {
    const F32 d;
    const auto move = [&](float* values)
                          HWY_ATTR { hn::Store(hn::LoadU(d, values + at), d, values); };
    move(px);
    move(py);
    for (int axis = 0; axis < 3; ++axis) {
      if (wants_normals) move(n[axis]);
      if (colored) move(base[axis]);
    }
  }
};

/// Pixel centres of kLanes fragments from i on.
HWY_INLINE void find_places(const FragmentRuns& runs, std::size_t i, F& px, F& py) {
  const F32 d;
  const hn::Rebind<std::uint16_t, I32> d16;
  const F half = set(0.5F);
  static_assert(kRunPitch == 64);
  const I pixel = hn::PromoteTo(I32{}, hn::LoadU(d16, runs.pixels + i));
  const I x = hn::Add(hn::And(pixel, hn::Set(I32{}, kRunPitch - 1)), hn::Set(I32{}, runs.x0));
  const I y = hn::Add(hn::ShiftRight<6>(pixel), hn::Set(I32{}, runs.y0));
  px = hn::ConvertTo(d, x) + half;
  py = hn::ConvertTo(d, y) + half;
}

HWY_INLINE void store_at(const V3& v, float (&to)[3][RunSurface::kSize], std::size_t at) {
  const F32 d;
  hn::StoreU(v.x, d, to[0] + at);
  hn::StoreU(v.y, d, to[1] + at);
  hn::StoreU(v.z, d, to[2] + at);
}
HWY_INLINE V3 load_at(const float (&from)[3][RunSurface::kSize], std::size_t at) {
  const F32 d;
  return {hn::LoadU(d, from[0] + at), hn::LoadU(d, from[1] + at), hn::LoadU(d, from[2] + at)};
}

HWY_INLINE Vec3 corner(const float (&v)[3][3][kLanes], int c, std::size_t lane) {
  return {v[c][0][lane], v[c][1][lane], v[c][2][lane]};
}

/// Interpolates the fragments of a lane for which float32 is not exact enough.
HWY_NOINLINE void interpolate_exact(const FrameGeometry& frame, const RunGroup& group,
                                    std::size_t lane, bool wants_normals, bool colored,
                                    RunSurface& out) {
  const std::uint64_t id = kIdMask - group.low[lane];
  const WeightPlanes planes = planes_of(frame, id);
  const LitLanes& t = group.lanes;
  Vec3 normal[3], color[3];
  for (int c = 0; c < 3; ++c) {
    if (wants_normals) normal[c] = corner(t.normal, c, lane);
    if (colored) color[c] = corner(t.color, c, lane);
  }
  for (std::size_t i = group.first[lane]; i < group.first[lane + 1]; i += kLanes) {
    const std::size_t at = i - group.batch;
    const CornerWeights w = exact_weights(planes, wide(hn::LoadU(F32{}, out.px + at)),
                                          wide(hn::LoadU(F32{}, out.py + at)));
    const auto mine = hn::FirstN(F32{}, std::min(kLanes, group.first[lane + 1] - i));
    if (wants_normals) store_at(choose(mine, w.sum(normal), load_at(out.n, at)), out.n, at);
    if (!colored) continue;
    const V3 base = mixed_color(w, set(color[0]), set(color[1]), set(color[2]));
    store_at(choose(mine, base, load_at(out.base, at)), out.base, at);
  }
}

template <bool kNormals>
HWY_INLINE void interpolate_group(const FrameGeometry& frame, const FragmentRuns& runs,
                                  RunGroup& group, bool colored, RunSurface& out) {
  const F32 d;
  const hn::Rebind<std::uint8_t, I32> du8;
  LitLanes& t = group.lanes;
  fetch_triangles(group.from, group.triangles, kNormals, t);
  for (std::size_t i = group.begin; i < group.end; i += kLanes) {
    const std::size_t at = i - group.batch;
    const I lane = hn::PromoteTo(I32{}, hn::LoadU(du8, group.lane_of + (i - group.begin)));
    // Lanes beyond the group may be anything.
    const Lookup look{hn::IndicesFromVec(d, hn::And(lane, hn::Set(I32{}, int{kLanes} - 1)))};
    F px, py;
    find_places(runs, i, px, py);
    hn::StoreU(px, d, out.px + at);
    hn::StoreU(py, d, out.py + at);
    const CornerWeights w = look.weights(t, px, py);
    if constexpr (kNormals) store_at(look.sum(w, t.normal), out.n, at);
    if (colored) store_at(look.color(w, t.color), out.base, at);
  }
  for (std::uint64_t rest = t.exact; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rest));
    interpolate_exact(frame, group, i, kNormals, colored, out);
  }
}

template <Shader kModel, bool kFixed>
HWY_INLINE void light_batch(const LitScene& scene, const FragmentRuns& runs, std::size_t begin,
                            std::size_t end, const RunSurface& surface, bool colored, float alpha,
                            Vec4* colors) {
  const F32 d;
  const ViewRays rays = scene.rays;
  V3 base = set(kDefaultBase);
  for (std::size_t f = begin; f < end; f += kLanes) {
    const std::size_t i = f - begin, last = std::min(f + kLanes, end);
    if (runs.wanted != nullptr && !any_wanted(runs, f, last)) continue;
    if (colored) base = load(surface.base, i);
    const V3 n = row_of(kModel).normal ? load(surface.n, i) : base;
    const F px = hn::Load(d, surface.px + i), py = hn::Load(d, surface.py + i);
    V3 c;
    if constexpr (kFixed)
      c = light(kModel, rays, px, py, n, base);
    else
      c = light_by(*scene.lights, kModel, rays, px, py, depths(runs.keys + f), n, base);
    const V4 color = V4{c.x, c.y, c.z, set(1)} * set(alpha);
    if (runs.wanted == nullptr) {
      // The next batch overwrites what reaches beyond this one.
      hn::StoreInterleaved4(color.x, color.y, color.z, color.w, d, &colors[f].x);
      continue;
    }
    Vec4 shaded[kLanes];
    hn::StoreInterleaved4(color.x, color.y, color.z, color.w, d, &shaded[0].x);
    for (std::size_t k = f; k < last; ++k)
      if ((runs.wanted[k / 64] >> k % 64 & 1) != 0) colors[k] = shaded[k - f];
  }
}

template <Shader kModel>
void shade_runs_of(const LitScene& scene, const FrameGeometry& frame, const FragmentRuns& runs,
                   float alpha, Vec4* colors) {
  constexpr bool kNormals = row_of(kModel).normal;
  constexpr bool kLit = row_of(kModel).lights;
  const bool colored = row_of(kModel).base && scene.colored;
  RunSurface surface;
  const auto light = [&](std::size_t begin, std::size_t end) HWY_ATTR {
    if (kLit && scene.lights != nullptr)
      light_batch<kModel, !kLit>(scene, runs, begin, end, surface, colored, alpha, colors);
    else
      light_batch<kModel, true>(scene, runs, begin, end, surface, colored, alpha, colors);
  };
  if (!kNormals && !colored) {
    for (std::size_t begin = 0; begin < runs.count; begin += kBatch) {
      const std::size_t end = std::min(runs.count, begin + kBatch);
      for (std::size_t i = begin; i < end; i += kLanes) {
        F px, py;
        find_places(runs, i, px, py);
        hn::Store(px, F32{}, surface.px + (i - begin));
        hn::Store(py, F32{}, surface.py + (i - begin));
      }
      light(begin, end);
    }
    return;
  }
  // While a group is shaded, the next one's vertices and the indices of the one after come from
  // memory.
  RunGroup groups[3];
  LitOfTriangle finder(scene, frame);
  const auto find = [&](std::size_t g) HWY_ATTR {
    RunGroup& group = groups[g % 3];
    find_group(runs, groups[(g + 2) % 3], group);
    if (group.wanted)
      for (std::size_t i = 0; i < group.triangles; ++i) finder.prefetch(group.low[i]);
  };
  const auto source = [&](std::size_t g) HWY_ATTR {
    RunGroup& group = groups[g % 3];
    if (group.wanted) prefetch_vertices(finder, kNormals, group);
  };
  find(0);
  source(0);
  find(1);
  for (std::size_t g = 0; groups[g % 3].triangles != 0; ++g) {
    RunGroup& group = groups[g % 3];
    find(g + 2);
    source(g + 1);
    if (group.wanted) interpolate_group<kNormals>(frame, runs, group, colored, surface);
    if (group.lit_up_to == 0) continue;
    light(group.batch, group.lit_up_to);
    surface.begin_with(group.lit_up_to - group.batch, kNormals, colored);
  }
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_SHADE_LIT_RUNS_INL_HPP
