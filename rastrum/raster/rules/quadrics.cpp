// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/rules/quadrics.hpp>

#include <algorithm>
#include <cmath>

namespace rastrum::raster {
namespace {

double radius_of(const ArrayView<float>& radii, float radius, std::size_t i) {
  return radii.empty() ? radius : radii[i];
}

QuadricShape shape_of(const SpheresView& s, std::uint64_t i) {
  const auto k = static_cast<std::size_t>(i);
  const Vec3d p = s.centers.wide(k);
  const double r = radius_of(s.radii, s.radius, k);
  return {QuadricKind::sphere, p, p, r, r};
}
QuadricShape shape_of(const CylindersView& c, std::uint64_t i) {
  const std::size_t a = c.end(i, 0), b = c.end(i, 1);
  return {c.caps ? QuadricKind::cone : QuadricKind::open_cone, c.positions.wide(a),
          c.positions.wide(b), radius_of(c.radii, c.radius, a), radius_of(c.radii, c.radius, b)};
}
QuadricShape shape_of(const TubesView& t, std::uint64_t i) {
  const std::size_t a = t.begin(i);
  return {QuadricKind::hull, t.positions.wide(a), t.positions.wide(a + 1),
          radius_of(t.radii, t.radius, a), radius_of(t.radii, t.radius, a + 1)};
}
QuadricShape shape_of(const DiscsView& d, std::uint64_t i) {
  const auto k = static_cast<std::size_t>(i);
  const Vec3d p = d.centers.wide(k);
  const double r = radius_of(d.radii, d.radius, k);
  return {QuadricKind::disc, p, d.normals.wide(k), r, r};
}

template <class T>
void prefetch_element(const ArrayView<T>& values, std::uint64_t i) {
  if (!values.empty() && values.is_packed()) __builtin_prefetch(values.data() + i);
}
void prefetch_shape(const SpheresView& s, std::uint64_t i) {
  prefetch_element(s.centers, i);
  prefetch_element(s.radii, i);
}
template <class Geometry>
void prefetch_shape(const Geometry& /*reads through indices*/, std::uint64_t) {}

}  // namespace

AxisEnds axis_ends(const QuadricGeometry& geometry, std::uint64_t i) {
  if (const auto* const c = std::get_if<CylindersView>(&geometry))
    return {c->end(i, 0), c->end(i, 1)};
  auto k = static_cast<std::size_t>(i);
  const auto* const t = std::get_if<TubesView>(&geometry);
  if (t == nullptr) return {k, k};
  k = t->begin(i);
  return {k, k + 1};
}

const ArrayView<Vec3>& positions_of(const QuadricGeometry& geometry) {
  struct Positions {
    const ArrayView<Vec3>& operator()(const SpheresView& s) const { return s.centers; }
    const ArrayView<Vec3>& operator()(const CylindersView& c) const { return c.positions; }
    const ArrayView<Vec3>& operator()(const TubesView& t) const { return t.positions; }
    const ArrayView<Vec3>& operator()(const DiscsView& d) const { return d.centers; }
  };
  return std::visit(Positions{}, geometry);
}

QuadricStage::QuadricStage(const QuadricGeometry& geometry, const Mat4d& object_to_clip)
    : geometry_(geometry), object_to_clip_(object_to_clip), inverse_(inverse(object_to_clip)) {}

void QuadricStage::prefetch(std::uint64_t i) const {
  std::visit([&](const auto& geometry) { prefetch_shape(geometry, i); }, geometry_);
}

ShapeFate QuadricStage::shape(std::uint64_t i, QuadricShape& out) const {
  out = std::visit([&](const auto& geometry) { return shape_of(geometry, i); }, geometry_);
  if (!is_finite(out.p0) || !is_finite(out.p1)) return ShapeFate::dropped;
  // A NaN fails.
  const auto is_radius = [](double r) { return r >= 0 && std::isfinite(r); };
  if (!is_radius(out.r0) || !is_radius(out.r1)) return ShapeFate::dropped;
  if (!(std::max(out.r0, out.r1) > 0)) return ShapeFate::empty;
  if (out.kind == QuadricKind::sphere) return ShapeFate::drawn;
  if (out.kind == QuadricKind::disc) {
    const double n = length(out.p1);
    if (n > 0) out.p1 = out.p1 * (1 / n);
    return n > 0 ? ShapeFate::drawn : ShapeFate::empty;
  }
  const double distance = length(out.p1 - out.p0);
  if (out.kind == QuadricKind::hull && distance <= std::abs(out.r1 - out.r0)) {
    if (out.r1 > out.r0) {
      out.p0 = out.p1;
      out.r0 = out.r1;
      out.along = 1;
    }
    out.kind = QuadricKind::sphere;
    return ShapeFate::drawn;
  }
  return distance > 0 ? ShapeFate::drawn : ShapeFate::empty;
}

}  // namespace rastrum::raster
