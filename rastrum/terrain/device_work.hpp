// SPDX-License-Identifier: BSD-3-Clause
// The estimated cost of a frame of terrain, for Device::automatic (parallel/device_estimate.hpp).
#pragma once

#include <rastrum/parallel/device_estimate.hpp>
#include <rastrum/terrain.hpp>

namespace rastrum::terrain {

/// Heights and colours; 0 for a function.
[[nodiscard]] std::uint64_t map_bytes(const Terrain& terrain);

/// The device keeps the map, so a frame of a steady flight pays a small share of its copy.
[[nodiscard]] FrameWork device_work(const Terrain& map, const TerrainOptions& options,
                                    const TerrainTargets& targets);

}  // namespace rastrum::terrain
