// SPDX-License-Identifier: BSD-3-Clause
// The estimated cost of a frame of terrain, for Device::automatic (parallel/device_estimate.hpp).
#pragma once

#include <rastrum/parallel/device_estimate.hpp>
#include <rastrum/terrain.hpp>

namespace rastrum::terrain {

/// The bytes of a map's heights and colours; 0 for a function.
[[nodiscard]] std::uint64_t map_bytes(const Terrain& terrain);

/// Estimates a map in steady flight: the device keeps it, so a frame carries a small share of its
/// copy. `targets`: which images come back.
[[nodiscard]] FrameWork device_work(const Terrain& map, const TerrainOptions& options,
                                    const TerrainTargets& targets);

}  // namespace rastrum::terrain
