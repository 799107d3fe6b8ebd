// SPDX-License-Identifier: BSD-3-Clause
// Finds the triangles that a block sees and sets up their weight planes, a triangle a lane.
#if defined(RASTRUM_RASTER_SURFACE_SEEN_PLANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_SURFACE_SEEN_PLANES_INL_HPP
#undef RASTRUM_RASTER_SURFACE_SEEN_PLANES_INL_HPP
#else
#define RASTRUM_RASTER_SURFACE_SEEN_PLANES_INL_HPP
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <hwy/highway.h>

#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/surface/seen_planes.hpp>
#include <rastrum/raster/surface/seen_triangles-inl.hpp>
#include <rastrum/raster/surface/weights-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

/// Sets the planes of the found triangles first to first + n, n ≤ kLanes.
HWY_INLINE void set_seen_planes(const FrameGeometry& frame, std::size_t first, std::size_t n,
                                SeenPlanes& seen) {
  const float* at[3][kLanes];
  alignas(16) float copy[3][kLanes][4];
  for (std::size_t i = 0; i < n || i % 4 != 0; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t k = first + std::min(i, n - 1);
      const ProjectedVertex* const all = frame.projected_of(*seen.draw[k]);
      at[c][i] =
          all != nullptr ? reinterpret_cast<const float*>(all + seen.vertex[k][c]) : copy[c][i];
      if (all != nullptr) continue;
      const ProjectedVertex v = frame.vertex(*seen.draw[k], seen.vertex[k][c]);
      std::memcpy(copy[c][i], &v, sizeof v);
    }
  const ProjectedCorners corner(at, n);
  set_planes(corner, seen.planes, first);
  const std::uint64_t all = (std::uint64_t{1} << n) - 1;
  for (std::uint64_t rest = corner.clipped() & all; rest != 0; rest &= rest - 1) {
    const std::size_t k = first + static_cast<std::size_t>(std::countr_zero(rest));
    seen.planes.set(k, weight_planes(frame, *seen.draw[k], seen.vertex[k]));
  }
}

/// SeenKernels::see. Each step has its own loop, so that cache misses of several triangles overlap.
HWY_INLINE void see_planes(const FrameGeometry& frame, const VisibleBlock& block, SeenPlanes& out) {
  if (out.frame != frame.number || frame.number == 0)
    find_anew(block.keys, block.covered, out);
  else if (find_places(block.keys, run_starts(block.keys, block.covered), out))
    return;
  out.frame = frame.number;
  const Draw* draw = nullptr;
  for (std::size_t k = 0; k < out.count; ++k) {
    const std::uint64_t id = kIdMask - out.low[k];
    if (draw == nullptr || id - draw->first_id >= draw->primitive_count) draw = &frame.draw_of(id);
    out.draw[k] = draw;
    out.part[k] = draw->of_copy(id - draw->first_id);
    if (draw->mesh == nullptr && !draw->is_copied() && !draw->indices.empty())
      __builtin_prefetch(draw->indices.data() + out.part[k].primitive * 3);
  }
  for (std::size_t k = 0; k < out.count; ++k) {
    draw = out.draw[k];
    draw->vertices(kIdMask - out.low[k] - draw->first_id, out.vertex[k]);
    if (const ProjectedVertex* const all = frame.projected_of(*draw))
      for (const std::uint32_t v : out.vertex[k]) __builtin_prefetch(all + v);
  }
  for (std::size_t first = 0; first < out.count; first += kLanes)
    set_seen_planes(frame, first, std::min(kLanes, out.count - first), out);
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_SURFACE_SEEN_PLANES_INL_HPP
