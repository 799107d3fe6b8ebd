// SPDX-License-Identifier: BSD-3-Clause
// Named functions on a device (function_values.hpp). Their heights have no known bound, so no slice
// is skipped.
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/terrain/cuda/fast.cuh>
#include <rastrum/terrain/cuda/map.cuh>
#include <rastrum/terrain/cuda/method.cuh>
#include <rastrum/terrain/function_light.hpp>

namespace rastrum::terrain {

/// As MapSamples.
struct FunctionSamples {
  SetupView setup;
  FunctionView function;

  [[nodiscard]] RASTRUM_HD float height(std::size_t column, const Slice& slice) const {
    return function.height(x(column, slice), y(column, slice));
  }
  [[nodiscard]] RASTRUM_HD Rgba8 color(std::size_t column, const Slice& slice) const {
    return faded(function.color(x(column, slice), y(column, slice)), setup.fog, slice.clear);
  }

 private:
  [[nodiscard]] RASTRUM_HD double x(std::size_t column, const Slice& slice) const {
    return setup.camera_x + static_cast<double>(setup.offset_x(column, slice));
  }
  [[nodiscard]] RASTRUM_HD double y(std::size_t column, const Slice& slice) const {
    return setup.camera_y + static_cast<double>(setup.offset_y(column, slice));
  }
};

/// As PlanarWalk.
struct FunctionWalk : SamplesWalk<FunctionSamples> {
  [[nodiscard]] RASTRUM_HD std::int32_t lowest_row(std::size_t, std::size_t, std::size_t,
                                                   std::size_t) const {
    return 0;
  }
};

/// As the draw_frame of a map (draw.cuh). The steps of `function` lie in the host's memory.
[[nodiscard]] inline Counts draw_frame(parallel::Cuda& exec, const FunctionView& function,
                                       const TerrainOptions& options, const TerrainCamera& camera,
                                       const TerrainTargets& targets,
                                       const MethodOnDevice* words = nullptr) {
  const Setup setup = set_up(options, camera, Extent{});
  const DeviceSetup on_device(exec, setup);
  const auto steps = parallel::upload(exec, function.steps);
  const FunctionSamples samples{on_device.view(),
                                {function.function, function.light, {steps.data(), steps.size()}}};
  Counts counts = options.added != nullptr ? words->of_function(exec, samples, targets)
                                           : draw_by_teams(exec, FunctionWalk{{samples}}, targets);
  counts.slices = setup.slices.size();
  return counts;
}

}  // namespace rastrum::terrain
