// The rasterizer of a CUDA device with what blends its layers (layers.cu), instantiated. Tests
// compile this file as C++, for the CPU.
#include <rastrum/raster/cuda/frame.cuh>
#include <rastrum/render/cuda/layers.cuh>

namespace rastrum::raster {

bool draws_on_cuda() noexcept {
  return true;
}

std::unique_ptr<CudaRasterizer> make_cuda_rasterizer(std::string_view coverage,
                                                     std::string_view visibility,
                                                     std::uint64_t memory_limit,
                                                     MemoryAccount& memory,
                                                     parallel::Threads& threads) {
  return std::make_unique<DeviceRasterizer<parallel::Cuda, transparency::SceneLayers>>(
      coverage, visibility, memory_limit, memory, threads);
}

}  // namespace rastrum::raster
