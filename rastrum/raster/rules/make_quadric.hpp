// SPDX-License-Identifier: BSD-3-Clause
// Setup of spheres, cones, tubes and discs: from a shape and a matrix to a quadric on the screen.
#pragma once

#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/raster/rules/projection.hpp>
#include <rastrum/raster/rules/quadric.hpp>
#include <rastrum/raster/rules/quadrics.hpp>

namespace rastrum::raster {

/// Where a quadric is in the picture.
struct QuadricPlace {
  std::int32_t x[3], y[3];  ///< of its pieces
  bool asks_near = false;   ///< the near plane may cut it
  bool front = true;        ///< of a disc: its front is seen
};

/// The points that the rays of a picture pass, in object space and homogeneous: at (dx, dy, e),
/// o + x · dx + y · dy + e · depth.
struct RayFrame {
  struct Point {
    Vec3d v;
    double w = 0;
  };
  Point o, x, y, depth;
};

/// Numbers that setup derives from the matrices of a stage and of a picture.
struct QuadricEye {
  /// A row of the matrix to clip space.
  struct Row {
    Vec3d v;
    double w = 0;
    double length = 0;   ///< |v|
    double cross_w = 0;  ///< |v × v of row w|²
    double dot_w = 0;    ///< v · v of row w
  };
  Row x, y, z, w;
  Row before;  ///< z − w > 0 lies before the near plane
  double half_width = 0, half_height = 0;
  RayFrame::Point column[4];  ///< of the matrix from clip space

  /// The stage's matrix must have an inverse.
  QuadricEye(const QuadricStage& stage, Viewport viewport);
};

/// Whether any of the shape may be seen in the picture; then sets all of the quadric, its place
/// and, where it is wanted, the frame. Depends on the shape and the whole picture alone. About 500
/// operations of float64.
[[nodiscard]] bool make_quadric(const QuadricEye& eye, const QuadricShape& shape, Quadric& quadric,
                                QuadricPlace& place, RayFrame* frame = nullptr);

}  // namespace rastrum::raster
