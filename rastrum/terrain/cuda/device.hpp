// SPDX-License-Identifier: BSD-3-Clause
// The CUDA functions that the terrain's host code calls, without a CUDA header, from the library of
// device code (parallel/cuda/library.hpp).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include <rastrum/stop.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain/methods.hpp>
#include <rastrum/terrain/roll.hpp>
#include <rastrum/terrain_light.hpp>

namespace rastrum::terrain {

/// Keeps the last map on the device, and its memory.
class DeviceRenderer {
 public:
  virtual ~DeviceRenderer() = default;
  /// Fills `targets`, in host memory, with a frame of a terrain for which why_not_on_device is
  /// empty. `roll` (may be null) rotates the upright picture that options and camera describe.
  /// Calls `lap` with each finished stage. Throws Error{out_of_memory}, Error{no_device}.
  Counts draw(const Terrain& terrain, const TerrainOptions& options, const TerrainCamera& camera,
              const Roll* roll, const TerrainTargets& targets,
              const std::function<void(const char* stage)>& lap) {
    return draw(terrain, options, camera, roll, targets, lap, StopScope::current());
  }
  /// Device memory that it holds.
  [[nodiscard]] virtual std::uint64_t bytes() const = 0;

 private:
  /// `stop`: the caller's scope, which another library cannot see.
  virtual Counts draw(const Terrain& terrain, const TerrainOptions& options,
                      const TerrainCamera& camera, const Roll* roll, const TerrainTargets& targets,
                      const std::function<void(const char* stage)>& lap, const StopToken* stop) = 0;
};

/// `stop` as in DeviceRenderer.
struct CudaTerrain {
  std::unique_ptr<DeviceRenderer> (*make_renderer)();
  Image<std::uint8_t> (*sharp_shadows)(ImageView<const float>, const Sun&, Tiling,
                                       const StopToken* stop);
  Image<std::uint8_t> (*light_of_suns)(ImageView<const float>, std::span<const Sun>, Tiling,
                                       const StopToken* stop);
  Image<std::uint16_t> (*hidden_samples)(ImageView<const float>, const Sun&, const March&, Tiling,
                                         const StopToken* stop);
};
extern const CudaTerrain kCudaTerrain;  ///< in that library
struct MethodOnDevice;                  // method.cuh
/// In renderer.cu. `words` may be null; else it must outlive the renderer.
[[nodiscard]] std::unique_ptr<DeviceRenderer> make_cuda_renderer(const MethodOnDevice* words);

/// Throws Error{no_device}.
[[nodiscard]] std::unique_ptr<DeviceRenderer> make_device_renderer();

/// Empty if a device draws such a terrain: a map, or a named function under its light.
[[nodiscard]] std::string why_not_on_device(const Terrain& terrain, const TerrainOptions& options);

/// The most device memory that draw() takes, rolled or not. An added method needs more.
[[nodiscard]] std::uint64_t device_bytes(const Terrain& terrain, const TerrainOptions& options);

/// For a map on the host; the same bits. Throws Error{no_device}.
[[nodiscard]] Image<std::uint8_t> sharp_shadows_on_device(ImageView<const float> heights,
                                                          const Sun& sun, Tiling tiling);
/// soft_light with these points of the sun's disc, fewer than 256.
[[nodiscard]] Image<std::uint8_t> light_of_suns_on_device(ImageView<const float> heights,
                                                          std::span<const Sun> suns, Tiling tiling);
[[nodiscard]] Image<std::uint16_t> hidden_samples_on_device(ImageView<const float> heights,
                                                            const Sun& sun, const March& march,
                                                            Tiling tiling);

}  // namespace rastrum::terrain
