// The rasterizer of a CUDA device with what blends its layers (layers.cu), instantiated. Tests
// compile this file as C++, for the CPU.
#include <utility>

#include <rastrum/raster/cuda/by_size.cuh>
#include <rastrum/render/cuda/frame.cuh>
#include <rastrum/render/cuda/make.cuh>

namespace rastrum {
namespace {

std::unique_ptr<CudaRasterizer> make_by_size(std::uint64_t memory_limit, MemoryAccount& memory,
                                             parallel::Threads& threads) {
  return make_device_rasterizer(std::make_unique<raster::BySize>(), memory_limit, memory, threads);
}

}  // namespace

const CudaRendering kCudaRendering{make_by_size};

std::unique_ptr<CudaRasterizer> make_device_rasterizer(
    std::unique_ptr<raster::SurfaceDrawer> drawer, std::uint64_t memory_limit,
    MemoryAccount& memory, parallel::Threads& threads) {
  return std::make_unique<raster::DeviceRasterizer>(std::move(drawer), memory_limit, memory,
                                                    threads);
}

}  // namespace rastrum
