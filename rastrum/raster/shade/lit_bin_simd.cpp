// The triangles of a bin whose triangles are small, compiled once per instruction set. Those that
// its pixels see are numbered in the order in which they are met, and set up kLanes at a time, a
// group. So each is set up once, in full lanes, and while a group is set up the vertices of the
// next one and the indices of those behind it come from memory. lit_simd.cpp shades the blocks
// then, whose pixels look their triangle up by its number.

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/shade/lit_bin_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include <rastrum/raster/shade/interpolate.hpp>
#include <rastrum/raster/shade/light_set.hpp>
#include <rastrum/raster/shade/lit_bin.hpp>
#include <rastrum/raster/shade/lit_constants.hpp>
#include <rastrum/raster/shade/lit_lanes-inl.hpp>
#include <rastrum/raster/shade/lit_triangle.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster {
namespace HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2
namespace hn = hwy::HWY_NAMESPACE;

using F32 = hn::CappedTag<float, RASTRUM_LIT_LANES>;
using I32 = hn::RebindToSigned<F32>;
using F = hn::Vec<F32>;
using I = hn::Vec<I32>;
constexpr std::size_t kLanes = RASTRUM_LIT_LANES;
static_assert(LitBin::kRoom % kLanes == 0);

#include <rastrum/raster/kernels/lane_math-inl.hpp>

#include <rastrum/raster/kernels/lookups-inl.hpp>
#include <rastrum/raster/shade/lights-inl.hpp>

#include <rastrum/raster/shade/lit_light-inl.hpp>  // after the lights

#include <rastrum/raster/shade/seen_triangles-inl.hpp>

#include <rastrum/raster/shade/lit_seen-inl.hpp>  // after the triangles
#undef RASTRUM_LANES

/// Groups of triangles whose indices are asked for before they are read.
constexpr std::size_t kAhead = 3;

HWY_INLINE std::uint64_t covered_of(const std::uint64_t* keys) {
  const hn::CappedTag<std::uint64_t, 8> d;
  constexpr std::size_t kStep = hn::MaxLanes(hn::CappedTag<std::uint64_t, 8>());
  std::uint64_t empty = 0;
  for (std::size_t i = 0; i < 64; i += kStep) {
    std::uint8_t bits = 0;
    hn::StoreMaskBits(d, hn::Eq(hn::Load(d, keys + i), hn::Zero(d)), &bits);
    empty |= (std::uint64_t{bits} & ((1U << kStep) - 1)) << i;
  }
  return ~empty;
}

/// Numbers the triangles that rows of blocks see from `row` on, as many as there is room for, and
/// sets places and end_row. Returns how many there are.
HWY_INLINE std::size_t find_triangles(const FrameGeometry& frame, const BinSurface& bin, int row,
                                      LitBin& own) {
  std::memset(own.table, 0, sizeof own.table);
  const hn::CappedTag<std::uint16_t, 8> d;
  std::uint64_t count = 0;
  const Rect image{0, 0, frame.width, frame.height};
  for (; row < block_rows(bin.rect) && count + LitBin::kOfRow <= LitBin::kRoom; ++row)
    for (int column = 0; column < block_columns(bin.rect); ++column) {
      const std::uint64_t* const keys = bin.block(column, row);
      std::uint64_t covered = covered_of(keys);
      const int bx = bin.rect.x0 / kBlockSize + column, by = bin.rect.y0 / kBlockSize + row;
      if ((bx + 1) * kBlockSize > image.x1 || (by + 1) * kBlockSize > image.y1)
        covered &= samples_inside(image, bx, by);
      std::uint16_t* const place = own.places_of(bx * kBlockSize, by * kBlockSize);
      std::uint64_t starts = SeenTriangles::run_starts(keys, covered);
      for (; starts != 0; starts &= starts - 1) {
        const int i = std::countr_zero(starts);
        const std::uint64_t low = keys[i] & kIdMask;
        std::uint64_t& entry = own.table[low % std::size(own.table)];
        // Without a branch, which nobody could predict, and of which compilers make one of `?:`. A
        // triangle may be there twice: what the table forgets costs only time. That it holds the
        // low part too spares a load of what was stored just before.
        const std::uint64_t next = low << 16 | count;
        const std::uint64_t is_new = entry >> 16 != low ? 1 : 0;
        const std::uint64_t known = entry ^ ((entry ^ next) & (0U - is_new));
        own.low[count] = low;
        count += is_new;
        entry = known;
        hn::StoreU(hn::Set(d, static_cast<std::uint16_t>(known)), d, place + i);
      }
    }
  own.end_row = row;
  return count;
}

struct Group {
  LitSources from;
  LitLanes lanes;
};

/// Puts a group's triangles, from number `first` on, where pixels look them up.
HWY_INLINE void store(const LitLanes& t, std::size_t first, bool normals, bool colors,
                      LitBin& own) {
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
         LitBin& own) noexcept {
  const LitScene& scene = *lit.scene;
  const bool normals = lit.model != LitModel::flat;
  const bool colors = lit.model != LitModel::normal && scene.colored;
  const std::size_t count = find_triangles(frame, bin, row, own);
  const std::size_t group_count = (count + kLanes - 1) / kLanes;
  const auto triangles_of = [&](std::size_t g)
                                HWY_ATTR { return std::min(kLanes, count - g * kLanes); };
  Group groups[2];
  DrawOfTriangle of(scene, frame);
  const auto prefetch = [&](std::size_t g) HWY_ATTR {
    if (g >= group_count) return;
    const std::size_t n = triangles_of(g);
    for (std::size_t i = 0; i < n; ++i) of.prefetch(own.low[g * kLanes + i]);
  };
  const auto find_sources = [&](std::size_t g) HWY_ATTR {
    if (g >= group_count) return;
    Group& group = groups[g % 2];
    const std::size_t n = triangles_of(g);
    find_all_sources(of, own.low + g * kLanes, n, kLanes, normals, group.from, group.lanes);
    prefetch_sources(group.from, n, normals);
  };
  for (std::size_t g = 0; g < kAhead; ++g) prefetch(g);
  find_sources(0);
  for (std::size_t g = 0; g < group_count; ++g) {
    prefetch(g + kAhead);
    find_sources(g + 1);
    Group& group = groups[g % 2];
    fetch_triangles(group.from, kLanes, normals, group.lanes);
    store(group.lanes, g * kLanes, normals, colors, own);
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

namespace {

bool are_different(std::uint64_t a, std::uint64_t b) {
  return ((a ^ b) & kIdMask) != 0;
}

/// Whether triangles are so small that a block sees many: then two pixels of it that lie apart
/// mostly see two.
bool is_fine(const BinSurface& bin) {
  int pairs = 0, differ = 0;
  for (int row = 0; row < block_rows(bin.rect); ++row)
    for (int column = 0; column < block_columns(bin.rect); ++column) {
      const std::uint64_t* const keys = bin.block(column, row);
      const std::uint64_t a = keys[8 * 1 + 1], b = keys[8 * 6 + 6];
      if (a == 0 || b == 0) continue;
      ++pairs;
      differ += are_different(a, b) ? 1 : 0;
    }
  return differ >= 4 && differ * 4 >= pairs * 3;
}

using SeeBin = void (*)(const LitShading&, const FrameGeometry&, const BinSurface&, int, LitBin&);
constexpr SeeBin kSeeBin[] = RASTRUM_BY_ISA(see, nullptr);

}  // namespace

bool suits_lit_bin(Isa isa, const LitShading& lit, const BinSurface& bin) noexcept {
  const bool interpolates = lit.model == LitModel::normal || lit.model == LitModel::lambert ||
                            lit.model == LitModel::phong ||
                            (lit.model == LitModel::flat && lit.scene->colored);
  return interpolates && kSeeBin[static_cast<std::size_t>(isa)] != nullptr && is_fine(bin);
}

void see_lit_bin(Isa isa, const LitShading& lit, const FrameGeometry& frame, const BinSurface& bin,
                 int row, LitBin& own) noexcept {
  kSeeBin[static_cast<std::size_t>(isa)](lit, frame, bin, row, own);
}

}  // namespace rastrum::raster
#endif
