// The ways to a picture. All fill the targets' whole height for all columns.
#pragma once

#include <cstdint>

#include <rastrum/terrain/options.hpp>
#include <rastrum/terrain/samples.hpp>

namespace rastrum::terrain {

struct Counts {
  std::uint64_t samples = 0, visible = 0;
};

/// Column by column, span by span: the reference of the others.
Counts draw_reference(const Samples& samples, const TerrainTargets& targets);

/// Macke's program in float64, camera lifted before.
Counts draw_classic_reference(const Terrain& terrain, const TerrainOptions& options,
                              const TerrainCamera& camera, const TerrainTargets& targets);

}  // namespace rastrum::terrain
