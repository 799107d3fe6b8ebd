// SPDX-License-Identifier: BSD-3-Clause
// Setup of spheres, cones, tubes and discs: a shape and a matrix to a quadric on the screen.
#pragma once

#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/raster/rules/projection.hpp>
#include <rastrum/raster/rules/quadric.hpp>
#include <rastrum/raster/rules/quadrics.hpp>

namespace rastrum::raster {

struct QuadricPlace {
  std::int32_t x[3], y[3];  ///< corners of its pieces
  bool asks_near = false;   ///< the near plane may cut it
  bool front = true;        ///< a disc shows its front
};

/// Homogeneous points in object space that the picture's rays pass: at (dx, dy, e), o + x · dx + y
/// · dy + e · depth.
struct RayFrame {
  struct Point {
    Vec3d v;
    double w = 0;
  };
  Point o, x, y, depth;
};

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
  RayFrame::Point column[4];  ///< of the matrix from clip to object space

  /// The stage's matrix must have an inverse.
  QuadricEye(const QuadricStage& stage, Viewport viewport);
};

/// Whether any of the shape may be seen. If so sets the quadric, its place and, if wanted, the
/// frame. Depends on the shape and the whole picture alone. About 500 float64 operations.
[[nodiscard]] bool make_quadric(const QuadricEye& eye, const QuadricShape& shape, Quadric& quadric,
                                QuadricPlace& place, RayFrame* frame = nullptr);

}  // namespace rastrum::raster
