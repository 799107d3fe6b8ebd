// SPDX-License-Identifier: BSD-3-Clause
// Instantiates the rasterizer of a CUDA device without its layers (layers.cu). Tests compile this
// file as C++, for the CPU.
#include <utility>

#include <rastrum/raster/cuda/by_size.cuh>
#include <rastrum/render/cuda/frame.cuh>
#include <rastrum/render/cuda/make.cuh>

namespace rastrum {
namespace {

std::unique_ptr<CudaRasterizer> make_rasterizer(std::uint64_t memory_limit, MemoryAccount& memory,
                                                parallel::Threads& threads) {
  return make_device_rasterizer(raster::make_by_size({}), memory_limit, memory, threads);
}

}  // namespace

const CudaRendering kCudaRendering{make_rasterizer};

std::unique_ptr<raster::SurfaceDrawer> raster::make_by_size(DeviceSizes sizes) {
  return std::make_unique<BySize>(sizes);
}

std::unique_ptr<CudaRasterizer> make_device_rasterizer(
    std::unique_ptr<raster::SurfaceDrawer> drawer, std::uint64_t memory_limit,
    MemoryAccount& memory, parallel::Threads& threads) {
  return std::make_unique<raster::DeviceRasterizer>(std::move(drawer), memory_limit, memory,
                                                    threads);
}

}  // namespace rastrum
