// SPDX-License-Identifier: BSD-3-Clause
// The terrain functions of the library of device code.
#include <rastrum/terrain/cuda/device.hpp>
#include <rastrum/terrain/cuda/shadows.cuh>

namespace rastrum::terrain {
namespace {

template <class T, class F>
Image<T> computed(parallel::Cuda& exec, ImageView<const float> heights, const F& compute) {
  const auto width = static_cast<std::size_t>(heights.width);
  auto cells = parallel::make_buffer<float>(exec, width * static_cast<std::size_t>(heights.height));
  for (int y = 0; y < heights.height; ++y)
    parallel::cuda_system::copy(exec.stream(), cells.data() + static_cast<std::size_t>(y) * width,
                                heights.row(y), width * sizeof(float));
  const parallel::DeviceBuffer<T> result = compute(
      exec, ImageView<const float>{cells.data(), heights.width, heights.height, heights.width});
  Image<T> out(heights.width, heights.height);
  parallel::cuda_system::copy(exec.stream(), out.pixels().data(), result.data(),
                              result.size() * sizeof(T));
  exec.wait();
  return out;
}
template <class T, class F>
Image<T> on_device(ImageView<const float> heights, const StopToken* stop, const F& compute) {
  const StopScope scope(stop);
  parallel::Cuda exec;
  return parallel::on_device_of(exec, [&] { return computed<T>(exec, heights, compute); });
}

Image<std::uint8_t> sharp(ImageView<const float> heights, const Sun& sun, Tiling tiling,
                          const StopToken* stop) {
  return on_device<std::uint8_t>(heights, stop,
                                 [&](parallel::Cuda& exec, const ImageView<const float>& map) {
                                   return sharp_shadows(exec, map, sun, tiling);
                                 });
}

Image<std::uint8_t> of_suns(ImageView<const float> heights, std::span<const Sun> suns,
                            Tiling tiling, const StopToken* stop) {
  return on_device<std::uint8_t>(heights, stop,
                                 [&](parallel::Cuda& exec, const ImageView<const float>& map) {
                                   return light_of_suns(exec, map, suns, tiling);
                                 });
}

Image<std::uint16_t> marched(ImageView<const float> heights, const Sun& sun, const March& march,
                             Tiling tiling, const StopToken* stop) {
  return on_device<std::uint16_t>(heights, stop,
                                  [&](parallel::Cuda& exec, const ImageView<const float>& map) {
                                    return hidden_samples(exec, map, sun, march, tiling);
                                  });
}

std::unique_ptr<DeviceRenderer> make_renderer() {
  return make_cuda_renderer(nullptr);
}

}  // namespace

const CudaTerrain kCudaTerrain{make_renderer, sharp, of_suns, marched};

}  // namespace rastrum::terrain
