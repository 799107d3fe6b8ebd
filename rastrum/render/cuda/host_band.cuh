// SPDX-License-Identifier: BSD-3-Clause
// The host's share of a band of a device's frame. It uploads the keys of earlier passes and fetches
// the overdraw. If a target or the shader has no device form (shading.cuh), it also resolves the
// keys.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/parallel/scratch.hpp>
#include <rastrum/raster/context/request.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/resolve/resolve.hpp>

namespace rastrum::raster {

/// Keeps its memory from band to band. Its functions wait for the device.
class HostBand {
 public:
  using Keys = parallel::DeviceBuffer<std::uint64_t>;
  using Counts = parallel::DeviceBuffer<std::uint32_t>;

  HostBand(MemoryAccount& memory, parallel::Threads& threads)
      : threads_(threads), keys_(memory), overdraw_(memory) {}

  void load(parallel::Cuda& exec, const FrameRequest& request, Rect view, Keys& keys) {
    load_keys(request, view, surface(view));
    copy(exec, keys.data(), keys_.data(), keys.size());
  }

  /// Adds to the target, which begin_frame cleared or an earlier pass filled.
  void store_overdraw(parallel::Cuda& exec, const Targets& targets, Rect view,
                      const Counts& overdraw) {
    overdraw_.reserve(overdraw.size());
    copy(exec, overdraw_.data(), overdraw.data(), overdraw.size());
    const SurfaceView places{0, view.y0 / kBlockSize, block_columns(view), nullptr, nullptr};
    for_each_row(view, [&](int by) {
      for (int y = by * kBlockSize; y < std::min((by + 1) * kBlockSize, view.y1); ++y)
        for (int x = 0; x < view.x1; ++x)
          targets.overdraw(x, y) +=
              overdraw_[places.index(x / kBlockSize, by) * 64 +
                        static_cast<std::size_t>(y % kBlockSize * kBlockSize + x % kBlockSize)];
    });
  }

  /// Fills all targets. Returns how many pixels show a surface.
  [[nodiscard]] std::uint64_t resolve(parallel::Cuda& exec, const FrameRequest& request,
                                      const FrameGeometry& geometry, Rect view, const Keys& keys,
                                      parallel::ScratchPool<ShaderScratch>& shaders) {
    const SurfaceView there = surface(view);
    copy(exec, keys_.data(), keys.data(), keys.size());
    const FramePlan plan = FramePlan::of(request, false, false);
    std::atomic<std::uint64_t> covered = 0;
    for_each_row(view, [&](int by) {
      std::uint64_t here = 0;
      for (int bx = 0; bx < there.columns; ++bx)
        here += static_cast<std::uint64_t>(resolve_block(request, plan, geometry,
                                                         there.block(bx, by), bx * kBlockSize,
                                                         by * kBlockSize, shaders.local().data()));
      covered.fetch_add(here, std::memory_order_relaxed);
    });
    return covered;
  }

 private:
  template <class T>
  static void copy(parallel::Cuda& exec, T* to, const T* from, std::size_t n) {
    parallel::cuda_system::copy(exec.stream(), to, from, n * sizeof(T));
    exec.wait();
  }
  template <class F>
  void for_each_row(Rect view, F&& f) {
    parallel::for_each_index(threads_, static_cast<std::size_t>(block_rows(view)),
                             [&](std::size_t r) { f(view.y0 / kBlockSize + static_cast<int>(r)); });
  }
  [[nodiscard]] SurfaceView surface(Rect view) {
    keys_.reserve(block_count(view) * 64);
    return {0, view.y0 / kBlockSize, block_columns(view), keys_.data(), nullptr};
  }

  parallel::Threads& threads_;
  ScratchBuffer<std::uint64_t> keys_;      ///< in the device's order
  ScratchBuffer<std::uint32_t> overdraw_;  ///< in the device's order
};

}  // namespace rastrum::raster
