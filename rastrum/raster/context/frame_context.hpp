// SPDX-License-Identifier: BSD-3-Clause
// The stages of a frame read this: the request, the projected scene, the threads and the memory
// limits. FrameRun (frame/frame_run.hpp) runs the stages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/context/counters.hpp>
#include <rastrum/raster/context/frame_plan.hpp>
#include <rastrum/raster/context/stopwatch.hpp>
#include <rastrum/raster/kernels/kernels.hpp>

namespace rastrum::raster {

/// The parts of a frame that drawing and blending a bin's blocks needs. All outlive its use.
struct BinContext {
  const FrameRequest* request = nullptr;
  const FramePlan* plan = nullptr;
  const FrameGeometry* frame = nullptr;
  const Kernels* kernel = nullptr;
  std::uint64_t fragment_bytes = 0;  ///< most that fragments may take at once; 0: no limit
  void* shader_scratch = nullptr;    ///< VisibleBlock::scratch
  bool clips = true;                 ///< some triangle of the view may have been clipped
};

struct FrameContext {
  FrameRequest& request;
  const FramePlan& plan;
  FrameGeometry geometry;
  /// Writable memory of `geometry`: vertices of clusters are projected later.
  ProjectedVertex* projected = nullptr;
  const Kernels& kernel;
  parallel::Threads* const threads;  ///< null: the serial reference
  FrameStats& stats;
  Stopwatch& watch;

  Rect view{};             ///< the image, or the part of it that is drawn now
  bool first_band = true;  ///< triangles are counted once
  /// Most bytes of fragments at once, over all threads; 0: no limit.
  std::uint64_t fragment_bytes = 0;
  /// Most bytes that triangles are expanded to (rows, bins, pairs) at once; 0: no limit.
  std::uint64_t expansion_bytes = 0;
  /// Most bytes of a view's pieces and what they are expanded to, where all must be there at once
  /// (Needs::whole_view); 0: no limit.
  std::uint64_t view_bytes = 0;
  bool clips = true;  ///< some triangle of the view may have been clipped
  Counters counters{};

  [[nodiscard]] bool plans_memory() const { return view_bytes != 0 || expansion_bytes != 0; }
  [[nodiscard]] int concurrency() const { return threads == nullptr ? 1 : threads->concurrency(); }
  template <class F>
  void for_each_index(std::size_t n, F&& f) const {
    if (threads != nullptr) return parallel::for_each_index(*threads, n, f);
    for (std::size_t i = 0; i < n; ++i) f(i);
  }
  /// The same, begun in increasing order, so that the largest can go first.
  template <class F>
  void for_each_in_order(std::size_t n, F&& f) const {
    if (threads != nullptr) return parallel::for_each_in_order(*threads, n, f);
    for (std::size_t i = 0; i < n; ++i) f(i);
  }
  void count(std::string_view name, std::uint64_t value) { add_counter(counters, name, value); }

  /// Projects all vertices of a draw (to Draw::first_vertex on).
  void project(Draw& draw) const;
};

}  // namespace rastrum::raster
