// SPDX-License-Identifier: BSD-3-Clause
// The one driver of a frame: numbers and projects what is drawn, cuts the work to a memory limit,
// lets a method find the keys, makes the images, and counts.
#pragma once

#include <memory>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/draws/numbering.hpp>
#include <rastrum/raster/frame/method.hpp>
#include <rastrum/raster/resolve/resolve.hpp>

namespace rastrum::raster {

/// Begins a frame for any drawer: numbers the draws, and clears the targets that are counted up or
/// only partly set (overdraw, errors), which must not lie on a device.
[[nodiscard]] Totals begin_frame(FrameRequest& request);
/// Fills in the statistics of triangles.
void end_frame(const Totals& totals, FrameStats& stats);

class FrameDriver {
 public:
  /// `memory_limit`: bytes of scratch that `memory` may hold, 0: any. `threads`: null for the
  /// serial reference. Both outlive the driver.
  FrameDriver(std::unique_ptr<Method> method, std::uint64_t memory_limit, MemoryAccount& memory,
              parallel::Threads* threads);
  ~FrameDriver();

  /// From the request, the method and the memory limit; all but the path.
  [[nodiscard]] FramePlan plan(const FrameRequest& request) const {
    return FramePlan::of(request, needs_.colors, memory_limit_ != 0);
  }
  [[nodiscard]] FrameStats draw(FrameRequest& request, const FramePlan& plan);
  [[nodiscard]] FrameStats shade(FrameRequest& request, const KnownBlocks& known);

 private:
  struct Split;
  [[nodiscard]] Split split_work(const FrameRequest& request, const Totals& totals) const;
  template <class F>
  FrameStats run(FrameRequest& request, const FramePlan& plan, bool by_clusters, const F& work);
  void project(FrameRun& frame);
  void draw_view(FrameRun& frame, std::uint64_t first, std::uint64_t last);
  void draw_band(FrameRun& frame, const Split& split, std::uint64_t triangles);
  void shade_blocks(FrameRun& frame, const KnownBlocks& known);

  std::unique_ptr<Method> method_;
  Needs needs_;
  std::uint64_t memory_limit_;
  parallel::Threads* threads_;
  std::uint64_t frames_ = 0;  ///< drawn or in progress
  parallel::ScratchPool<ShaderOfThread> shaders_;
  ScratchBuffer<ProjectedVertex> projected_;
  ScratchBuffer<std::uint64_t> keys_;
  ScratchBuffer<BlockColors> colors_;
};

}  // namespace rastrum::raster
