// SPDX-License-Identifier: BSD-3-Clause
// A method that another library adds. A frame names it by TerrainOptions::added.
#pragma once

#include <cstdint>
#include <memory>

#include <rastrum/parallel/device_estimate.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain/methods.hpp>

namespace rastrum::terrain {

class DeviceRenderer;  // cuda/device.hpp

/// Everything that a renderer needs of such a method.
struct AddedMethod {
  Counts (*on_serial)(parallel::Serial& exec, const Samples& samples,
                      const TerrainTargets& targets) = nullptr;
  Counts (*on_threads)(parallel::Threads& exec, const Samples& samples,
                       const TerrainTargets& targets) = nullptr;
  /// Its renderer draws frames of every method. Throws Error{no_device}.
  std::unique_ptr<DeviceRenderer> (*make_device_renderer)() = nullptr;
  /// Device memory in bytes beyond what every frame takes.
  std::uint64_t (*device_bytes)(std::uint64_t slices) = nullptr;
  /// For Device::automatic: turns the estimated cost of Rastrum's own method into this one's.
  void (*weigh)(FrameWork& work) = nullptr;
};

}  // namespace rastrum::terrain
