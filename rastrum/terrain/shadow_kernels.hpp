// SPDX-License-Identifier: BSD-3-Clause
// The SIMD leaves of shadows, one table per instruction set; null members where the scalar code of
// shadows.cpp is the way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <rastrum/terrain/shadow_ray.hpp>
#include <rastrum/terrain/shadow_reach.hpp>
#include <rastrum/terrain/shadow_sweep.hpp>

namespace rastrum::terrain {

/// A sample of the march: its cell from the one where the ray begins, and the climb until there.
struct MarchSample {
  std::int32_t dx = 0, dy = 0;
  float climb = 0;
};
/// Throws Error{invalid_argument} for a sun or march out of range.
[[nodiscard]] std::vector<MarchSample> march_samples(const Sun& sun, const March& march);

/// hidden_samples of one cell.
[[nodiscard]] RASTRUM_HD inline std::uint16_t hidden_count(const ShadowCaster& map,
                                                           std::span<const MarchSample> samples,
                                                           int x, int y) {
  const float own = map.heights(x, y);
  if (own == -std::numeric_limits<float>::infinity()) return 0;
  int n = 0;
  for (const MarchSample& s : samples) n += own + s.climb < map.at(x + s.dx, y + s.dy) ? 1 : 0;
  return static_cast<std::uint16_t>(n);
}

struct ShadowKernels {
  /// Counts of hidden samples of row y.
  void (*march_row)(const ShadowCaster& map, const std::vector<MarchSample>& samples, int y,
                    std::uint16_t* counts) noexcept = nullptr;
  /// Ranges of a row of tiles: of `rows` <= HeightTiles::kEdge rows of `width` heights, `stride`
  /// apart. True where all are finite; the ranges hold only then, or where what is not is -inf.
  bool (*tile_ranges)(const float* heights, std::ptrdiff_t stride, int rows, std::size_t width,
                      float* lowest, float* highest) noexcept = nullptr;
};

[[nodiscard]] const ShadowKernels& shadow_kernels(Isa isa) noexcept;

/// sharp_shadows for the bands [first, last) of a sweep.
using SweepKernel = void (*)(const Sweep& sweep, int first, int last,
                             ImageView<std::uint8_t> shadow);
/// Null where the plain definition is the way.
[[nodiscard]] SweepKernel sweep_kernel(Isa isa) noexcept;

}  // namespace rastrum::terrain
