// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/rules/quadric_surface.hpp>

#include <algorithm>
#include <cmath>

#include <rastrum/raster/rules/samples.hpp>

namespace rastrum::raster {
namespace {

Vec3d unit_or(Vec3d v, Vec3d otherwise) {
  const double n = length(v);
  return n > 0 ? v * (1 / n) : otherwise;
}

}  // namespace

QuadricPoint point_on(const QuadricShape& shape, const RayFrame::Point& h) {
  const Vec3d p = (h.v - shape.p0 * h.w) * (1 / h.w);  // from p0
  if (shape.kind == QuadricKind::disc) return {shape.p1, 0};
  if (shape.kind == QuadricKind::sphere) return {unit_or(p, {0, 0, 1}), shape.along};
  const Vec3d between = shape.p1 - shape.p0;
  const double distance = length(between);
  const Vec3d axis = between * (1 / distance);
  const double t = dot(p, axis);
  const Vec3d across = p - axis * t;
  const double radius = length(across);
  const Vec3d outwards = unit_or(across, {0, 0, 0});
  if (shape.kind == QuadricKind::hull) {
    const double sine = (shape.r0 - shape.r1) / distance;
    const double cosine = std::sqrt((1 - sine) * (1 + sine));
    // Where the cone's normal at the point meets the axis.
    const double foot = t - radius * sine / cosine;
    if (foot <= 0) return {unit_or(p, axis * -1), 0};
    if (foot >= distance) return {unit_or(p - between, axis), 1};
    return {outwards * cosine + axis * sine, foot / distance};
  }
  const double slope = (shape.r1 - shape.r0) / distance;
  const double along = std::clamp(t / distance, 0.0, 1.0);
  const double off_side = std::abs(radius - (shape.r0 + slope * t)) / std::sqrt(1 + slope * slope);
  if (shape.kind == QuadricKind::cone && std::min(std::abs(t), std::abs(distance - t)) < off_side)
    return {axis * (t < 0.5 * distance ? -1.0 : 1.0), along};
  return {unit_or(outwards - axis * slope, axis), along};
}

bool QuadricSurface::find(const QuadricStage& stage, std::uint64_t primitive, Viewport viewport) {
  return stage.clip_to_object() != nullptr && find(stage, primitive, QuadricEye(stage, viewport));
}
bool QuadricSurface::find(const QuadricStage& stage, std::uint64_t primitive,
                          const QuadricEye& eye) {
  return stage.shape(primitive, shape) == ShapeFate::drawn &&
         make_quadric(eye, shape, quadric, place, &rays);
}

double QuadricSurface::along_per_px(const RayFrame::Point& h, const QuadricPoint& on) const {
  if (!has_two_ends(shape.kind)) return 0;
  const Vec3d between = shape.p1 - shape.p0;
  const double distance = length(between);
  const Vec3d axis = between * (1 / distance);
  double per_length = 1 / distance;  // along the axis, per length along the surface
  if (shape.kind == QuadricKind::hull) {
    if (on.along == 0 || on.along == 1) return 0;  // the balls
    const double sine = (shape.r0 - shape.r1) / distance;
    per_length = per_length / ((1 - sine) * (1 + sine));
  } else if (on.normal == axis || on.normal == axis * -1) {
    return 0;  // the flat ends
  }
  // The point moves with the ray and along it, so it stays on the surface's tangent plane.
  const Vec3d p = h.v * (1 / h.w);
  const Vec3d by_depth = rays.depth.v - p * rays.depth.w;
  const double off_plane = dot(on.normal, by_depth);
  const auto change = [&](const RayFrame::Point& by) {
    const Vec3d across = by.v - p * by.w;
    const Vec3d moved = across - by_depth * (dot(on.normal, across) / off_plane);
    return dot(axis, moved) / h.w * per_length;
  };
  const double dx = change(rays.x), dy = change(rays.y);
  return std::sqrt(dx * dx + dy * dy);
}

QuadricHit seen_of(const QuadricSurface& surface, int x, int y, float depth, int samples,
                   bool changes) {
  using Place = QuadricSurface::Place;
  const auto hit = [&](Place at, double e) {
    const RayFrame::Point h = surface.point(at, e);
    const QuadricPoint on = point_on(surface.shape, h);
    return QuadricHit{h.v * (1 / h.w), on, changes ? surface.along_per_px(h, on) : 0};
  };
  const Place centre = surface.at(x, y);
  constexpr float kPx = 1.0F / kSubpixels;
  for (const SampleOffset& sample : sample_offsets(samples)) {
    const Place at =
        surface.at(x, y, {static_cast<float>(sample.x) * kPx, static_cast<float>(sample.y) * kPx});
    for (const bool away : {false, true}) {
      const scalar_wide::Surface s = surface.side(away, at);
      if (!s.covered || quadric_depth(surface.quadric, s.e) != depth) continue;
      const scalar_wide::Surface here = surface.side(away, centre);
      return here.covered ? hit(centre, here.e) : hit(at, s.e);
    }
  }
  return hit(centre, surface.side(false, centre).e);
}

}  // namespace rastrum::raster
