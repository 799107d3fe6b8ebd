// SPDX-License-Identifier: BSD-3-Clause
// Sets up the triangles of a bin of small triangles for the lit shaders, once for all blocks
// (seen_bin.hpp). Pixels look their triangle up by number.
#if defined(RASTRUM_RASTER_SHADE_LIT_BIN_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_SHADE_LIT_BIN_INL_HPP
#undef RASTRUM_RASTER_SHADE_LIT_BIN_INL_HPP
#else
#define RASTRUM_RASTER_SHADE_LIT_BIN_INL_HPP
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <rastrum/raster/shade/lit_seen-inl.hpp>
#include <rastrum/raster/surface/seen_bin-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

static_assert(SeenBin::kRoom % kLanes == 0);

/// Stores a group's triangles, from number `first` on, for look-up by pixels.
HWY_INLINE void put_group(const LitLanes& t, std::size_t first, bool normals, bool colors,
                          SeenBin& seen) {
  const F32 d;
  const auto at = [&](const float* v) HWY_ATTR { return hn::Load(d, v); };
  const auto put = [&](std::size_t q, F x, F y, F z, F w) HWY_ATTR {
    hn::StoreInterleaved4(x, y, z, w, d, seen.quads[q] + first * 4);
  };
  const F exact = hn::IfThenElseZero(mask_of(t.exact), set(1));
  const auto& n = t.normal;
  const auto& c = t.color;
  put(0, at(t.x0), at(t.y0), at(t.p1), at(t.q1));
  put(1, at(t.p2), at(t.q2), at(t.inv_w[0]), at(t.inv_w[1]));
  put(2, at(t.inv_w[2]), exact, at(n[0][0]), at(n[0][1]));
  if (normals) {
    put(3, at(n[0][2]), at(n[1][0]), at(n[1][1]), at(n[1][2]));
    put(4, at(n[2][0]), at(n[2][1]), at(n[2][2]), exact);
  }
  if (colors) {
    put(5, at(c[0][0]), at(c[0][1]), at(c[0][2]), at(c[1][0]));
    put(6, at(c[1][1]), at(c[1][2]), at(c[2][0]), at(c[2][1]));
    put(7, at(c[2][2]), exact, exact, exact);
  }
}

void see_bin(const LitShading& lit, const FrameGeometry& frame, const BinSurface& bin, int row,
             SeenBin& seen) noexcept {
  struct Group {
    LitSources from;
    LitLanes lanes;
  };
  const LitScene& scene = *lit.scene;
  const bool normals = row_of(lit.model).normal;
  const bool colors = row_of(lit.model).base && scene.colored;
  LitOfTriangle finder(scene, frame);
  set_up_bin<Group>(
      find_triangles(frame, bin, row, seen), seen, finder,
      [&](const std::uint64_t* low, std::size_t n, Group& group) HWY_ATTR {
        find_all_sources(finder, low, n, kLanes, normals, group.from, group.lanes);
        prefetch_sources(group.from, n, normals);
      },
      [&](std::size_t first, std::size_t /*n*/, Group& group) HWY_ATTR {
        fetch_triangles(group.from, kLanes, normals, group.lanes);
        put_group(group.lanes, first, normals, colors, seen);
      });
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_SHADE_LIT_BIN_INL_HPP
