// What the terrain's host code asks of a CUDA device, without a header of CUDA. renderer.cu has it;
// none.cpp where there is no compiler for it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include <rastrum/terrain/methods.hpp>
#include <rastrum/terrain/shadows.hpp>
#include <rastrum/terrain/terrain.hpp>

namespace rastrum::terrain {

/// Draws on the current device; keeps the map that was drawn last there, and its memory.
class DeviceRenderer {
 public:
  virtual ~DeviceRenderer() = default;
  /// Fills `targets`, memory of the host, with a frame of a map without roll. Calls `lap` with the
  /// name of each stage that is done. Throws Error{out_of_memory}, Error{no_device}.
  virtual Counts draw(const Terrain& map, const TerrainOptions& options,
                      const TerrainCamera& camera, const TerrainTargets& targets,
                      const std::function<void(const char* stage)>& lap) = 0;
  /// Of the device's memory.
  [[nodiscard]] virtual std::uint64_t bytes() const = 0;
};

[[nodiscard]] std::unique_ptr<DeviceRenderer> make_device_renderer();

/// The most of a device's memory that draw() takes for such frames.
[[nodiscard]] std::uint64_t device_bytes(const Terrain& map, const TerrainOptions& options);

/// sharp_shadows and hidden_samples of a map on the host; the same bits.
[[nodiscard]] Image<std::uint8_t> sharp_shadows_on_device(ImageView<const float> heights,
                                                          const Sun& sun, Tiling tiling);
[[nodiscard]] Image<std::uint16_t> hidden_samples_on_device(ImageView<const float> heights,
                                                            const Sun& sun, const March& march,
                                                            Tiling tiling);

}  // namespace rastrum::terrain
