// SPDX-License-Identifier: BSD-3-Clause
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
#include <rastrum/tuning.hpp>

namespace rastrum::family {

/// The family's entry points in the library of device code (parallel/cuda/library.hpp), which
/// registers them by this name.
inline constexpr const char* kCudaRowsName = "the papers' rasterizers";
struct CudaRows {
  std::unique_ptr<CudaRasterizer> (*make_rasterizer)(
      std::string_view coverage, std::string_view visibility, const Tuning& tuning,
      std::uint64_t memory_limit, MemoryAccount& memory, parallel::Threads& threads);
  std::unique_ptr<terrain::DeviceRenderer> (*make_terrain_renderer)();
};
/// The entry points of the loaded library. Throws Error{no_device}.
[[nodiscard]] const CudaRows& cuda_rows();
/// The device's `words` renderer (words.cu).
[[nodiscard]] std::unique_ptr<terrain::DeviceRenderer> make_cuda_terrain_renderer();

/// A rasterizer that draws by the rows `coverage` and `visibility`; without `coverage`, by-size
/// with the sizes of the tuning. The names are the host's, but a device has no `grouped`. Throws
/// Error{invalid_argument} if a device has no such row, Error{no_device}.
[[nodiscard]] std::unique_ptr<CudaRasterizer> make_cuda_rasterizer(
    std::string_view coverage, std::string_view visibility, const Tuning& tuning,
    std::uint64_t memory_limit, MemoryAccount& memory, parallel::Threads& threads);

}  // namespace rastrum::family
