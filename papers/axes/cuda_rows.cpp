// SPDX-License-Identifier: BSD-3-Clause
#include <papers/axes/cuda_rows.hpp>

#include <rastrum/parallel/cuda/library.hpp>

namespace rastrum::family {

const CudaRows& cuda_rows() {
  return *static_cast<const CudaRows*>(
      parallel::added_table(parallel::cuda_library(), kCudaRowsName));
}

std::unique_ptr<CudaRasterizer> make_cuda_rasterizer(
    std::string_view coverage, std::string_view visibility, const Tuning& tuning,
    std::uint64_t memory_limit, MemoryAccount& memory, parallel::Threads& threads) {
  return cuda_rows().make_rasterizer(coverage, visibility, tuning, memory_limit, memory, threads);
}

}  // namespace rastrum::family
