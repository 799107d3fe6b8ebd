// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/rules/make_quadric.hpp>

#include <cmath>
#include <initializer_list>

namespace rastrum::raster {
namespace scalar_wide {

#define RASTRUM_LANES inline
#define RASTRUM_LAMBDA
#include <rastrum/raster/rules/quadric_form.inl>
#undef RASTRUM_LAMBDA
#undef RASTRUM_LANES

}  // namespace scalar_wide

namespace {

using scalar_wide::WideBall;

void add_limit(QuadricPart& part, const scalar_wide::WideLimit& l) {
  part.limits[part.limit_count++] = {l.at, l.x, l.y, l.is_least};
}

QuadricPart& add_part(Quadric& q, const scalar_wide::WidePart& p) {
  QuadricPart& part = q.part[q.part_count++];
  part = {p.b, p.bx, p.by, p.d, p.dx, p.dy, p.dxx, p.dxy, p.dyy, p.inverse_a, {}, 0};
  return part;
}

void add_ball(Quadric& q, const scalar_wide::WideRays& rays, const WideBall& ball, double reach,
              bool asks_eye) {
  QuadricPart& part = add_part(q, scalar_wide::ball_part(rays, ball, reach));
  // Cuts off what is behind the eye.
  if (asks_eye) add_limit(part, scalar_wide::limit_of(scalar_wide::w_of(rays), reach).limit);
}

/// False: seen edge-on.
bool add_disc(Quadric& q, const scalar_wide::WideRays& rays, const WideBall& ball, Vec3d normal,
              double reach, bool asks_eye) {
  add_ball(q, rays, ball, reach, asks_eye);
  QuadricPart& part = q.part[q.part_count - 1];
  const auto g = scalar_wide::along(scalar_wide::from(rays, ball.centre), normal);
  scalar_wide::FoundLimit found = scalar_wide::limit_of(g * (1 / ball.radius), reach);
  add_limit(part, found.limit);
  // The exact negative, so that both have one depth.
  found.limit.is_least = !found.limit.is_least;
  add_limit(part, found.limit);
  return found.crosses;
}

void add_cone(Quadric& q, const scalar_wide::WideRays& rays, const WideBall& first,
              const WideBall& second, double reach) {
  const scalar_wide::WidePart cone = scalar_wide::cone_part(rays, first, second, reach);
  QuadricPart& part = add_part(q, cone);
  for (const scalar_wide::WideLimit& limit : cone.limits) add_limit(part, limit);
}

bool is_finite(const Quadric& q) {
  double sum = q.depth0;
  for (std::uint32_t k = 0; k < q.part_count; ++k) {
    const QuadricPart& p = q.part[k];
    sum += p.b + p.bx + p.by + p.d + p.dx + p.dy + p.dxx + p.dxy + p.dyy + p.inverse_a;
    for (std::uint32_t i = 0; i < p.limit_count; ++i)
      sum += p.limits[i].at + p.limits[i].x + p.limits[i].y;
  }
  return std::isfinite(sum);
}

RayFrame::Point point_of(const scalar_wide::WidePoint& p) {
  return {p.v, p.w};
}

}  // namespace

QuadricEye::QuadricEye(const QuadricStage& stage, Viewport viewport)
    : half_width(static_cast<double>(viewport.half_width)),
      half_height(static_cast<double>(viewport.half_height)) {
  const auto& m = stage.object_to_clip().m;
  Row* const rows[] = {&x, &y, &z, &w};
  for (int i = 0; i < 4; ++i) {
    rows[i]->v = {m[i][0], m[i][1], m[i][2]};
    rows[i]->w = m[i][3];
  }
  before.v = z.v - w.v;
  before.w = z.w - w.w;
  for (Row* const row : {&x, &y, &z, &w, &before}) {
    const Vec3d c = cross(row->v, w.v);
    row->length = length(row->v);
    row->cross_w = dot(c, c);
    row->dot_w = dot(row->v, w.v);
  }
  const auto& n = stage.clip_to_object()->m;
  for (int i = 0; i < 4; ++i) column[i] = {{n[0][i], n[1][i], n[2][i]}, n[3][i]};
}

bool make_quadric(const QuadricEye& eye, const QuadricShape& shape, Quadric& q, QuadricPlace& place,
                  RayFrame* wanted) {
  const WideBall first{shape.p0, shape.r0}, second{shape.p1, shape.r1};
  const scalar_wide::WidePlace p =
      scalar_wide::place_of(eye, first, has_two_ends(shape.kind) ? &second : nullptr);
  if (p.is_hidden || !p.is_seen) return false;
  place.asks_near = p.asks_near;
  const auto corners = [](const scalar_wide::WideRange& px, double at, std::int32_t(&out)[3]) {
    const scalar_wide::WideRange corner = scalar_wide::corners_of(px);
    out[0] = static_cast<std::int32_t>(at);
    out[1] = static_cast<std::int32_t>(corner.least);
    out[2] = static_cast<std::int32_t>(corner.most);
  };
  corners(p.across, p.x, place.x);
  corners(p.down, p.y, place.y);
  const scalar_wide::WideRange depths = scalar_wide::bounds_of(p.depths);
  q.depth0 = p.depth0;
  q.nearest = 1 - q.depth0;
  q.lowest = static_cast<float>(depths.least);
  q.highest = static_cast<float>(depths.most);
  const scalar_wide::WideRays rays = scalar_wide::rays_of(eye, p.x, p.y, p.depth0);
  if (wanted != nullptr)
    *wanted = {point_of(rays.o), point_of(rays.x), point_of(rays.y), point_of(rays.depth)};

  q.part_count = 0;
  q.is_open = shape.kind == QuadricKind::open_cone;
  switch (shape.kind) {
    case QuadricKind::sphere:
      add_ball(q, rays, first, p.reach, !p.is_ahead);
      break;
    case QuadricKind::disc:
      if (!add_disc(q, rays, first, shape.p1, p.reach, !p.is_ahead)) return false;
      place.front = q.part[0].limits[q.part[0].limit_count - 2].is_least;
      break;
    case QuadricKind::cone:
    case QuadricKind::open_cone:
      add_cone(q, rays, first, second, p.reach);
      break;
    case QuadricKind::hull: {
      for (const WideBall& ball : {first, second})
        if (ball.radius > 0) add_ball(q, rays, ball, p.reach, !p.is_ahead);
      const scalar_wide::TouchingCone cone = scalar_wide::touching_cone(first, second);
      add_cone(q, rays, cone.first, cone.second, p.reach);
      break;
    }
  }
  q.is_plain =
      shape.kind == QuadricKind::sphere && p.is_ahead && !p.asks_near && q.part[0].inverse_a > 0;
  return is_finite(q);
}

}  // namespace rastrum::raster
