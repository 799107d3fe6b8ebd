// A device's rasterizer that draws by a row of the papers' table.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/render/cuda/rasterizer.hpp>

namespace rastrum::family {

/// What the library of device code has for the family (parallel/cuda/library.hpp).
struct CudaRows {
  std::unique_ptr<CudaRasterizer> (*make_rasterizer)(std::string_view coverage,
                                                     std::string_view visibility,
                                                     std::uint64_t memory_limit,
                                                     MemoryAccount& memory,
                                                     parallel::Threads& threads);
};
extern const CudaRows kCudaRows;  ///< in that library

/// rastrum::make_cuda_rasterizer by `coverage` and `visibility`, names of rows, which are the
/// host's but for `grouped`. Throws Error{invalid_argument} where a device has no such row,
/// Error{no_device}.
[[nodiscard]] std::unique_ptr<CudaRasterizer> make_cuda_rasterizer(std::string_view coverage,
                                                                   std::string_view visibility,
                                                                   std::uint64_t memory_limit,
                                                                   MemoryAccount& memory,
                                                                   parallel::Threads& threads);

}  // namespace rastrum::family
