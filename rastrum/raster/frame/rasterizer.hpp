// A rasterizer: a coverage, a visibility and the pipeline around them.
#pragma once

#include <memory>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/coverage/coverage.hpp>
#include <rastrum/raster/frame/request.hpp>
#include <rastrum/raster/visibility/region.hpp>

namespace rastrum::raster {

/// Keeps its scratch between frames. One frame at a time.
class Rasterizer {
 public:
  /// What is given outlives the rasterizer. `memory_limit`: bytes of scratch that `memory` may
  /// hold, 0 for any. Throws Error{invalid_argument} for a tuning that was not compiled.
  Rasterizer(const CoverageRow& coverage, const Visibility& visibility, const Tuning& tuning,
             std::uint64_t memory_limit, MemoryAccount& memory, parallel::Threads& threads);
  ~Rasterizer();

  /// One frame. Throws Error{invalid_argument} where an index is out of range,
  /// Error{out_of_memory} where the limit is too small for any piece of the work.
  [[nodiscard]] FrameStats render(FrameRequest& request);

 private:
  struct Plan;
  [[nodiscard]] Plan plan(const FrameRequest& request, std::uint64_t triangles,
                          std::size_t vertices) const;
  void project(FrameRequest& request, FrameGeometry& frame);
  void draw_view(Frame& frame, std::uint64_t first, std::uint64_t last);
  void draw_band(Frame& frame, const Plan& plan, std::uint64_t triangles);

  const CoverageRow& row_;
  const Visibility& visibility_;
  std::uint64_t memory_limit_;
  parallel::Threads& threads_;
  std::unique_ptr<Coverage> coverage_;
  FrameScratch scratch_;
  Buffer<ProjectedVertex> projected_;
  Buffer<std::uint64_t> keys_;
  Buffer<BlockColors> colors_;
};

}  // namespace rastrum::raster
