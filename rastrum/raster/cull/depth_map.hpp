// SPDX-License-Identifier: BSD-3-Clause
// The farthest visible depth in each block of a view. It hides clusters before they are set up
// (Greene, Kass and Miller, "Hierarchical Z-buffer visibility", 1993).
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

  /// Begins with an unknown `view`, which must start at a corner of a bin.
  void begin(Rect view);
  /// Takes the keys of a bin of the view or of a part of it. From a part the bound of the whole bin
  /// does not change, and still holds. Thread-safe for distinct parts.
  void look(const Kernels& kernel, const SurfaceView& surface, Rect bin);
  /// The same, from bounds of the bin's blocks.
  void look(const DepthBounds& bounds, Rect bin);
  /// Copies what is known of a bin into `bounds`.
  void recall(DepthBounds& bounds, Rect bin) const;
  /// Whether every sample in the view that the candidate may cover has a strictly nearer key, so
  /// that the candidate cannot win a tie.
  [[nodiscard]] bool hides(const Candidate& candidate) const;

 private:
  Rect view_{};
  std::size_t columns_ = 0, bin_columns_ = 0;
  /// Stores depth(bx, by) for each block of a bin: no sample there is farther.
  template <class Depth>
  void put(Rect bin, const Depth& depth);

  ScratchBuffer<float> block_, bin_;  ///< 0: some sample has no surface, or nothing is known
};

}  // namespace rastrum::raster
