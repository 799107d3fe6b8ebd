// SPDX-License-Identifier: BSD-3-Clause
// Targets::view_depth and Targets::distance of a block, from its keys alone. A key has the depth,
// so the surface need not be found again.
#pragma once

#include <cstdint>

#include <rastrum/device.hpp>

namespace rastrum::raster {

struct SurfaceScene;

/// Finds the distances of the 64 `keys` of the block at pixel (x0, y0), `nothing` where a key has
/// no depth. `view_depth` and `distance`: 64 numbers each, 64-byte aligned; `distance` may be null.
/// Float64, rounded once; the same bits on every instruction set.
using DistanceKernel = void (*)(const SurfaceScene& scene, const std::uint64_t* keys, int x0,
                                int y0, float nothing, float* view_depth, float* distance);

void distances_plain(const SurfaceScene& scene, const std::uint64_t* keys, int x0, int y0,
                     float nothing, float* view_depth, float* distance);

[[nodiscard]] DistanceKernel distance_kernel(Isa isa) noexcept;

}  // namespace rastrum::raster
