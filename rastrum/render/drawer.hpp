// SPDX-License-Identifier: BSD-3-Clause
// The drawer of a Renderer's frames. It decides the way of a frame (FramePlan): methods of the
// CPU's threads, the serial reference's, or a device. The family (papers/table/renderer.cpp) gives
// it other methods.
#pragma once

#include <functional>
#include <memory>
#include <optional>
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
  /// Why Device::automatic took CUDA. Frames then go to the device only if that is expected to pay
  /// off (device_work.hpp). Empty: CUDA was asked for.
  std::string automatic_why{};
  std::uint64_t memory_limit = 0;  ///< bytes of scratch; 0: any
};

/// `threads` is null for the serial reference; account and threads must outlive the result.
using MakeFrameDrawer = std::function<std::unique_ptr<raster::FrameDrawer>(
    const DrawerOptions& options, MemoryAccount& memory, parallel::Threads* threads)>;

[[nodiscard]] std::unique_ptr<raster::FrameDrawer> make_drawer(const DrawerOptions& options,
                                                               MemoryAccount& memory,
                                                               parallel::Threads* threads);

/// The CPU's ways by FramePlan::Path, each made when first needed. Without `samples`, layers draw
/// those frames.
struct Ways {
  using MakeMethod = std::function<std::unique_ptr<raster::Method>()>;
  /// The choices of `auto`, for all frames: on no row of `rastrum bench auto` was another pair
  /// enough faster (docs/decisions/0028).
  struct Automatic {
    bool rasterizer, visibility;
  };
  MakeMethod keys, layers, samples{};
  std::optional<Automatic> automatic{};  ///< none: nothing to choose
};
struct DeviceFrames {
  /// Null: the CPU draws all frames; `why_host` says why.
  std::unique_ptr<CudaRasterizer> device{};
  std::string why_host{};
  std::string why{};  ///< FrameStats::why of the device's frames begins with it
};
/// Calls `make_ways` at once or, with a device, for the first frame that the device cannot draw or
/// the CPU is expected to finish sooner.
[[nodiscard]] std::unique_ptr<raster::FrameDrawer> make_drawer_of(std::function<Ways()> make_ways,
                                                                  const DrawerOptions& options,
                                                                  MemoryAccount& memory,
                                                                  parallel::Threads* threads,
                                                                  DeviceFrames device = {});
[[nodiscard]] std::unique_ptr<raster::FrameDrawer> make_reference_drawer(std::uint64_t memory_limit,
                                                                         MemoryAccount& memory);

}  // namespace rastrum
