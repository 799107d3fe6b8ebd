// The rasterizer of a CUDA device, for who is no translation unit of nvcc.
#pragma once

#include <cstdint>
#include <memory>
#include <stop_token>
#include <string>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/frame/request.hpp>
#include <rastrum/stop.hpp>

namespace rastrum {

/// Keeps its stream and its memory between frames. One frame at a time.
class CudaRasterizer {
 public:
  virtual ~CudaRasterizer() = default;
  /// Why a frame whose fragments are tested is left to the CPU; empty: it is not.
  [[nodiscard]] virtual std::string why_no_test(const raster::FrameRequest& request) const = 0;
  /// Why a frame with layers or several samples a pixel is left to the CPU; empty: it is not.
  [[nodiscard]] virtual std::string why_no_layers(const raster::FrameRequest& request) const = 0;
  /// One frame of which neither why_no_test nor, where it has layers or several samples a pixel,
  /// why_no_layers says anything: targets as Renderer::render. The caller's arrays are copied to
  /// the device when they are new or were changed, in place or not; textures when they are new.
  /// What the device has no shader for is shaded by the host's threads; FrameStats::why says so.
  /// Throws Error{invalid_argument} where an index is out of range, Error{out_of_memory} with what
  /// was asked for, Error{no_device} for what the driver reports.
  [[nodiscard]] FrameStats render(raster::FrameRequest& request) {
    return render(request, parallel::StopScope::current());
  }

 private:
  /// `stop`: the caller's scope, which another library does not see.
  [[nodiscard]] virtual FrameStats render(raster::FrameRequest& request,
                                          const std::stop_token* stop) = 0;
};

/// What the library of device code has for the renderer (parallel/cuda/library.hpp).
struct CudaRendering {
  std::unique_ptr<CudaRasterizer> (*make_rasterizer)(std::uint64_t memory_limit,
                                                     MemoryAccount& memory,
                                                     parallel::Threads& threads);
};
extern const CudaRendering kCudaRendering;  ///< in that library

/// By-size, the device's own. `memory_limit`: bytes of scratch on the device beyond the copies of
/// meshes and textures, 0: three quarters of what is free there. `memory` and `threads` outlive it.
/// Throws Error{no_device}.
[[nodiscard]] std::unique_ptr<CudaRasterizer> make_cuda_rasterizer(std::uint64_t memory_limit,
                                                                   MemoryAccount& memory,
                                                                   parallel::Threads& threads);

}  // namespace rastrum
