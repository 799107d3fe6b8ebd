// Setup of spheres, cones, tubes and discs: from a shape and a matrix to a quadric on the screen.
#pragma once

#include <rastrum/raster/draws/projection.hpp>
#include <rastrum/raster/draws/quadrics.hpp>
#include <rastrum/raster/setup/piece.hpp>
#include <rastrum/raster/setup/quadric.hpp>

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

/// Whether anything of the shape may be seen in the picture; then sets all of the quadric, its
/// place and, where it is wanted, the frame. Depends on the shape and the whole picture alone.
/// About 500 operations of float64.
[[nodiscard]] bool make_quadric(const QuadricStage& stage, const QuadricShape& shape,
                                Viewport viewport, Quadric& quadric, QuadricPlace& place,
                                RayFrame* frame = nullptr);

}  // namespace rastrum::raster
