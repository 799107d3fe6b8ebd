// SPDX-License-Identifier: BSD-3-Clause
// A quadric that is found again by its primitive, for who asks about single points of its surface:
// shading, clip planes, what is under a pixel. From the primitive, the whole picture and the point
// alone, in float64 and one written order, so the same bits whoever asks.
#pragma once

#include <cstdint>

#include <rastrum/raster/rules/make_quadric.hpp>
#include <rastrum/raster/rules/projection.hpp>
#include <rastrum/raster/rules/quadric.hpp>
#include <rastrum/raster/rules/quadrics.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

/// Attributes of a point of a shape's surface beside its place, in object space.
struct QuadricPoint {
  Vec3d normal;      ///< outwards, of unit length
  double along = 0;  ///< of the primitive's axis, from 0 at its first end to 1
};

/// The point of the shape that is `h`, on its surface but for rounding.
[[nodiscard]] QuadricPoint point_on(const QuadricShape& shape, const RayFrame::Point& h);

struct QuadricSurface {
  QuadricShape shape;
  Quadric quadric;
  QuadricPlace place;
  RayFrame rays;

  /// Whether any of the primitive may be seen; then sets all.
  [[nodiscard]] bool find(const QuadricStage& stage, std::uint64_t primitive, Viewport viewport);
  /// The same for who keeps the stage's eye.
  [[nodiscard]] bool find(const QuadricStage& stage, std::uint64_t primitive,
                          const QuadricEye& eye);

  /// A place on the screen, from QuadricPlace's.
  struct Place {
    double dx, dy;
  };
  /// `from_centre` px from the centre of pixel (x, y).
  [[nodiscard]] Place at(int x, int y, Vec2 from_centre = {0, 0}) const {
    constexpr double kPx = 1.0 / kSubpixels;
    return {(x + 0.5 + static_cast<double>(from_centre.x)) - place.x[0] * kPx,
            (y + 0.5 + static_cast<double>(from_centre.y)) - place.y[0] * kPx};
  }
  /// The side that faces the viewer, or the other one, as coverage has it.
  [[nodiscard]] scalar_wide::Surface side(bool away, Place p) const {
    return scalar_wide::surface_at(quadric, scalar_wide::QuadricRow(quadric, p.dy), away, p.dx);
  }
  /// Where the ray has depth quadric.depth0 + e.
  [[nodiscard]] RayFrame::Point point(Place p, double e) const {
    return {((rays.o.v + rays.x.v * p.dx) + rays.y.v * p.dy) + rays.depth.v * e,
            ((rays.o.w + rays.x.w * p.dx) + rays.y.w * p.dy) + rays.depth.w * e};
  }
  /// How much QuadricPoint::along changes from pixel to pixel along its steepest way, at the point
  /// `h` of the surface, of which `on` is known; 0 where all about it belongs to one place of the
  /// axis.
  [[nodiscard]] double along_per_px(const RayFrame::Point& h, const QuadricPoint& on) const;
};

/// A point of what is seen of a quadric, in object space.
struct QuadricHit {
  Vec3d position;
  QuadricPoint point;
  double along_per_px = 0;
};

/// The point at the centre of pixel (x, y) whose side has `depth` there; of a picture of several
/// samples a pixel it is the side that has it at a sample, and the point at that sample where the
/// side does not cover the centre. Without `changes` nobody asks for along_per_px.
[[nodiscard]] QuadricHit seen_of(const QuadricSurface& surface, int x, int y, float depth,
                                 int samples, bool changes);

}  // namespace rastrum::raster
