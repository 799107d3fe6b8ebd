// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/surface_oracle.hpp"

#include <algorithm>
#include <cmath>

namespace rastrum::test {
namespace surface_oracle {

struct Ray {
  Point3 from, along;
  [[nodiscard]] Point3 at(Real t) const { return from + along * t; }
};

/// Solves columns · q = v by Cramer's rule.
Point3 solve(const Point3 (&c)[3], const Point3& v) {
  const Real d = dot(c[0], cross(c[1], c[2]));
  return {dot(v, cross(c[1], c[2])) / d, dot(c[0], cross(v, c[2])) / d,
          dot(c[0], cross(c[1], v)) / d};
}

void add_roots(Real a, Real half_b, Real c, std::vector<Real>& roots) {
  const Real d = half_b * half_b - a * c;
  if (d < 0) return;
  if (a == 0) {
    if (half_b != 0) roots.push_back(-c / (2 * half_b));
    return;
  }
  const Real q = -(half_b + (half_b < 0 ? -std::sqrt(d) : std::sqrt(d)));
  roots.push_back(q / a);
  if (q != 0) roots.push_back(c / q);
}

void add_ball_roots(const Ray& r, const Point3& c, Real radius, std::vector<Real>& roots) {
  const Point3 o = r.from - c;
  add_roots(dot(r.along, r.along), dot(o, r.along), dot(o, o) - radius * radius, roots);
}

/// A cone's frame: distance along the axis and from it, as functions of the ray's parameter.
struct Axis {
  Point3 origin, unit;
  Real size;

  Axis(const Point3& a, const Point3& b)
      : origin(a), unit((b - a) * (1 / length(b - a))), size(length(b - a)) {}
  [[nodiscard]] Real height(const Point3& p) const { return dot(p - origin, unit); }
  [[nodiscard]] Point3 across(const Point3& p) const { return (p - origin) - unit * height(p); }
};

void add_cone_roots(const Ray& r, const Axis& axis, Real r0, Real slope, std::vector<Real>& roots) {
  const Point3 o = axis.across(r.from);
  const Point3 d = r.along - axis.unit * dot(r.along, axis.unit);
  const Real at = r0 + slope * axis.height(r.from), change = slope * dot(r.along, axis.unit);
  add_roots(dot(d, d) - change * change, dot(o, d) - at * change, dot(o, o) - at * at, roots);
}

void add_plane_root(const Ray& r, const Point3& p, const Point3& n, std::vector<Real>& roots) {
  const Real d = dot(r.along, n);
  if (d != 0) roots.push_back(dot(p - r.from, n) / d);
}

bool in_ball(const Point3& p, const Point3& c, Real radius) {
  return dot(p - c, p - c) <= radius * radius;
}

/// Round cone: the nearest of the balls about the axis.
struct Tube {
  const SurfacePrimitive& s;
  Axis axis;

  explicit Tube(const SurfacePrimitive& p) : s(p), axis(p.p0, p.p1) {}
  [[nodiscard]] bool one_ball() const { return axis.size <= std::abs(s.r1 - s.r0); }
  /// The place on the axis, from 0 to 1, of the ball nearest to `p`.
  [[nodiscard]] Real foot(const Point3& p) const {
    if (one_ball()) return s.r1 > s.r0 ? 1 : 0;
    const Real rho = length(axis.across(p));
    const Real sine = (s.r0 - s.r1) / axis.size;
    const Real f = axis.height(p) - rho * sine / std::sqrt(1 - sine * sine);
    return std::clamp<Real>(f / axis.size, 0, 1);
  }
  [[nodiscard]] bool holds(const Point3& p) const {
    const Real f = foot(p);
    return in_ball(p, s.p0 + (s.p1 - s.p0) * f, s.r0 + (s.r1 - s.r0) * f);
  }
};

bool inside(const SurfacePrimitive& s, const Point3& p) {
  if (s.kind == SurfaceKind::sphere) return in_ball(p, s.p0, s.r0);
  if (s.kind == SurfaceKind::tube) return Tube(s).holds(p);
  const Axis axis(s.p0, s.p1);
  const Real h = axis.height(p);
  if (h < 0 || h > axis.size) return false;
  return in_ball(axis.across(p), {}, s.r0 + (s.r1 - s.r0) * h / axis.size);
}

/// Outward, in object space.
Point3 normal_of(const SurfacePrimitive& s, const Point3& p) {
  if (s.kind == SurfaceKind::disc) return s.p1;
  if (s.kind == SurfaceKind::sphere) return p - s.p0;
  if (s.kind == SurfaceKind::tube) return p - (s.p0 + (s.p1 - s.p0) * Tube(s).foot(p));
  const Axis axis(s.p0, s.p1);
  const Real h = axis.height(p), slope = (s.r1 - s.r0) / axis.size;
  const Point3 v = axis.across(p);
  const Real rho = length(v);
  const Real side = std::abs(rho - s.r0 - slope * h);
  if (s.kind == SurfaceKind::closed_cone) {
    const Real low = std::abs(h), high = std::abs(h - axis.size);
    if (std::min(low, high) < side) return axis.unit * (low < high ? -1 : 1);
  }
  return v * (1 / rho) - axis.unit * slope;
}

/// The place on the axis that a surface point belongs to.
Real along_of(const SurfacePrimitive& s, const Point3& p) {
  if (s.kind == SurfaceKind::tube) return Tube(s).foot(p);
  if (s.kind != SurfaceKind::closed_cone && s.kind != SurfaceKind::open_cone) return 0;
  const Axis axis(s.p0, s.p1);
  return std::clamp<Real>(axis.height(p) / axis.size, 0, 1);
}

bool is_kept(const SurfacePrimitive& s, const Point3& object, const Point3& world) {
  return std::all_of(s.planes.begin(), s.planes.end(), [&](const OraclePlane& p) {
    return dot(p.normal, p.in_object_space ? object : world) + p.offset >= 0;
  });
}

struct Crossing {
  Real t;
  bool enters;
};

std::vector<Crossing> crossings(const SurfacePrimitive& s, const Ray& r) {
  std::vector<Real> roots;
  std::vector<Crossing> result;
  const Real slope = (s.r1 - s.r0) / length(s.p1 - s.p0);
  switch (s.kind) {
    case SurfaceKind::disc:
      add_plane_root(r, s.p0, s.p1, roots);
      for (const Real t : roots)
        if (in_ball(r.at(t), s.p0, s.r0)) result.push_back({t, dot(r.along, s.p1) < 0});
      return result;
    case SurfaceKind::triangle: {
      const Point3 n = cross(s.p1 - s.p0, s.p2 - s.p0);
      add_plane_root(r, s.p0, n, roots);
      for (const Real t : roots) {
        const Point3 p = r.at(t);
        const auto left = [&](const Point3& a, const Point3& b) {
          return dot(cross(b - a, p - a), n) >= 0;
        };
        if (left(s.p0, s.p1) && left(s.p1, s.p2) && left(s.p2, s.p0))
          result.push_back({t, dot(r.along, n) < 0});
      }
      return result;
    }
    case SurfaceKind::open_cone: {
      const Axis axis(s.p0, s.p1);
      add_cone_roots(r, axis, s.r0, slope, roots);
      for (const Real t : roots) {
        const Real h = axis.height(r.at(t));
        if (h < 0 || h > axis.size) continue;
        const Point3 n = normal_of(s, r.at(t));
        result.push_back({t, dot(r.along, n) < 0});
      }
      return result;
    }
    case SurfaceKind::sphere:
      add_ball_roots(r, s.p0, s.r0, roots);
      break;
    case SurfaceKind::closed_cone: {
      const Axis axis(s.p0, s.p1);
      add_cone_roots(r, axis, s.r0, slope, roots);
      add_plane_root(r, s.p0, axis.unit, roots);
      add_plane_root(r, s.p1, axis.unit, roots);
      break;
    }
    case SurfaceKind::tube: {
      add_ball_roots(r, s.p0, s.r0, roots);
      add_ball_roots(r, s.p1, s.r1, roots);
      const Tube tube(s);
      if (tube.axis.size > 0 && !tube.one_ball()) {
        // The cone that touches both: its apex angle's sine is (r0 − r1) / length.
        const Real sine = (s.r0 - s.r1) / tube.axis.size, cosine = std::sqrt(1 - sine * sine);
        add_cone_roots(r, tube.axis, s.r0 / cosine, -sine / cosine, roots);
      }
      break;
    }
  }
  // Points between the roots decide what is inside, which is one interval.
  std::sort(roots.begin(), roots.end());
  for (std::size_t i = 0; i + 1 < roots.size(); ++i) {
    if (roots[i] == roots[i + 1] || !inside(s, r.at((roots[i] + roots[i + 1]) / 2))) continue;
    if (result.empty()) result.push_back({roots[i], true});
    if (result.size() == 2) result.pop_back();
    result.push_back({roots[i + 1], false});
  }
  return result;
}

}  // namespace surface_oracle

std::vector<SurfaceHit> surfaces_at(const OracleCamera& c,
                                    const std::vector<SurfacePrimitive>& scene, Real x_px,
                                    Real y_px) {
  using namespace surface_oracle;
  const Real x = (x_px - Real(c.width) / 2) * c.px_scale;
  const Real y = (Real(c.height) / 2 - y_px) * c.px_scale;
  // The parameter is the distance along the view's axis.
  const Point3 sideways = c.right * x + c.up * y;
  const Ray world =
      c.orthographic ? Ray{c.eye + sideways, c.back * -1} : Ray{c.eye, sideways - c.back};
  std::vector<SurfaceHit> hits;
  for (const SurfacePrimitive& s : scene) {
    const bool is_dropped = s.kind != SurfaceKind::triangle && !(std::max(s.r0, s.r1) > 0);
    if (is_dropped) continue;
    const Ray object{solve(s.columns, world.from - s.origin), solve(s.columns, world.along)};
    for (const Crossing& hit : crossings(s, object)) {
      if (!(hit.t >= c.near_plane) || (hit.enters ? s.culls_front : s.culls_back)) continue;
      const Point3 in_object = object.at(hit.t), in_world = world.at(hit.t);
      if (!is_kept(s, in_object, in_world)) continue;
      const Real n = c.near_plane, f = c.far_plane;
      Real depth = n / hit.t;
      if (c.orthographic)
        depth = (f - hit.t) / (f - n);
      else if (f > 0)
        depth = n * (f - hit.t) / (hit.t * (f - n));
      Point3 normal;
      Real along = 0;
      if (s.kind != SurfaceKind::triangle) {
        along = along_of(s, in_object);
        // The inverse transpose, up to a positive factor: rows of cofactors.
        const Point3 o = normal_of(s, in_object);
        const Point3(&m)[3] = s.columns;
        normal = cross(m[1], m[2]) * o.x + cross(m[2], m[0]) * o.y + cross(m[0], m[1]) * o.z;
        if (dot(m[0], cross(m[1], m[2])) < 0) normal = normal * -1;
      }
      hits.push_back({depth, s.id, hit.enters, normal, in_world, hit.t, along});
    }
  }
  std::stable_sort(hits.begin(), hits.end(),
                   [](const SurfaceHit& a, const SurfaceHit& b) { return a.depth > b.depth; });
  return hits;
}

}  // namespace rastrum::test
