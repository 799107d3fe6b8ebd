// SPDX-License-Identifier: BSD-3-Clause
// Interpolates normals and colours of triangles at a block's pixels. If the block sees few
// triangles, each is interpolated for all its pixels at once. Otherwise kLanes pixels at a time
// look up their triangles, in the block's or in the bin's (VisibleBlock::bin).
#if defined(RASTRUM_RASTER_SHADE_LIT_INTERPOLATE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_SHADE_LIT_INTERPOLATE_INL_HPP
#undef RASTRUM_RASTER_SHADE_LIT_INTERPOLATE_INL_HPP
#else
#define RASTRUM_RASTER_SHADE_LIT_INTERPOLATE_INL_HPP
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <rastrum/raster/draws/interpolate.hpp>
#include <rastrum/raster/shade/lit_kernels.hpp>
#include <rastrum/raster/shade/lit_seen-inl.hpp>
#include <rastrum/raster/shade/lit_triangle.hpp>
#include <rastrum/raster/surface/seen_bin.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

/// Float64 weights at pixels first to first + kLanes of an `exact` triangle.
HWY_INLINE CornerWeights exact_weights(const WeightPlanes& planes, const VisibleBlock& block,
                                       std::size_t first) {
  const WidePoints at(block, first);
  return exact_weights(planes, at.x, at.y);
}

/// The block's triangles, set up; `starts`: where runs begin.
HWY_INLINE SeenLanes& seen_lanes(const LitScene& scene, const FrameGeometry& frame,
                                 const VisibleBlock& block, std::uint64_t starts,
                                 bool wants_normals, KeptTriangles& kept) {
  auto& own = *reinterpret_cast<SeenLanes*>(kept.lanes);
  SeenTriangles& seen = own.seen;
  if (find_places(block.keys, starts, seen)) return own;
  LitOfTriangle finder(scene, frame);
  for (std::size_t i = 0; i < seen.count; ++i) finder.prefetch(seen.low[i]);
  own.exact = 0;
  for (std::size_t g = 0; g < own.groups(); ++g) {
    const std::size_t first = g * kLanes;
    fetch_triangles(finder, seen.low + first, std::min(kLanes, seen.count - first), wants_normals,
                    own.lanes[g]);
    own.exact |= own.lanes[g].exact << first;
  }
  return own;
}

/// Interpolates triangle `t` at the pixels `own`. `before`: pixels already set. A vector with none
/// of these may be written whole.
HWY_INLINE void interpolate_one(const LitTriangle& t, const VisibleBlock& block, std::uint64_t own,
                                std::uint64_t before, bool wants_normals, bool wants_colors,
                                bool cut, LitBlock& surface) {
  constexpr std::uint64_t kAll = (std::uint64_t{1} << kLanes) - 1;
  for (std::size_t i = 0; i < 64; i += kLanes) {
    const std::uint64_t mine = own >> i & kAll;
    if (mine == 0) continue;
    const Points at(block, i);
    CornerWeights w = t.exact ? exact_weights(t.planes, block, i) : weights_of(t, at.px, at.py);
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

/// Up to so many triangles of a block are interpolated one by one. That is cheaper than look-ups,
/// and each is set up once a bin.
constexpr std::size_t kFew = 4;
/// A block with more runs of pixels mostly sees more triangles than kFew.
constexpr int kFewRuns = 20;

/// interpolate() for few triangles; returns false for more.
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

/// Stores normals and colours of an `exact` triangle at the pixels `own` of a vector.
HWY_NOINLINE void put_exact(const LitTriangle& t, const VisibleBlock& block, std::size_t first,
                            std::uint64_t own, bool wants_normals, bool wants_colors, bool cut,
                            V3& n, V3& base) {
  CornerWeights w = exact_weights(t.planes, block, first);
  if (cut) w = inside(w);
  const auto mine = mask_of(own);
  if (wants_normals) n = choose(mine, w.sum(t.normal), n);
  if (wants_colors) base = choose(mine, interpolated_color(t, w), base);
}

/// interpolate() with the bin's set-up triangles.
HWY_NOINLINE void interpolate_bin(const LitScene& scene, const FrameGeometry& frame,
                                  const VisibleBlock& block, bool wants_normals, bool wants_colors,
                                  LitBlock& surface) {
  constexpr std::uint64_t kAll = (std::uint64_t{1} << kLanes) - 1;
  const SeenBin& bin = *block.bin;
  const std::uint16_t* const places = bin.places_of(block.x0, block.y0);
  for (std::size_t first = 0; first < 64; first += kLanes) {
    const std::uint64_t covered = block.covered >> first & kAll;
    if (covered == 0) continue;
    const std::uint16_t* const place = places + first;
    const auto quad = [&](std::size_t q) HWY_ATTR {
      return transposed([&](std::size_t i)
                            HWY_ATTR { return bin.quads[q] + std::size_t{place[i]} * 4; });
    };
    const Points at(block, first);
    const V4 a = quad(0), b = quad(1), c = quad(2);
    // weights_of.
    const F dx = at.px - a.x, dy = at.py - a.y;
    const F l1 = a.z * dx + a.w * dy, l2 = b.x * dx + b.y * dy;
    const CornerWeights w{(set(1) - l1 - l2) * b.z, l1 * b.w, l2 * c.x};
    V3 n = set(Vec3{}), base = n;
    if (wants_normals) {
      const V4 d = quad(3), e = quad(4);
      n = V3{c.z, c.w, d.x} * w.b0 + V3{d.y, d.z, d.w} * w.b1 + V3{e.x, e.y, e.z} * w.b2;
    }
    if (wants_colors) {
      const V4 d = quad(5), e = quad(6), f = quad(7);
      base = mixed_color(w, {d.x, d.y, d.z}, {d.w, e.x, e.y}, {e.z, e.w, f.x});
    }
    for (std::uint64_t rest = bits_of(c.y > set(0)) & covered; rest != 0;) {
      const std::uint16_t number = place[std::countr_zero(rest)];
      std::uint64_t own = 0;
      for (std::size_t i = 0; i < kLanes; ++i) own |= std::uint64_t{place[i] == number} << i;
      rest &= ~own;
      auto& kept = *static_cast<KeptTriangles*>(block.scratch);
      put_exact(kept.find(scene, frame, bin.low[number], wants_normals), block, first,
                own & covered, wants_normals, wants_colors, false, n, base);
    }
    if (wants_normals) store(n, surface.n, first);
    if (wants_colors) store(base, surface.base, first);
  }
}

/// Normals, not normalized, and colours of the covered pixels. `cut`: triangles may miss the
/// centres.
HWY_NOINLINE void interpolate(const LitScene& scene, const FrameGeometry& frame,
                              const VisibleBlock& block, bool wants_normals, bool wants_colors,
                              bool cut, LitBlock& surface) {
  if (block.bin != nullptr)
    return interpolate_bin(scene, frame, block, wants_normals, wants_colors, surface);
  const std::uint64_t starts = run_starts(block.keys, block.covered);
  if (std::popcount(starts) <= kFewRuns &&
      interpolate_few(scene, frame, block, wants_normals, wants_colors, cut, surface))
    return;
  const F32 d;
  const I32 di;
  constexpr std::uint64_t kAll = (std::uint64_t{1} << kLanes) - 1;
  auto& kept = *static_cast<KeptTriangles*>(block.scratch);
  SeenLanes& of_block = seen_lanes(scene, frame, block, starts, wants_normals, kept);
  const SeenTriangles& seen = of_block.seen;
  const std::size_t groups = of_block.groups();
  for (std::size_t first = 0; first < 64; first += kLanes) {
    const std::uint64_t covered = block.covered >> first & kAll;
    if (covered == 0) continue;
    const Points at(block, first);
    const I place = numbers_of(seen.place, first);
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
      if (wants_colors) base = choose(mine, look.color(w, t.color), base);
    }
    for (std::uint64_t rest = of_block.exact; rest != 0; rest &= rest - 1) {
      const int number = std::countr_zero(rest);
      const auto mine = hn::RebindMask(d, hn::Eq(place, hn::Set(di, number)));
      const std::uint64_t own = bits_of(mine) & covered;
      if (own == 0) continue;
      put_exact(kept.find(scene, frame, seen.low[number], wants_normals), block, first, own,
                wants_normals, wants_colors, cut, n, base);
    }
    if (wants_normals) store(n, surface.n, first);
    if (wants_colors) store(base, surface.base, first);
  }
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_SHADE_LIT_INTERPOLATE_INL_HPP
