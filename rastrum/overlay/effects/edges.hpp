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
  [[nodiscard]] std::int64_t id() const { return id_; }
  /// Finds the sides of primitive `id` that are drawn; −1: none.
  void find(const SceneEdges& edges, const Mat4d& to_clip, int width, int height, std::int64_t id);
  /// 1 less the share of the pixel around (x, y), px, that the nearest line covers: what is left of
  /// half a pixel about it, across the line.
  [[nodiscard]] float factor(double x, double y, double half_width) const;

 private:
  std::int64_t id_ = -1;
  std::size_t instance_ = static_cast<std::size_t>(-1);
  Mat4d object_to_clip_;
  int count_ = 0;
  Vec3d line_[3];  ///< (a, b, c): a x + b y + c is the distance, px
};

}  // namespace rastrum::overlay
