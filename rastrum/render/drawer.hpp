// What draws the frames of a Renderer: one path on the CPU's threads, the serial reference, a
// device. The family (family/renderer.cpp) makes others of the same parts.
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
  /// What Device::automatic took CUDA for; each frame is then the device's only if it is expected
  /// to be worth it (device_work.hpp). Empty: CUDA was asked for.
  std::string automatic_why;
  std::uint64_t memory_limit = 0;  ///< bytes of scratch; 0: any
};

/// `threads` is null for the serial reference; account and threads outlive the result.
using MakeFrameDrawer = std::function<std::unique_ptr<raster::FrameDrawer>(
    const DrawerOptions& options, MemoryAccount& memory, parallel::Threads* threads)>;

/// The renderer's own.
[[nodiscard]] std::unique_ptr<raster::FrameDrawer> make_drawer(const DrawerOptions& options,
                                                               MemoryAccount& memory,
                                                               parallel::Threads* threads);

/// Whether a draw has translucent primitives, and they are not to be drawn opaque.
[[nodiscard]] bool blends(std::span<const raster::Draw> draws, const TransparencyOptions& options);
/// Whether keys are not enough: something is translucent, or pixels have several samples.
[[nodiscard]] bool needs_layers(const raster::FrameRequest& request);

/// FrameStats::why, where `auto` took the rasterizer, the visibility, both or neither. One choice
/// for all frames: on no row of `rastrum bench auto` another pair was faster by enough to choose by
/// it (docs/decisions/0010).
[[nodiscard]] std::string why(bool rasterizer, bool visibility, bool layers);

/// The same of frames that are drawn sample by sample (raster::is_sampled).
[[nodiscard]] std::string why_samples(bool rasterizer);

using MakeMethod = std::function<std::unique_ptr<raster::Method>()>;

/// The ways to draw a frame: where keys are enough, and where they are not; `samples`: where keys
/// of each sample are (raster::is_sampled), else null.
struct Methods {
  MakeMethod keys, layers;
  std::string why_keys{}, why_layers{};  ///< FrameStats::why
  MakeMethod samples{};
  std::string why_samples{};
};
/// Frames by these, each made when a frame first needs it.
[[nodiscard]] std::unique_ptr<raster::FrameDrawer> make_drawer_of(Methods methods,
                                                                  std::uint64_t memory_limit,
                                                                  MemoryAccount& memory,
                                                                  parallel::Threads* threads);
/// The serial reference, with exact layers or those of `make_blend`.
[[nodiscard]] std::unique_ptr<raster::FrameDrawer> make_reference_drawer(
    std::uint64_t memory_limit, MemoryAccount& memory, transparency::MakeBlend make_blend);

/// Frames on a device.
struct DeviceFrames {
  /// Null: all are the CPU's, as `why_host` says.
  std::unique_ptr<CudaRasterizer> device;
  std::string why_host;
  std::string why;  ///< FrameStats::why of the device's frames begins with it
  /// For frames that the device has no code for, or that are expected to be done sooner there.
  std::function<std::unique_ptr<raster::FrameDrawer>()> make_host;
};
[[nodiscard]] std::unique_ptr<raster::FrameDrawer> make_device_drawer(DeviceFrames frames,
                                                                      const DrawerOptions& options,
                                                                      parallel::Threads& threads);

}  // namespace rastrum
