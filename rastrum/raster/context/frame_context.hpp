// SPDX-License-Identifier: BSD-3-Clause
// The stages of a frame read this: the request, the projected scene, who works, and how much memory
// they may take. FrameRun (frame/frame_run.hpp) runs the stages.
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

/// The parts of a frame for code that draws and blends the blocks of a bin. All outlive its use.
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
  /// The memory that `geometry` reads, writable: vertices of clusters are projected into it later.
  ProjectedVertex* projected = nullptr;
  const Kernels& kernel;
  parallel::Threads* const threads;  ///< null: the serial reference
  FrameStats& stats;
  Stopwatch& watch;

  Rect view{};             ///< what is being drawn: the image or a part of it
  bool first_band = true;  ///< triangles are counted once
  /// Most that fragments may take at once, over all threads; 0: no limit.
  std::uint64_t fragment_bytes = 0;
  /// Most that triangles may be expanded to (rows, bins, pairs) at once; 0: no limit.
  std::uint64_t expansion_bytes = 0;
  /// Most that the pieces of a view, and what they are expanded to, may take at once where all have
  /// to be there (Needs::whole_view); 0: no limit.
  std::uint64_t view_bytes = 0;
  bool clips = true;  ///< some triangle of the view may have been clipped
  Counters counters{};

  /// Whether there is a limit on the pieces of a view or on what triangles are expanded to.
  [[nodiscard]] bool plans_memory() const { return view_bytes != 0 || expansion_bytes != 0; }
  [[nodiscard]] int concurrency() const { return threads == nullptr ? 1 : threads->concurrency(); }
  /// f(i) for i in [0, n), by all threads.
  template <class F>
  void for_each_index(std::size_t n, F&& f) const {
    if (threads != nullptr) return parallel::for_each_index(*threads, n, f);
    for (std::size_t i = 0; i < n; ++i) f(i);
  }
  /// The same, begun in increasing order: the largest first.
  template <class F>
  void for_each_in_order(std::size_t n, F&& f) const {
    if (threads != nullptr) return parallel::for_each_in_order(*threads, n, f);
    for (std::size_t i = 0; i < n; ++i) f(i);
  }
  void count(std::string_view name, std::uint64_t value) { add_counter(counters, name, value); }

  /// Projects all vertices of a draw to their places (Draw::first_vertex).
  void project(Draw& draw) const;
};

}  // namespace rastrum::raster
