// SPDX-License-Identifier: BSD-3-Clause
// Balls and cones to their place in the picture and to a quadric's coefficients. One body with a
// fixed order of float64 operations serves one primitive (make_quadric.cpp) and lanes
// (kernels/wide_lanes-inl.hpp), so the bits are the same.

RASTRUM_LANES W clamped(W v, W least, W most) {
  return choose(below(v, least), least, choose(below(most, v), most, v));
}

/// A ball in front of the eye, or across it.
struct WideBall {
  WideVec centre;
  W radius;
};
RASTRUM_LANES W row_at(const QuadricEye::Row& row, const WideVec& p) {
  return dot(wide(row.v), p) + wide(row.w);
}

struct WideRange {
  W least, most;
};
RASTRUM_LANES WideRange united(const WideRange& a, const WideRange& b) {
  return {lesser(a.least, b.least), greater(a.most, b.most)};
}
/// The range of row / w over a ball that is ahead. At its ends a plane row − X w = 0 touches the
/// ball: a quadratic in X, whose discriminant is written so that nothing cancels.
RASTRUM_LANES WideRange range_of(const WideBall& ball, const QuadricEye::Row& row,
                                 const QuadricEye::Row& w) {
  const W n = row_at(row, ball.centre), d = row_at(w, ball.centre);
  const W r2 = ball.radius * ball.radius;
  const WideVec m = wide(row.v) * d - wide(w.v) * n;
  const W square = dot(m, m) - r2 * wide(row.cross_w);
  const W root = ball.radius * square_root(choose(at_most(wide(0), square), square, wide(0)));
  const W middle = n * d - r2 * wide(row.dot_w);
  const W scale = wide(1) / (d * d - r2 * wide(w.dot_w));
  return {(middle - root) * scale, (middle + root) * scale};
}

/// The ball around one end, or all balls together.
struct WideEnd {
  WideMask is_hidden;  ///< behind the near plane
  WideMask asks_near;  ///< the near plane may cut it
  WideMask is_ahead;   ///< all of it has w > 0; else the ranges say nothing
  WideRange x, y, z;   ///< over w
};
RASTRUM_LANES WideEnd end_of(const QuadricEye& eye, const WideBall& ball) {
  const W reach = ball.radius * wide(eye.before.length), at = row_at(eye.before, ball.centre);
  return {below(reach, at),
          opposite(below(at, (wide(0) - reach) * wide(1 + 1e-9))),
          below(ball.radius * wide(eye.w.length) * wide(1 + 1e-9), row_at(eye.w, ball.centre)),
          range_of(ball, eye.x, eye.w),
          range_of(ball, eye.y, eye.w),
          range_of(ball, eye.z, eye.w)};
}
RASTRUM_LANES WideEnd united(const WideEnd& a, const WideEnd& b) {
  return {both(a.is_hidden, b.is_hidden),
          either(a.asks_near, b.asks_near),
          both(a.is_ahead, b.is_ahead),
          united(a.x, b.x),
          united(a.y, b.y),
          united(a.z, b.z)};
}

/// A primitive's place in the picture. Box and depths are those of the balls about its ends.
struct WidePlace {
  WideMask is_hidden, asks_near;
  WideMask is_ahead;  ///< else the box is the picture
  WideMask is_seen;   ///< the box meets the picture
  WideRange across, down, depths;
  W x, y;    ///< the quadric's origin, n.8, whole: the box's middle or, if out of sight, another
             ///< point of it
  W depth0;  ///< its depth
  W reach;   ///< range of depths over the primitive
};
RASTRUM_LANES WidePlace place_of(const QuadricEye& eye, const WideBall& first,
                                 const WideBall* second) {
  WideEnd ends = end_of(eye, first);
  if (second != nullptr) ends = united(ends, end_of(eye, *second));
  WidePlace p{};
  p.is_hidden = ends.is_hidden;
  p.asks_near = ends.asks_near;
  p.is_ahead = ends.is_ahead;
  const W zero = wide(0), one = wide(1);
  const W hw = wide(eye.half_width), hh = wide(eye.half_height);
  const W right = wide(2 * eye.half_width), bottom = wide(2 * eye.half_height);
  const auto if_ahead = [&](W v, W otherwise)
                            RASTRUM_LAMBDA { return choose(p.is_ahead, v, otherwise); };
  p.across = {if_ahead(greater(zero, (ends.x.least + one) * hw), zero),
              if_ahead(lesser(right, (ends.x.most + one) * hw), right)};
  p.down = {if_ahead(greater(zero, (one - ends.y.most) * hh), zero),
            if_ahead(lesser(bottom, (one - ends.y.least) * hh), bottom)};
  p.depths = {if_ahead(ends.z.least, zero), if_ahead(ends.z.most, one)};
  p.is_seen = both(at_most(p.across.least, p.across.most), at_most(p.down.least, p.down.most));

  const WideVec middle =
      second == nullptr ? first.centre : (first.centre + second->centre) * wide(0.5);
  const W inverse_w = one / row_at(eye.w, middle);
  const auto told = [&](W at, const WideRange& box) RASTRUM_LAMBDA {
    return if_ahead(clamped(at, box.least, box.most), (box.least + box.most) * wide(0.5));
  };
  const W x = told((row_at(eye.x, middle) * inverse_w + one) * hw, p.across);
  const W y = told((one - row_at(eye.y, middle) * inverse_w) * hh, p.down);
  p.x = floor_of(x * wide(kSubpixels) + wide(0.5));
  p.y = floor_of(y * wide(kSubpixels) + wide(0.5));
  p.depth0 = if_ahead(row_at(eye.z, middle) * inverse_w, one);
  p.reach = if_ahead(greater(p.depths.most - p.depths.least, wide(1e-30)), one);
  return p;
}
/// The box as two corners, n.8.
RASTRUM_LANES WideRange corners_of(const WideRange& px) {
  return {floor_of(px.least * wide(kSubpixels) - wide(1)),
          floor_of(px.most * wide(kSubpixels) + wide(2))};
}
RASTRUM_LANES WideRange bounds_of(const WideRange& depths) {
  const W margin = wide(1e-6) * depths.most;
  return {clamped(depths.least - margin, wide(0), wide(1)),
          clamped(depths.most + margin, wide(0), wide(1))};
}

/// RayFrame.
struct WidePoint {
  WideVec v;
  W w;
};
RASTRUM_LANES WidePoint operator+(const WidePoint& a, const WidePoint& b) {
  return {a.v + b.v, a.w + b.w};
}
RASTRUM_LANES WidePoint operator*(const WidePoint& a, W s) {
  return {a.v * s, a.w * s};
}
struct WideRays {
  WidePoint o, x, y, depth;
};
/// The picture's rays, with their origin at a place and a depth.
RASTRUM_LANES WideRays rays_of(const QuadricEye& eye, W x_fx8, W y_fx8, W depth0) {
  const auto column = [&](int i) RASTRUM_LAMBDA {
    return WidePoint{wide(eye.column[i].v), wide(eye.column[i].w)};
  };
  const W px = wide(1.0 / kSubpixels), one = wide(1);
  const W hw = wide(eye.half_width), hh = wide(eye.half_height);
  const WidePoint o = (column(0) * (x_fx8 * px / hw - one) + column(1) * (one - y_fx8 * px / hh)) +
                      (column(2) * depth0 + column(3));
  const W scale = one / o.w;
  return {o * scale, column(0) * (scale / hw), column(1) * ((wide(0) - scale) / hh),
          column(2) * scale};
}

/// Linear over the rays of a picture: o + x · dx + y · dy + depth · e.
struct WideLinear {
  W o, x, y, depth;
};
RASTRUM_LANES WideLinear operator+(const WideLinear& a, const WideLinear& b) {
  return {a.o + b.o, a.x + b.x, a.y + b.y, a.depth + b.depth};
}
RASTRUM_LANES WideLinear operator-(const WideLinear& a, const WideLinear& b) {
  return {a.o - b.o, a.x - b.x, a.y - b.y, a.depth - b.depth};
}
RASTRUM_LANES WideLinear operator*(const WideLinear& a, W s) {
  return {a.o * s, a.x * s, a.y * s, a.depth * s};
}
RASTRUM_LANES WideLinear w_of(const WideRays& f) {
  return {f.o.w, f.x.w, f.y.w, f.depth.w};
}

struct WideLinearVec {
  WideVec o, x, y, depth;
};
RASTRUM_LANES WideLinearVec operator*(const WideLinearVec& a, W s) {
  return {a.o * s, a.x * s, a.y * s, a.depth * s};
}
RASTRUM_LANES WideLinear along(const WideLinearVec& a, const WideVec& axis) {
  return {dot(a.o, axis), dot(a.x, axis), dot(a.y, axis), dot(a.depth, axis)};
}
RASTRUM_LANES WideLinearVec without(const WideLinearVec& a, const WideVec& axis) {
  const auto rest = [&](const WideVec& v) RASTRUM_LAMBDA { return v - axis * dot(v, axis); };
  return {rest(a.o), rest(a.x), rest(a.y), rest(a.depth)};
}
/// Relative to a point, times w (homogeneous).
RASTRUM_LANES WideLinearVec from(const WideRays& f, const WideVec& p) {
  return {f.o.v - p * f.o.w, f.x.v - p * f.x.w, f.y.v - p * f.y.w, f.depth.v - p * f.depth.w};
}

/// QuadricPart.
struct WideLimit {
  W at, x, y;
  WideMask is_least;
};
struct WidePart {
  W b, bx, by, d, dx, dy, dxx, dxy, dyy, inverse_a;
  WideLimit limits[2];
};

/// A quadratic form |s|² − ρ² of rays, about 1 in size. `reach`: depth range of the primitive.
/// With A = |s_e|² − ρ_e² and B_i = s_e · s_i − ρ_e ρ_i, D_ij = B_i B_j − A C_ij is (ρ_e s_i − ρ_i
/// s_e) · (ρ_e s_j − ρ_j s_e) − (s_e × s_i) · (s_e × s_j), where nothing cancels.
RASTRUM_LANES void set_form(const WideLinearVec& s, const WideLinear& rho, W reach,
                            WidePart& part) {
  const WideVec v[3] = {s.o, s.x, s.y};
  const W r[3] = {rho.o, rho.x, rho.y};
  const W re = rho.depth;
  W b[3], d[3][3];
  WideVec m[3] = {}, k[3] = {};
  for (int i = 0; i < 3; ++i) {
    b[i] = dot(s.depth, v[i]) - re * r[i];
    m[i] = v[i] * re - s.depth * r[i];
    k[i] = cross(s.depth, v[i]);
  }
  W a = dot(s.depth, s.depth) - re * re;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) d[i][j] = dot(m[i], m[j]) - dot(k[i], k[j]);
  // The eye is on the surface, or rays run along the axis. Just inside is as good and has two
  // roots.
  const W least = wide(1e-10) / (reach * reach);
  const WideMask is_flat = opposite(below(least, absolute(a)));
  if (is_any(is_flat)) {
    a = choose(is_flat, wide(0) - least, a);
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j)
        d[i][j] = choose(is_flat, b[i] * b[j] - a * (dot(v[i], v[j]) - r[i] * r[j]), d[i][j]);
  }
  const W two = wide(2);
  part.b = b[0];
  part.bx = b[1];
  part.by = b[2];
  part.d = d[0][0];
  part.dx = two * d[0][1];
  part.dy = two * d[0][2];
  part.dxx = d[1][1];
  part.dxy = two * d[1][2];
  part.dyy = d[2][2];
  part.inverse_a = wide(1) / a;
}

RASTRUM_LANES WidePart ball_part(const WideRays& rays, const WideBall& ball, W reach) {
  WidePart part{};
  set_form(from(rays, ball.centre) * (wide(1) / ball.radius), w_of(rays), reach, part);
  return part;
}

/// Where g ≥ 0. A plane that contains the rays is tilted a little.
struct FoundLimit {
  WideLimit limit;
  WideMask crosses;  ///< it did not contain them
};
RASTRUM_LANES FoundLimit limit_of(WideLinear g, W reach) {
  const W least = wide(1e-12) * greater(absolute(g.o), wide(1e-3)) / reach;
  const WideMask crosses = at_most(least, absolute(g.depth));
  g.depth = choose(crosses, g.depth, choose(below(g.depth, wide(0)), wide(0) - least, least));
  const W scale = wide(-1) / g.depth;
  return {{g.o * scale, g.x * scale, g.y * scale, below(wide(0), g.depth)}, crosses};
}

/// The cone between two points with radii r0 and r1. Requires w > 0 between its ends.
RASTRUM_LANES WidePart cone_part(const WideRays& rays, const WideBall& first,
                                 const WideBall& second, W reach) {
  WidePart part{};
  const WideVec between = second.centre - first.centre;
  const W r0 = first.radius, r1 = second.radius;
  const WideVec middle = (first.centre + second.centre) * wide(0.5);
  const W half = square_root(dot(between, between)) * wide(0.5);
  const WideVec axis = between * (wide(0.5) / half);
  const WideLinearVec v = from(rays, middle);
  const WideLinear h = along(v, axis), w = w_of(rays);
  const W scale = wide(1) / greater(r0, r1);
  const WideLinear rho = w * ((r0 + r1) * wide(0.5)) + h * ((r1 - r0) * wide(0.5) / half);
  set_form(without(v, axis) * scale, rho * scale, reach, part);
  const WideLinear g = h * (wide(1) / half);
  part.limits[0] = limit_of(w + g, reach).limit;
  part.limits[1] = limit_of(w - g, reach).limit;
  return part;
}

/// The cone that touches two balls, between the circles of contact.
struct TouchingCone {
  WideBall first, second;
};
RASTRUM_LANES TouchingCone touching_cone(const WideBall& first, const WideBall& second) {
  const WideVec between = second.centre - first.centre;
  const W r0 = first.radius, r1 = second.radius;
  const W distance = square_root(dot(between, between));
  const WideVec axis = between * (wide(1) / distance);
  const W sine = (r0 - r1) / distance;
  const W cosine = square_root((wide(1) - sine) * (wide(1) + sine));
  return {{first.centre + axis * (r0 * sine), r0 * cosine},
          {second.centre + axis * (r1 * sine), r1 * cosine}};
}
