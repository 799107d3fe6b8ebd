// SPDX-License-Identifier: BSD-3-Clause
// Coordinates of a tiled map as runs of the map's own. The includer compiles it once per
// instruction set.
#if defined(RASTRUM_TERRAIN_SHADOW_RUNS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_TERRAIN_SHADOW_RUNS_INL_HPP
#undef RASTRUM_TERRAIN_SHADOW_RUNS_INL_HPP
#else
#define RASTRUM_TERRAIN_SHADOW_RUNS_INL_HPP
#endif

#include <algorithm>
#include <cstdint>

#include <hwy/highway.h>

#include <rastrum/terrain.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::terrain::HWY_NAMESPACE {
namespace {

/// Calls f(i, source, length, step) for the runs of coordinates [begin, begin + n). From i on they
/// are the axis's cells source, source + step, ….
template <class Run>
HWY_INLINE void for_each_run(std::int64_t begin, std::int64_t n, std::int64_t size, Tiling tiling,
                             const Run& f) {
  for (std::int64_t i = 0; i < n;) {
    const std::int64_t at = begin + i;
    const std::int64_t source = tiled(at, size, tiling);
    std::int64_t length = n - i, step = 1;
    if (tiling == Tiling::clamp && (at < 0 || at >= size)) {
      step = 0;
      if (at < 0) length = std::min(length, -at);
    } else if (tiling == Tiling::mirror && tiled(at, 2 * size, Tiling::repeat) >= size) {
      step = -1;
      length = std::min(length, source + 1);
    } else {
      length = std::min(length, size - source);
    }
    f(i, source, length, step);
    i += length;
  }
}

HWY_INLINE void copy_run(const float* from, std::int64_t n, std::int64_t step, float* to) {
  if (step == 1) {
    std::copy_n(from, n, to);
  } else {
    for (std::int64_t k = 0; k < n; ++k) to[k] = from[k * step];
  }
}

}  // namespace
}  // namespace rastrum::terrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#endif  // RASTRUM_TERRAIN_SHADOW_RUNS_INL_HPP
