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

/// The functions that draw such frames, and all else that a renderer needs of a method.
struct AddedMethod {
  Counts (*on_serial)(parallel::Serial& exec, const Samples& samples,
                      const TerrainTargets& targets) = nullptr;
  Counts (*on_threads)(parallel::Threads& exec, const Samples& samples,
                       const TerrainTargets& targets) = nullptr;
  /// A renderer that draws frames of every method. Throws Error{no_device}.
  std::unique_ptr<DeviceRenderer> (*make_device_renderer)() = nullptr;
  /// Bytes of a device's memory that it takes beyond those of every frame.
  std::uint64_t (*device_bytes)(std::uint64_t slices) = nullptr;
  /// Turns the estimated cost of a frame of Rastrum's own method into that of this one, for
  /// Device::automatic.
  void (*weigh)(FrameWork& work) = nullptr;
};

}  // namespace rastrum::terrain
