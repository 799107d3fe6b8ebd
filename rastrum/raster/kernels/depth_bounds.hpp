// SPDX-License-Identifier: BSD-3-Clause
// Hierarchical Z tests, for the scalar and the SIMD form of Kernels::cover.
#pragma once

#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/rules/make_piece.hpp>

namespace rastrum::raster {

/// Tests one piece after the other in a bin.
class HiddenTest {
 public:
  HiddenTest(DepthBounds* bounds, Rect bin) : bounds_(bounds), bin_(bin) {}

  /// Whether all samples of the piece in `box` are hidden.
  [[nodiscard]] bool hides_piece(const Piece& piece, Rect box) {
    if (bounds_ == nullptr || !(bounds_->bin > 0) || !is_below(piece, box, bounds_->bin))
      return false;
    ++bounds_->hidden_pieces;
    return true;
  }
  [[nodiscard]] bool hides_block(const Piece& piece, int bx, int by) {
    if (bounds_ == nullptr) return false;
    const int x0 = bx * kBlockSize, y0 = by * kBlockSize;
    const float bound =
        bounds_
            ->block[(y0 - bin_.y0) / kBlockSize * kBlocksPerBinRow + (x0 - bin_.x0) / kBlockSize];
    if (!(bound > 0) || !is_below(piece, {x0, y0, x0 + kBlockSize, y0 + kBlockSize}, bound))
      return false;
    ++bounds_->hidden_blocks;
    return true;
  }

 private:
  static bool is_below(const Piece& piece, Rect r, float bound) {
    return has_depth_bounds(piece) && highest_depth(piece, r) < bound;
  }

  DepthBounds* bounds_;
  Rect bin_;
};

}  // namespace rastrum::raster
