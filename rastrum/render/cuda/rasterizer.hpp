// SPDX-License-Identifier: BSD-3-Clause
// The rasterizer of a CUDA device, for sources that nvcc does not compile.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/context/request.hpp>
#include <rastrum/stop.hpp>

namespace rastrum {

/// Keeps its stream and its memory between frames. One frame at a time.
class CudaRasterizer {
 public:
  virtual ~CudaRasterizer() = default;
  /// Why a frame's tests, layers or samples are left to the CPU; empty: they are not.
  [[nodiscard]] virtual std::string why_not(const raster::FrameRequest& request) const = 0;
  /// Draws a frame for which why_not is empty, and fills targets as Renderer::render does. Arrays,
  /// in place or not, are copied to the device when new or changed, textures when new. If the
  /// device has no form of the shader, the host's threads shade, and FrameStats::why says so.
  /// Throws Error{invalid_argument} for an index out of range, Error{out_of_memory} with the size
  /// asked for, Error{no_device} for errors of the driver.
  [[nodiscard]] FrameStats render(raster::FrameRequest& request) {
    return render(request, StopScope::current());
  }

 private:
  /// `stop`: the caller's scope, which another library cannot see.
  [[nodiscard]] virtual FrameStats render(raster::FrameRequest& request, const StopToken* stop) = 0;
};

/// In the device library, for the renderer (parallel/cuda/library.hpp).
struct CudaRendering {
  std::unique_ptr<CudaRasterizer> (*make_rasterizer)(std::uint64_t memory_limit,
                                                     MemoryAccount& memory,
                                                     parallel::Threads& threads);
};
extern const CudaRendering kCudaRendering;  ///< in that library

/// By-size, the device's default. `memory_limit`: bytes of scratch on the device beside copies of
/// meshes and textures; 0: three quarters of what is free. `memory` and `threads` must outlive the
/// result. Throws Error{no_device}.
[[nodiscard]] std::unique_ptr<CudaRasterizer> make_cuda_rasterizer(std::uint64_t memory_limit,
                                                                   MemoryAccount& memory,
                                                                   parallel::Threads& threads);

}  // namespace rastrum
