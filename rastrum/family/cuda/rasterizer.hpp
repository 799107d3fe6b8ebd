// The family on a device: rasterizers that draw by a row of the papers' table, and the terrain's
// `words`.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/render/cuda/rasterizer.hpp>
#include <rastrum/terrain/cuda/device.hpp>

namespace rastrum::family {

/// The family's entry points in the library of device code (parallel/cuda/library.hpp).
struct CudaRows {
  std::unique_ptr<CudaRasterizer> (*make_rasterizer)(std::string_view coverage,
                                                     std::string_view visibility,
                                                     std::uint64_t memory_limit,
                                                     MemoryAccount& memory,
                                                     parallel::Threads& threads);
  std::unique_ptr<terrain::DeviceRenderer> (*make_terrain_renderer)();
};
extern const CudaRows kCudaRows;  ///< in that library
/// Alike, in words.cu.
[[nodiscard]] std::unique_ptr<terrain::DeviceRenderer> make_cuda_terrain_renderer();

/// rastrum::make_cuda_rasterizer by `coverage` and `visibility`, names of rows, which are the
/// host's but for `grouped`. Throws Error{invalid_argument} where a device has no such row,
/// Error{no_device}.
[[nodiscard]] std::unique_ptr<CudaRasterizer> make_cuda_rasterizer(std::string_view coverage,
                                                                   std::string_view visibility,
                                                                   std::uint64_t memory_limit,
                                                                   MemoryAccount& memory,
                                                                   parallel::Threads& threads);

}  // namespace rastrum::family
