// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/terrain/cuda/device.hpp>

#include <rastrum/parallel/cuda/library.hpp>

namespace rastrum::terrain {
namespace {

const CudaTerrain& device() {
  return *parallel::cuda_library().terrain;
}

}  // namespace

std::unique_ptr<DeviceRenderer> make_device_renderer() {
  return device().make_renderer();
}

Image<std::uint8_t> sharp_shadows_on_device(ImageView<const float> heights, const Sun& sun,
                                            Tiling tiling) {
  return device().sharp_shadows(heights, sun, tiling, StopScope::current());
}

Image<std::uint8_t> light_of_suns_on_device(ImageView<const float> heights,
                                            std::span<const Sun> suns, Tiling tiling) {
  return device().light_of_suns(heights, suns, tiling, StopScope::current());
}

Image<std::uint16_t> hidden_samples_on_device(ImageView<const float> heights, const Sun& sun,
                                              const March& march, Tiling tiling) {
  return device().hidden_samples(heights, sun, march, tiling, StopScope::current());
}

}  // namespace rastrum::terrain
