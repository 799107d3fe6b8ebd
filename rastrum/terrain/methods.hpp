// SPDX-License-Identifier: BSD-3-Clause
// All fill the targets' whole height for all columns.
#pragma once

#include <cstdint>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain/samples.hpp>

namespace rastrum::terrain {

struct Counts {
  std::uint64_t samples = 0, visible = 0;
  std::uint64_t slices = 0;  ///< on a device
};

/// The reference for the others.
Counts draw_reference(const Samples& samples, const TerrainTargets& targets);

struct BlockPool;

Counts draw_fast(parallel::Threads& exec, Isa isa, BlockPool& pool, const Samples& samples,
                 const TerrainTargets& targets);

/// The camera is lifted already. Positions must stay within 2^51 cells.
Counts draw_classic(parallel::Threads& exec, Isa isa, BlockPool& pool, const Terrain& terrain,
                    const Ceiling& ceiling, const TerrainOptions& options,
                    const TerrainCamera& camera, const TerrainTargets& targets);
/// The same in plain loops.
Counts draw_classic_reference(const Terrain& terrain, const TerrainOptions& options,
                              const TerrainCamera& camera, const TerrainTargets& targets);

}  // namespace rastrum::terrain
