// SPDX-License-Identifier: BSD-3-Clause
// Finds a quadric again from its primitive, for code that asks for single points of its surface:
// shading, clip planes, queries at a pixel. The result depends on the primitive, the whole picture
// and the point alone, in float64 and a fixed order, so every caller gets the same bits.
#pragma once

#include <cstdint>

#include <rastrum/raster/rules/make_quadric.hpp>
#include <rastrum/raster/rules/projection.hpp>
#include <rastrum/raster/rules/quadric.hpp>
#include <rastrum/raster/rules/quadrics.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

/// In object space.
struct QuadricPoint {
  Vec3d normal;      ///< outwards, of unit length
  double along = 0;  ///< along the primitive's axis: 0 at its first end, 1 at its second
};

/// `h`: a point on the surface, up to rounding.
[[nodiscard]] QuadricPoint point_on(const QuadricShape& shape, const RayFrame::Point& h);

struct QuadricSurface {
  QuadricShape shape;
  Quadric quadric;
  QuadricPlace place;
  RayFrame rays;

  /// False: none of the primitive can be seen, and nothing is set.
  [[nodiscard]] bool find(const QuadricStage& stage, std::uint64_t primitive, Viewport viewport);
  /// The same for a caller that keeps the stage's eye.
  [[nodiscard]] bool find(const QuadricStage& stage, std::uint64_t primitive,
                          const QuadricEye& eye);

  /// A place on the screen relative to QuadricPlace's, px.
  struct Place {
    double dx, dy;
  };
  /// `from_centre`: px.
  [[nodiscard]] Place at(int x, int y, Vec2 from_centre = {0, 0}) const {
    constexpr double kPx = 1.0 / kSubpixels;
    return {(x + 0.5 + static_cast<double>(from_centre.x)) - place.x[0] * kPx,
            (y + 0.5 + static_cast<double>(from_centre.y)) - place.y[0] * kPx};
  }
  /// The side that faces the viewer or the other one, with coverage's bits.
  [[nodiscard]] scalar_wide::Surface side(bool away, Place p) const {
    return scalar_wide::surface_at(quadric, scalar_wide::QuadricRow(quadric, p.dy), away, p.dx);
  }
  /// Where the ray has depth quadric.depth0 + e.
  [[nodiscard]] RayFrame::Point point(Place p, double e) const {
    return {((rays.o.v + rays.x.v * p.dx) + rays.y.v * p.dy) + rays.depth.v * e,
            ((rays.o.w + rays.x.w * p.dx) + rays.y.w * p.dy) + rays.depth.w * e};
  }
  /// The steepest change of QuadricPoint::along per pixel, at the surface point `h` with attributes
  /// `on`. 0 where the neighbourhood has one place on the axis.
  [[nodiscard]] double along_per_px(const RayFrame::Point& h, const QuadricPoint& on) const;
};

struct QuadricHit {
  Vec3d position;
  QuadricPoint point;
  double along_per_px = 0;
};

/// The point at the centre of pixel (x, y) on the side that has `depth` there. With several samples
/// a pixel: on the side that has it at a sample, and at that sample if the side misses the centre.
/// Without `changes`, along_per_px is not computed.
[[nodiscard]] QuadricHit seen_of(const QuadricSurface& surface, int x, int y, float depth,
                                 int samples, bool changes);

}  // namespace rastrum::raster
