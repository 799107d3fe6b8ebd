// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/render/cuda/rasterizer.hpp>

#include <rastrum/parallel/cuda/library.hpp>

namespace rastrum {

std::unique_ptr<CudaRasterizer> make_cuda_rasterizer(std::uint64_t memory_limit,
                                                     MemoryAccount& memory,
                                                     parallel::Threads& threads) {
  return parallel::cuda_library().rendering->make_rasterizer(memory_limit, memory, threads);
}

}  // namespace rastrum
