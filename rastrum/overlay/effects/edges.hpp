// SPDX-License-Identifier: BSD-3-Clause
// The sides of one triangle as lines of the picture.
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/effects.hpp>
#include <rastrum/mat.hpp>

namespace rastrum::overlay {

/// Throws Error{invalid_argument} for a width out of range.
void check_edge_width(double width_px);

class TriangleSides {
 public:
  /// `edges` and `to_clip` must outlive this.
  TriangleSides(const SceneEdges& edges, const Mat4d& to_clip, int width, int height,
                double width_px)
      : edges_(edges), to_clip_(to_clip), width_(width), height_(height), half_px_(width_px / 2) {}
  /// 1 minus the share of pixel (x, y), across the line, that the nearest side of primitive `id`
  /// (−1: none) covers.
  [[nodiscard]] float factor(std::int64_t id, int x, int y);

 private:
  void find(std::int64_t id);

  const SceneEdges& edges_;
  const Mat4d& to_clip_;
  int width_, height_;
  double half_px_;
  std::int64_t id_ = -1;
  std::size_t instance_ = static_cast<std::size_t>(-1);
  Mat4d object_to_clip_;
  int count_ = 0;
  Vec3d line_[3];  ///< (a, b, c): a x + b y + c is the distance, px
};

}  // namespace rastrum::overlay
