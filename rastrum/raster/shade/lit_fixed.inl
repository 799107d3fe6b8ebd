// SPDX-License-Identifier: BSD-3-Clause
// The arithmetic of the lit shaders under the fixed light. One body in lanes, pairs of lanes or one
// float gives the same bits: where a normal is perpendicular to the view the last bit decides which
// side it faces. Square roots and divisions are exact, since approximate reciprocals differ between
// CPU makers. lit_light.inl adds a frame's lights.

/// Weights of the corners, up to a common positive factor.
struct CornerWeights {
  F b0, b1, b2;

  [[nodiscard]] RASTRUM_LANES V3 sum(const Vec3 (&v)[3]) const {
    return set(v[0]) * b0 + set(v[1]) * b1 + set(v[2]) * b2;
  }
};

/// Weights at (px, py) of a triangle that is not `exact`.
RASTRUM_LANES CornerWeights weights_of(const LitTriangle& t, F px, F py) {
  const F dx = px - set(t.x0), dy = py - set(t.y0);
  const F l1 = set(t.p1) * dx + set(t.q1) * dy;
  const F l2 = set(t.p2) * dx + set(t.q2) * dy;
  return {(set(1) - l1 - l2) * set(t.inv_w[0]), l1 * set(t.inv_w[1]), l2 * set(t.inv_w[2])};
}

/// NaN gives 0.
RASTRUM_LANES F positive(F v) {
  return choose_or_zero(v > set(0), v);
}
/// For a place that the triangle may not cover, where small triangles' weights are wild.
RASTRUM_LANES CornerWeights inside(const CornerWeights& w) {
  return {positive(w.b0), positive(w.b1), positive(w.b2)};
}

/// Equal colours give exactly that colour.
RASTRUM_LANES V3 mixed_color(const CornerWeights& w, const V3& a, const V3& b, const V3& c) {
  const F share = set(1) / (w.b0 + w.b1 + w.b2);
  return a + ((b - a) * (w.b1 * share) + (c - a) * (w.b2 * share));
}
RASTRUM_LANES V3 interpolated_color(const LitTriangle& t, const CornerWeights& w) {
  return mixed_color(w, set(t.color[0]), set(t.color[1]), set(t.color[2]));
}

RASTRUM_LANES V3 unit(const V3& v) {
  const F square = dot(v, v);
  return v * choose(square > set(0), set(1) / square_root(square), set(1));
}

/// The normal on the side that `v`, a unit direction to the viewer, sees.
RASTRUM_LANES V3 turned_to(const V3& v, const V3& facing) {
  const V3 back = -facing;
  return choose(dot(facing, v) < set(0), back, facing);
}
/// Turns a normal of any length into the image's: 0 where it has no direction.
RASTRUM_LANES V3 seen_normal(const ViewRays& rays, F px, F py, const V3& normal) {
  const V3 v = unit(-(set(rays.d) + set(rays.dx) * px + set(rays.dy) * py));
  const V3 n = turned_to(v, unit(normal));
  const auto is_one = dot(normal, normal) > set(0);
  return {choose_or_zero(is_one, n.x), choose_or_zero(is_one, n.y), choose_or_zero(is_one, n.z)};
}
/// Rows times a vector.
RASTRUM_LANES V3 turned(const float (*m)[3], const V3& v) {
  const auto row = [&](int i) { return dot(set(Vec3{m[i][0], m[i][1], m[i][2]}), v); };
  return {row(0), row(1), row(2)};
}
/// (n·h)³² = ((n·u)² / u·u)¹⁶ with u = v + l: the half vector needs no square root.
RASTRUM_LANES F highlight(const V3& n, const V3& v, const V3& l) {
  const V3 u = v + l;
  const F n_u = positive(dot(n, u));
  F s = n_u * n_u / max_of(dot(u, u), set(1e-20F));
  for (int i = 0; i < 4; ++i) s = s * s;
  return s;
}

/// The direction to the viewer, of any length. `along`: along_column() of the column.
RASTRUM_LANES V3 to_viewer(const V3& along, const ViewRays& rays, F py) {
  return -(along + set(rays.dy) * py);
}
/// The part of to_viewer that a column shares.
RASTRUM_LANES V3 along_column(const ViewRays& rays, F px) {
  return set(rays.d) + set(rays.dx) * px;
}

/// Light towards the viewer in direction `view`. `view` and the normal may have any length. Not for
/// `id` and `wireframe`.
RASTRUM_LANES V3 light(Shader model, const V3& view, const V3& normal, const V3& base) {
  if (model == Shader::flat) return base;
  const V3 facing = unit(normal);
  const V3 half = set(Vec3{0.5F, 0.5F, 0.5F});
  if (model == Shader::normal) return facing * half + half;
  const V3 v = unit(view);
  const V3 n = turned_to(v, facing);
  constexpr Vec3 to_light = kLight;  // a device has no address of a namespace's constant
  const V3 l = set(to_light);
  const V3 lit = base * (set(kAmbient) + set(kDiffuse) * positive(dot(n, l)));
  if (model == Shader::lambert) return lit;
  const F specular = highlight(n, v, l) * set(kSpecular);
  return lit + V3{specular, specular, specular};
}
RASTRUM_LANES V3 light(Shader model, const ViewRays& rays, F px, F py, const V3& normal,
                       const V3& base) {
  return light(model, to_viewer(along_column(rays, px), rays, py), normal, base);
}
