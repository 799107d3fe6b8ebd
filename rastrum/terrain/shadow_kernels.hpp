// SPDX-License-Identifier: BSD-3-Clause
// The SIMD kernels of shadows, a table per instruction set. Null means the scalar code of
// shadows.cpp.
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

/// A sample's cell and the ray's climb there, both from where the ray begins.
struct MarchSample {
  std::int32_t dx = 0, dy = 0;
  float climb = 0;
};
/// Throws Error{invalid_argument} for a sun or march out of range.
[[nodiscard]] std::vector<MarchSample> march_samples(const Sun& sun, const March& march);

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
  /// Hidden samples of the cells of row y.
  void (*march_row)(const ShadowCaster& map, const std::vector<MarchSample>& samples, int y,
                    std::uint16_t* counts) noexcept = nullptr;
  /// Ranges of a row of tiles, `rows` <= HeightTiles::kEdge rows of `width` heights. Returns
  /// whether all heights are finite. If not, the ranges hold only if every other height is -inf.
  bool (*tile_ranges)(const float* heights, std::ptrdiff_t stride, int rows, std::size_t width,
                      float* lowest, float* highest) noexcept = nullptr;
};

[[nodiscard]] const ShadowKernels& shadow_kernels(Isa isa) noexcept;

using SweepKernel = void (*)(const Sweep& sweep, int first, int last,
                             ImageView<std::uint8_t> shadow);
/// Null where the plain definition is used.
[[nodiscard]] SweepKernel sweep_kernel(Isa isa) noexcept;

}  // namespace rastrum::terrain
