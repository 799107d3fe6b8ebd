// The rasterizer of a CUDA device, where there is no nvcc: choose_device refuses it before this.
#include <rastrum/core/error.hpp>
#include <rastrum/raster/cuda/rasterizer.hpp>

namespace rastrum::raster {

bool draws_on_cuda() noexcept {
  return false;
}

std::unique_ptr<CudaRasterizer> make_cuda_rasterizer(std::string_view, std::string_view,
                                                     std::uint64_t, MemoryAccount&,
                                                     parallel::Threads&) {
  throw Error(Errc::no_device, "this program was built without CUDA");
}

}  // namespace rastrum::raster
