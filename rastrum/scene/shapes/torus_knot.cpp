// SPDX-License-Identifier: BSD-3-Clause
// A tube around the (p, q) torus knot: p turns about the y axis while q turns about the tube of a
// torus with radii 1 and 0.4. The frame is the torus's normal, which is perpendicular to the curve
// and closes with it, so the tube needs no twist correction and its normals are exact. Also the
// knot as a tube of quadrics, with an exact surface.

#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/error.hpp>
#include <rastrum/scene/shapes/place_color.hpp>
#include <rastrum/scene/shapes/require.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::shapes {
namespace {

constexpr double kMajor = 1, kMinor = 0.4;

struct Frame {
  Vec3d point, normal, binormal;
};

Frame knot_frame(int p, int q, double t) {
  const auto [sp, cp] = elementary::sin_cos(p * t);
  const auto [sq, cq] = elementary::sin_cos(q * t);
  const double ring = kMajor + kMinor * cq;
  const Vec3d outward = {cp, 0, sp}, along = {-sp, 0, cp};
  const Vec3d normal = outward * cq + Vec3d{0, sq, 0};
  const Vec3d tangent = along * (p * ring) + (outward * -sq + Vec3d{0, cq, 0}) * (q * kMinor);
  return {outward * ring + Vec3d{0, kMinor * sq, 0}, normal, normalize(cross(tangent, normal))};
}

void require_knot(const char* shape, int p, int q, int segments, float radius, const char* name) {
  require_range(shape, "p", p, 1, 1000);
  require_range(shape, "q", q, 0, 1000);
  require_range(shape, "segments", segments, 3, 1 << 24);
  require_range(shape, name, radius, 1e-6, 10);
  if (std::gcd(p, q) != 1)
    throw Error(Errc::invalid_argument, std::string(shape) +
                                            ": p and q must have no common divisor, got " +
                                            std::to_string(p) + " and " + std::to_string(q));
}

}  // namespace

Mesh torus_knot(int p, int q, int segments, int sides, float tube) {
  const FloatScope floats;
  require_knot("torus_knot", p, q, segments, tube, "tube");
  require_range("torus_knot", "sides", sides, 3, 65536);
  require_size("torus_knot", "segments and sides", (segments + 1.0) * (sides + 1.0));
  const auto n = static_cast<std::uint32_t>(segments);
  const auto m = static_cast<std::uint32_t>(sides);

  std::vector<elementary::SinCos> around(m);
  for (std::uint32_t j = 0; j < m; ++j)
    around[j] = elementary::sin_cos(2 * std::numbers::pi * j / m);

  Mesh mesh;
  mesh.name = "torus_knot";
  const std::size_t vertices = std::size_t{n} * m;
  mesh.positions.reserve(vertices);
  mesh.normals.values.reserve(vertices);
  for (std::uint32_t i = 0; i < n; ++i) {
    const Frame f = knot_frame(p, q, 2 * std::numbers::pi * i / n);
    for (const auto& [sin, cos] : around) {
      const Vec3d normal = f.normal * cos + f.binormal * sin;
      mesh.positions.push_back(static_cast<Vec3>(f.point + normal * double{tube}));
      mesh.normals.values.push_back(static_cast<Vec3>(normal));
    }
  }
  mesh.texcoords.values.reserve(std::size_t{n + 1} * (m + 1));
  for (std::uint32_t i = 0; i <= n; ++i)
    for (std::uint32_t j = 0; j <= m; ++j)
      mesh.texcoords.values.push_back(
          {static_cast<float>(double{1} * i / n), static_cast<float>(double{1} * j / m)});

  mesh.indices.reserve(6 * vertices);
  mesh.texcoords.indices.reserve(6 * vertices);
  const auto corner = [&](std::uint32_t i, std::uint32_t j) {
    mesh.indices.push_back(i % n * m + j % m);
    mesh.texcoords.indices.push_back(i * (m + 1) + j);
  };
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < m; ++j) {
      corner(i, j);
      corner(i, j + 1);
      corner(i + 1, j + 1);
      corner(i, j);
      corner(i + 1, j + 1);
      corner(i + 1, j);
    }
  return mesh;
}

Tubes tube(int p, int q, int segments, float radius) {
  const FloatScope floats;
  require_knot("tube", p, q, segments, radius, "radius");
  Tubes t;
  t.name = "tube";
  t.radius = radius;
  for (int i = 0; i <= segments; ++i) {
    const Vec3d at = knot_frame(p, q, 2 * std::numbers::pi * (i % segments) / segments).point;
    t.positions.push_back(static_cast<Vec3>(at));
    t.colors.push_back(place_color(at * (1 / (kMajor + kMinor))));
  }
  return t;
}

}  // namespace rastrum::shapes
