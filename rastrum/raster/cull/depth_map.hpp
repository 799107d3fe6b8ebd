// The farthest that is seen in each block of a view, by which clusters are hidden before they are
// set up (Greene, Kass and Miller, "Hierarchical Z-buffer visibility", 1993).
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/cull/selection.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/resolve/surface.hpp>

namespace rastrum::raster {

class DepthMap {
 public:
  explicit DepthMap(MemoryAccount& memory) : block_(memory), bin_(memory) {}

  /// Of `view`, which begins at a corner of a bin; nothing is known.
  void begin(Rect view);
  /// Looks at the keys of a bin of the view, or a part of one: what is known of all of it then
  /// stays, and holds. Thread-safe for distinct ones.
  void look(const Kernels& kernel, const SurfaceView& surface, Rect bin);
  /// The same of what is known of the bin's blocks.
  void look(const DepthBounds& bounds, Rect bin);
  /// And back.
  void recall(DepthBounds& bounds, Rect bin) const;
  /// Whether every sample in the view that the candidate may cover has a key of a nearer surface:
  /// strictly, so that it cannot win a tie.
  [[nodiscard]] bool hides(const Candidate& candidate) const;

 private:
  Rect view_{};
  std::size_t columns_ = 0, bin_columns_ = 0;
  /// Of the blocks of a bin `depth(bx, by)`: no sample is farther.
  template <class Depth>
  void put(Rect bin, const Depth& depth);

  ScratchBuffer<float> block_, bin_;  ///< 0: something is seen there through all
};

}  // namespace rastrum::raster
