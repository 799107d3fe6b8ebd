// SPDX-License-Identifier: BSD-3-Clause
// A frame of a terrain on a CUDA device for callers whose map and picture lie there. Only the
// columns' directions and the slices' distances are copied, some 20 KiB. TerrainRenderer calls the
// same (renderer.cu).
#pragma once

#include <rastrum/terrain/cuda/classic.cuh>
#include <rastrum/terrain/cuda/fast.cuh>
#include <rastrum/terrain/cuda/map.cuh>
#include <rastrum/terrain/cuda/method.cuh>
#include <rastrum/terrain/setup.hpp>

namespace rastrum::terrain {

/// Fills `targets`, device memory of the options' size, with the bits of TerrainRenderer on any
/// device. Draws the camera where it stands: without roll, and not lifted above the ground.
/// Requires checked options and camera, and the pyramid if the filter is mip. `words` draws frames
/// with TerrainOptions::added, and may be null for others. Waits. Cost: as TerrainRenderer::render.
/// Throws Error{invalid_argument}, Error{out_of_memory}, Error{no_device}, Error{unsupported}.
[[nodiscard]] inline Counts draw_frame(parallel::Cuda& exec, const DeviceMap& map,
                                       const TerrainOptions& options, const TerrainCamera& camera,
                                       const TerrainTargets& targets,
                                       const MethodOnDevice* words = nullptr) {
  if (options.classic) return draw_classic(exec, map, options, camera, targets);
  const Setup setup = set_up(options, camera, map.extent());
  const DeviceSetup on_device(exec, setup);
  const MapSamples samples{on_device.view(), MapView(map.levels(), options, setup)};
  Counts counts = options.added != nullptr
                      ? words->of_map(exec, samples, targets)
                      : draw_by_teams(exec, PlanarWalk{{samples}, map.ceiling()}, targets);
  counts.slices = setup.slices.size();
  return counts;
}

}  // namespace rastrum::terrain
