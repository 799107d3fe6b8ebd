// The triangles of a bin whose triangles are small, compiled once per instruction set. The
// triangles that its pixels see are numbered in the order in which they are met, and set up kLanes
// at a time, a group. So each is set up once, in full lanes, and while a group is set up the
// vertices of the next one and the indices of those behind it come from memory. lit_simd.cpp then
// shades the blocks, whose pixels look their triangle up by its number.

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/shade/lit_bin_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstring>

#define RASTRUM_MOST_LANES 16  // a pixel or a triangle a lane
#include <rastrum/raster/shade/lit_seen-inl.hpp>
#include <rastrum/raster/shade/seen_bin-inl.hpp>
#include <rastrum/raster/shade/seen_bin.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2

static_assert(SeenBin::kRoom % kLanes == 0);

struct Group {
  LitSources from;
  LitLanes lanes;
};

/// Puts a group's triangles, from number `first` on, where pixels look them up.
HWY_INLINE void store(const LitLanes& t, std::size_t first, bool normals, bool colors,
                      SeenBin& own) {
  const F32 d;
  const auto at = [&](const float* v) HWY_ATTR { return hn::Load(d, v); };
  const auto put = [&](std::size_t q, F x, F y, F z, F w)
                       HWY_ATTR { hn::StoreInterleaved4(x, y, z, w, d, own.quads[q] + first * 4); };
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

void see(const LitShading& lit, const FrameGeometry& frame, const BinSurface& bin, int row,
         SeenBin& own) noexcept {
  const LitScene& scene = *lit.scene;
  const bool normals = row_of(lit.model).normal;
  const bool colors = row_of(lit.model).base && scene.colored;
  DrawOfTriangle of(scene, frame);
  set_up_bin<Group>(
      find_triangles(frame, bin, row, own), own, of,
      [&](const std::uint64_t* low, std::size_t n, Group& group) HWY_ATTR {
        find_all_sources(of, low, n, kLanes, normals, group.from, group.lanes);
        prefetch_sources(group.from, n, normals);
      },
      [&](std::size_t first, std::size_t /*n*/, Group& group) HWY_ATTR {
        fetch_triangles(group.from, kLanes, normals, group.lanes);
        store(group.lanes, first, normals, colors, own);
      });
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::raster {

namespace {

using SeeBin = void (*)(const LitShading&, const FrameGeometry&, const BinSurface&, int, SeenBin&);
constexpr SeeBin kSeeBin[] = RASTRUM_BY_ISA(see, nullptr);

}  // namespace

bool suits_lit_bin(Isa isa, const LitShading& lit, const BinSurface& bin) noexcept {
  const ShaderRow& row = row_of(lit.model);
  const bool interpolates = row.normal || (row.base && lit.scene->colored);
  return interpolates && kSeeBin[static_cast<std::size_t>(isa)] != nullptr && is_fine(bin);
}

void see_lit_bin(Isa isa, const LitShading& lit, const FrameGeometry& frame, const BinSurface& bin,
                 int row, SeenBin& own) noexcept {
  kSeeBin[static_cast<std::size_t>(isa)](lit, frame, bin, row, own);
}

}  // namespace rastrum::raster
#endif
