// SPDX-License-Identifier: BSD-3-Clause
// Sets up the triangles of a bin of small triangles for materials, once for all blocks
// (seen_bin.hpp). Pixels look their triangle up by number.
#if defined(RASTRUM_RASTER_SHADE_MATERIAL_BIN_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_SHADE_MATERIAL_BIN_INL_HPP
#undef RASTRUM_RASTER_SHADE_MATERIAL_BIN_INL_HPP
#else
#define RASTRUM_RASTER_SHADE_MATERIAL_BIN_INL_HPP
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <rastrum/raster/shade/material_seen-inl.hpp>
#include <rastrum/raster/surface/seen_bin-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

/// Prefetches what set_triangles reads of simple triangles.
HWY_INLINE void prefetch_sources(const MaterialSources& from, std::size_t n, bool normals) {
  for (int c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < n; ++i) {
      __builtin_prefetch(from.vertex[c][i]);
      __builtin_prefetch(from.position[c][i]);
      if (normals) __builtin_prefetch(from.normal[c][i]);
    }
}

/// Stores a group's n triangles, from number `first` on, for look-up by pixels.
HWY_INLINE void store(const MaterialView& scene, const MaterialLanes& t, std::size_t first,
                      std::size_t n, SeenBin& seen) {
  const F32 d;
  const auto at = [&](const float* v) HWY_ATTR { return hn::Load(d, v); };
  const auto put = [&](std::size_t q, F x, F y, F z, F w) HWY_ATTR {
    hn::StoreInterleaved4(x, y, z, w, d, seen.quads[q] + first * 4);
  };
  for (std::size_t k = 0; k < SeenBin::kPairs; ++k) {
    const Wide a = load_wide(t.planes.number[2 * k]), b = load_wide(t.planes.number[2 * k + 1]);
    double* const to = seen.pairs[k] + first * 2;
    hn::StoreInterleaved2(a.lower, b.lower, F64{}, to);
    hn::StoreInterleaved2(a.upper, b.upper, F64{}, to + kLanes);
  }
  const std::uint64_t all = (std::uint64_t{1} << n) - 1;
  seen.some_normals |= t.with_normals != 0;
  seen.all_normals &= t.with_normals == all;
  seen.some_colors |= t.with_colors != 0;
  seen.all_colors &= t.with_colors == all;
  const auto has = [&](std::uint64_t lanes)
                       HWY_ATTR { return choose_or_zero(mask_of(lanes), set(1)); };
  const auto& nm = t.normal;
  put(0, at(t.face[0]), at(t.face[1]), at(t.face[2]), at(nm[0][0]));
  if (t.with_normals != 0) {
    put(1, at(nm[0][1]), at(nm[0][2]), at(nm[1][0]), at(nm[1][1]));
    put(2, at(nm[1][2]), at(nm[2][0]), at(nm[2][1]), at(nm[2][2]));
  }
  put(3, at(t.u[0]), at(t.u[1]), at(t.u[2]), at(t.v[0]));
  put(4, at(t.v[1]), at(t.v[2]), has(t.with_normals), has(t.with_colors));
  if (t.with_colors != 0) {
    const auto& c = t.color;
    put(5, at(c[0][0]), at(c[0][1]), at(c[0][2]), at(c[1][0]));
    put(6, at(c[1][1]), at(c[1][2]), at(c[2][0]), at(c[2][1]));
    put(7, at(c[2][2]), set(0), set(0), set(0));
  }
  for (std::size_t i = 0; i < n; ++i)
    seen.material[first + i] = static_cast<std::uint32_t>(t.material[i] - scene.materials.data());
}

/// Sets up the triangles of rows of blocks from `row` to seen.end_row, which it sets.
void see_bin(const MaterialView& scene, const FrameGeometry& frame, const BinSurface& bin, int row,
             SeenBin& seen) noexcept {
  struct Group {
    MaterialSources from;
    MaterialLanes lanes;
    const std::uint64_t* low;
  };
  seen.some_normals = seen.some_colors = false;
  seen.all_normals = seen.all_colors = true;
  MaterialOfTriangle finder(scene, frame);
  set_up_bin<Group>(
      find_triangles(frame, bin, row, seen), seen, finder,
      [&](const std::uint64_t* low, std::size_t n, Group& group) HWY_ATTR {
        group.low = low;
        find_sources(finder, low, n, group.from, group.lanes);
        prefetch_sources(group.from, n, group.lanes.with_normals != 0);
      },
      [&](std::size_t first, std::size_t n, Group& group) HWY_ATTR {
        set_triangles(finder, group.low, n, kLanes, group.from, group.lanes);
        store(scene, group.lanes, first, n, seen);
      });
}

/// Looks up in the bin the triangles of kLanes pixels, by the numbers at `place`.
struct BinLookup {
  const SeenBin& bin;
  const std::uint16_t* place;

  template <std::size_t kFirst>
  [[nodiscard]] HWY_INLINE WidePair planes() const {
    const double* const pairs = bin.pairs[kFirst / 2];
    const WideHalf a = half(pairs, place), b = half(pairs, place + kHalf);
    return {{a.first, b.first}, {a.second, b.second}};
  }
  [[nodiscard]] HWY_INLINE V3 face() const {
    const V4 q = quad(0);
    return {q.x, q.y, q.z};
  }
  [[nodiscard]] HWY_INLINE bool some_normals() const { return bin.some_normals; }
  [[nodiscard]] HWY_INLINE bool some_colors() const { return bin.some_colors; }
  [[nodiscard]] HWY_INLINE hn::Mask<F32> with_normals() const {
    return bin.all_normals ? mask_of(~std::uint64_t{0}) : quad(4).z > set(0);
  }
  [[nodiscard]] HWY_INLINE hn::Mask<F32> with_colors() const {
    return bin.all_colors ? mask_of(~std::uint64_t{0}) : quad(4).w > set(0);
  }
  HWY_INLINE void normals(V3 (&corner)[3]) const {
    const V4 a = quad(0), b = quad(1), c = quad(2);
    corner[0] = {a.w, b.x, b.y};
    corner[1] = {b.z, b.w, c.x};
    corner[2] = {c.y, c.z, c.w};
  }
  HWY_INLINE void colors(V3 (&corner)[3]) const {
    const V4 a = quad(5), b = quad(6), c = quad(7);
    corner[0] = {a.x, a.y, a.z};
    corner[1] = {a.w, b.x, b.y};
    corner[2] = {b.z, b.w, c.x};
  }
  HWY_INLINE void coordinates(V3& u, V3& v) const {
    const V4 a = quad(3), b = quad(4);
    u = {a.x, a.y, a.z};
    v = {a.w, b.x, b.y};
  }

 private:
  struct WideHalf {
    D first, second;
  };
  static HWY_INLINE WideHalf half(const double* pairs, const std::uint16_t* place) {
    const hn::Full128<double> d;
    const auto pair = [&](std::size_t i)
                          HWY_ATTR { return hn::Load(d, pairs + std::size_t{place[i]} * 2); };
    // Every second pixel, so that interleaving blocks of 128 bits puts pairs in order.
    const auto seconds = [&](std::size_t i) HWY_ATTR {
#if RASTRUM_LANE_COUNT == 16
      const hn::Half<F64> two;
      return hn::Combine(F64{}, hn::Combine(two, pair(i + 6), pair(i + 4)),
                         hn::Combine(two, pair(i + 2), pair(i)));
#elif RASTRUM_LANE_COUNT == 8
      return hn::Combine(F64{}, pair(i + 2), pair(i));
#else
      return pair(i);
#endif
    };
    const D even = seconds(0), odd = seconds(1);
    return {hn::InterleaveLower(F64{}, even, odd), hn::InterleaveUpper(F64{}, even, odd)};
  }
  [[nodiscard]] HWY_INLINE V4 quad(std::size_t q) const {
    return transposed([&](std::size_t i)
                          HWY_ATTR { return bin.quads[q] + std::size_t{place[i]} * 4; });
  }
};

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_SHADE_MATERIAL_BIN_INL_HPP
