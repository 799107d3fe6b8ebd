#include <rastrum/family/cuda/rasterizer.hpp>

#include <rastrum/parallel/cuda/library.hpp>

namespace rastrum::family {

std::unique_ptr<CudaRasterizer> make_cuda_rasterizer(std::string_view coverage,
                                                     std::string_view visibility,
                                                     std::uint64_t memory_limit,
                                                     MemoryAccount& memory,
                                                     parallel::Threads& threads) {
  return parallel::cuda_library().family->make_rasterizer(coverage, visibility, memory_limit,
                                                          memory, threads);
}

}  // namespace rastrum::family
