// SPDX-License-Identifier: BSD-3-Clause
// The farthest that is seen in each block of a view, by which clusters are hidden before they are
// set up (Greene, Kass and Miller, "Hierarchical Z-buffer visibility", 1993).
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/cull/selection.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/rules/surface_view.hpp>

namespace rastrum::raster {

class DepthMap {
 public:
  explicit DepthMap(MemoryAccount& memory) : block_(memory), bin_(memory) {}

  /// Begins with `view`, which begins at a corner of a bin; nothing is known of it then.
  void begin(Rect view);
  /// Looks at the keys of a bin of the view, or of a part of one: then the bound of the whole bin
  /// stays as it was, and still holds. Thread-safe for distinct parts.
  void look(const Kernels& kernel, const SurfaceView& surface, Rect bin);
  /// The same from bounds of the bin's blocks.
  void look(const DepthBounds& bounds, Rect bin);
  /// Copies what is known of a bin into `bounds`.
  void recall(DepthBounds& bounds, Rect bin) const;
  /// Whether every sample in the view that the candidate may cover has a key of a nearer surface:
  /// strictly, so that it cannot win a tie.
  [[nodiscard]] bool hides(const Candidate& candidate) const;

 private:
  Rect view_{};
  std::size_t columns_ = 0, bin_columns_ = 0;
  /// Notes for each block of a bin the `depth(bx, by)` than which no sample there is farther.
  template <class Depth>
  void put(Rect bin, const Depth& depth);

  ScratchBuffer<float> block_, bin_;  ///< 0: something is seen there through all
};

}  // namespace rastrum::raster
