// What of a TerrainRenderer is not for its users: renderers that know one method more.
#pragma once

#include <cstdint>
#include <memory>

#include <rastrum/parallel/device_estimate.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain/methods.hpp>

namespace rastrum::terrain {

class DeviceRenderer;  // cuda/device.hpp

/// What draws frames of Method::words, with all that a renderer asks of a method.
struct AddedMethod {
  Counts (*on_serial)(parallel::Serial& exec, const Samples& samples,
                      const TerrainTargets& targets) = nullptr;
  Counts (*on_threads)(parallel::Threads& exec, const Samples& samples,
                       const TerrainTargets& targets) = nullptr;
  /// One that draws frames of every method. Throws Error{no_device}.
  std::unique_ptr<DeviceRenderer> (*make_device_renderer)() = nullptr;
  /// What it takes of a device's memory beyond what every frame takes.
  std::uint64_t (*device_bytes)(std::uint64_t slices) = nullptr;
  /// Makes of what a frame of Method::fast costs what this one does, for Device::automatic.
  void (*weigh)(FrameWork& work) = nullptr;
};

struct TerrainAccess {
  /// `added` must outlive the renderer; null: TerrainRenderer's constructor. Throws as that does.
  [[nodiscard]] static TerrainRenderer make(const TerrainRendererOptions& options,
                                            const AddedMethod* added);
};

}  // namespace rastrum::terrain
