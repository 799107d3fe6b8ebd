// The drawers of a Renderer's frames: the path on the CPU's threads, the serial reference, a
// device. The family (papers/table/renderer.cpp) makes others of the same parts.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include <rastrum/core/memory.hpp>
#include <rastrum/device.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/frame/frame_drawer.hpp>
#include <rastrum/raster/frame/method.hpp>
#include <rastrum/render/cuda/rasterizer.hpp>
#include <rastrum/transparency/blend.hpp>

namespace rastrum {

struct DrawerOptions {
  Device device = Device::threads;  ///< not `automatic`
  /// Why Device::automatic took CUDA; a frame then goes to the device only if that is expected to
  /// be worth it (device_work.hpp). Empty: CUDA was asked for.
  std::string automatic_why;
  std::uint64_t memory_limit = 0;  ///< bytes of scratch; 0: any
};

/// `threads` is null for the serial reference; account and threads must outlive the result.
using MakeFrameDrawer = std::function<std::unique_ptr<raster::FrameDrawer>(
    const DrawerOptions& options, MemoryAccount& memory, parallel::Threads* threads)>;

/// The renderer's own drawer.
[[nodiscard]] std::unique_ptr<raster::FrameDrawer> make_drawer(const DrawerOptions& options,
                                                               MemoryAccount& memory,
                                                               parallel::Threads* threads);

/// Whether a draw has translucent primitives that must not be drawn opaque.
[[nodiscard]] bool blends(std::span<const raster::Draw> draws, const TransparencyOptions& options);
/// Whether keys are not enough: something is translucent, or pixels have several samples.
[[nodiscard]] bool needs_layers(const raster::FrameRequest& request);

/// FrameStats::why, for frames where `auto` chose the rasterizer, the visibility, both or neither.
/// It makes one choice for all frames: on no row of `rastrum bench auto` was another pair faster by
/// enough to choose by it (docs/decisions/0010).
[[nodiscard]] std::string why(bool rasterizer, bool visibility, bool layers);

/// The same for frames that are drawn sample by sample (raster::is_sampled).
[[nodiscard]] std::string why_samples(bool rasterizer);

using MakeMethod = std::function<std::unique_ptr<raster::Method>()>;

/// The ways to draw a frame: `keys` if keys are enough, `layers` if they are not; `samples` if keys
/// of each sample are (raster::is_sampled), else null.
struct Methods {
  MakeMethod keys, layers;
  std::string why_keys{}, why_layers{};  ///< FrameStats::why
  MakeMethod samples{};
  std::string why_samples{};
};
/// A drawer that uses these methods, each made when a frame first needs it.
[[nodiscard]] std::unique_ptr<raster::FrameDrawer> make_drawer_of(Methods methods,
                                                                  std::uint64_t memory_limit,
                                                                  MemoryAccount& memory,
                                                                  parallel::Threads* threads);
/// The serial reference.
[[nodiscard]] std::unique_ptr<raster::FrameDrawer> make_reference_drawer(std::uint64_t memory_limit,
                                                                         MemoryAccount& memory);

/// Frames on a device.
struct DeviceFrames {
  /// Null: the CPU draws all frames; `why_host` says why.
  std::unique_ptr<CudaRasterizer> device;
  std::string why_host;
  std::string why;  ///< FrameStats::why of the device's frames begins with it
  /// For frames that the device has no code for, or that the CPU is expected to finish sooner.
  std::function<std::unique_ptr<raster::FrameDrawer>()> make_host;
};
[[nodiscard]] std::unique_ptr<raster::FrameDrawer> make_device_drawer(DeviceFrames frames,
                                                                      const DrawerOptions& options,
                                                                      parallel::Threads& threads);

}  // namespace rastrum
