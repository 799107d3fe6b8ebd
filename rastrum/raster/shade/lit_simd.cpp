// SPDX-License-Identifier: BSD-3-Clause
// The lit shaders in lanes, compiled once per instruction set. A block's normals and colours are
// interpolated (lit_interpolate-inl.hpp) and then lit, kLanes at a time. A pixel's bits do not
// depend on its neighbours. The arithmetic is lit_light.inl, as in the scalar form.

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/shade/lit_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>

#define RASTRUM_MOST_LANES 16  // a pixel or a triangle a lane
#include <rastrum/raster/kernels/pair_math-inl.hpp>
#include <rastrum/raster/shade/lit_bin-inl.hpp>
#include <rastrum/raster/shade/lit_interpolate-inl.hpp>
#include <rastrum/raster/shade/lit_kernels.hpp>
#include <rastrum/raster/shade/lit_runs-inl.hpp>
#include <rastrum/raster/shade/wire-inl.hpp>
#include <rastrum/raster/surface/seen_bin.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2

namespace pairs {
#define RASTRUM_LANES HWY_INLINE
#include <rastrum/raster/shade/lit_fixed.inl>
#undef RASTRUM_LANES
}  // namespace pairs

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
#if RASTRUM_LANE_COUNT == 16
    const hn::Half<hn::RebindToUnsigned<F32>> row;
    hn::StoreU(hn::LowerHalf(row, pixels), row, at);
    hn::StoreU(hn::UpperHalf(row, pixels), row, at + to.stride);
#else
    hn::StoreU(pixels, d, at);
#endif
  }
};

/// Lights pixels [first, first + 2 kLanes) by the fixed light, two vectors side by side; `along`:
/// along_column of the centres.
template <Shader kModel, class Put>
HWY_INLINE void light_pair(const ViewRays& rays, const V3& along, const VisibleBlock& block,
                           const LitBlock& surface, bool colored, std::size_t first,
                           const Put& put) {
  constexpr std::uint64_t kAll = (std::uint64_t{1} << kLanes) - 1;
  const auto both = [&](const float(&from)[3][64]) HWY_ATTR {
    const V3 a = load(from, first), b = load(from, first + kLanes);
    return pairs::V3{{a.x, b.x}, {a.y, b.y}, {a.z, b.z}};
  };
  const pairs::V3 base = colored ? both(surface.base) : pairs::set(kDefaultBase);
  const pairs::V3 n = row_of(kModel).normal ? both(surface.n) : base;
  const Points a(block, first), b(block, first + kLanes);
  const pairs::V3 columns =
      block.points == nullptr ? pairs::twice(along) : pairs::along_column(rays, {a.px, b.px});
  const pairs::V3 c = pairs::light(kModel, pairs::to_viewer(columns, rays, {a.py, b.py}), n, base);
  put(first, block.covered >> first & kAll, {c.x.a, c.y.a, c.z.a});
  put(first + kLanes, block.covered >> (first + kLanes) & kAll, {c.x.b, c.y.b, c.z.b});
}

/// Lights `surface` by the fixed light or by `lights`. Without `colored` it has the default base
/// colour.
template <Shader kModel, bool kFixed, class Put>
HWY_NOINLINE void light_rows(const ViewRays& rays, const LightSet* lights,
                             const VisibleBlock& block, const LitBlock& surface, bool colored,
                             const Put& put) {
  constexpr std::uint64_t kAll = (std::uint64_t{1} << kLanes) - 1;
  // Two vectors need some thirty registers.
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
    const V3 n = row_of(kModel).normal ? load(surface.n, first) : base;
    const Points at(block, first);
    V3 color;
    if constexpr (kFixed)
      color = light(kModel, rays, at.px, at.py, n, base);
    else
      color = light_by(*lights, kModel, rays, at.px, at.py, depths(block.keys + first), n, base);
    put(first, covered, color);
  }
}

template <Shader kModel, class Put>
HWY_INLINE void light_block(const ViewRays& rays, const LightSet* lights, const VisibleBlock& block,
                            const LitBlock& surface, bool colored, const Put& put) {
  constexpr bool kLit = row_of(kModel).lights;
  if (kLit && lights != nullptr)
    light_rows<kModel, !kLit>(rays, lights, block, surface, colored, put);
  else
    light_rows<kModel, true>(rays, nullptr, block, surface, colored, put);
}

/// Two loops: lighting is one long chain of square roots and divisions, and the processor overlaps
/// several chains only where little else is between them. `own_base`: `surface` has the base
/// colours.
template <Shader kModel, class Put>
HWY_INLINE void shade_block(const LitScene& scene, const FrameGeometry& frame,
                            const VisibleBlock& block, LitBlock& surface, bool own_base,
                            const Put& put) {
  constexpr bool kNormals = row_of(kModel).normal;
  const bool colored = !own_base && row_of(kModel).base && scene.colored;
  if (kNormals || colored) interpolate(scene, frame, block, kNormals, colored, false, surface);
  light_block<kModel>(scene.rays, scene.lights, block, surface, own_base || colored, put);
}

void shade(const LitShading& lit, const FrameGeometry& frame, const VisibleBlock& block,
           BlockColors& colors) noexcept {
  if (lit.model == Shader::id) return shade_ids(block, colors);
  if (lit.model == Shader::wireframe) return shade_wires(*lit.scene, frame, block, colors);
  with_light(lit.model, [&](auto m) HWY_ATTR {
    LitBlock local;
    LitBlock& surface = block.lit != nullptr ? *block.lit : local;
    shade_block<decltype(m)::value>(*lit.scene, frame, block, surface, false, ToBlock{colors});
    if (row_of(lit.model).normal) surface.normals = block.covered;
  });
}

void store_pixels(const LitShading& lit, const FrameGeometry& frame, const VisibleBlock& block,
                  Rgba8 empty, BlockPixels to) noexcept {
  with_light(lit.model, [&](auto m) HWY_ATTR {
    LitBlock surface;
    shade_block<decltype(m)::value>(*lit.scene, frame, block, surface, false, ToPixels{to, empty});
  });
}

void shade_base(const LitShading& lit, const FrameGeometry& frame, const VisibleBlock& block,
                LitBlock& surface, BlockColors& colors) noexcept {
  with_light(lit.model, [&](auto m) HWY_ATTR {
    shade_block<decltype(m)::value>(*lit.scene, frame, block, surface, true, ToBlock{colors});
  });
}

void light_surface(Shader model, const ViewRays& rays, const LightSet* lights,
                   const VisibleBlock& block, const LitBlock& surface,
                   BlockColors& colors) noexcept {
  with_light(model, [&](auto m) HWY_ATTR {
    light_block<decltype(m)::value>(rays, lights, block, surface, true, ToBlock{colors});
  });
}

void seen_normals(const LitScene& scene, const FrameGeometry& frame, const VisibleBlock& block,
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
}

void shade_runs(const LitShading& lit, const FrameGeometry& frame, const FragmentRuns& runs,
                float alpha, Vec4* colors) noexcept {
  with_light(lit.model, [&](auto m) HWY_ATTR {
    shade_runs_of<decltype(m)::value>(*lit.scene, frame, runs, alpha, colors);
  });
}

constexpr LitKernels kTable{shade,        store_pixels, shade_base, light_surface,
                            seen_normals, shade_runs,   see_bin};

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::raster {

const LitKernels* lit_kernels(Isa isa) noexcept {
  static constexpr const LitKernels* kTables[] = RASTRUM_BY_ISA(kTable, nullptr);
  return kTables[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::raster
#endif
