// SPDX-License-Identifier: BSD-3-Clause
// Tessellates the teapot's Bézier patches. Neighbours meet without a crack: on a shared edge both
// evaluate the same cubic, to the same bits in both directions.

#include <rastrum/scene/shapes/teapot_patches.hpp>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/scene/shapes/require.hpp>
#include <rastrum/shapes.hpp>

namespace rastrum::shapes {
namespace {

/// Bernstein weights at i/n and their derivatives, symmetric bit for bit in i ↔ n − i.
struct Basis {
  double weight[4], slope[4];

  Basis(int i, int n) {
    const double t = static_cast<double>(i) / n;
    const double s = static_cast<double>(n - i) / n;
    weight[0] = s * s * s;
    weight[1] = 3 * (s * s * t);
    weight[2] = 3 * (t * t * s);
    weight[3] = t * t * t;
    slope[0] = -3 * (s * s);
    slope[1] = 3 * (s * s - 2 * (s * t));
    slope[2] = -3 * (t * t - 2 * (s * t));
    slope[3] = 3 * (t * t);
  }
};

Vec3d blend(const Vec3d (&p)[4], const double (&w)[4]) {
  return (p[0] * w[0] + p[3] * w[3]) + (p[1] * w[1] + p[2] * w[2]);
}

Vec3d evaluate(const BezierPatch& patch, const double (&row)[4], const double (&column)[4]) {
  const Vec3d rows[4] = {blend(patch.points[0], column), blend(patch.points[1], column),
                         blend(patch.points[2], column), blend(patch.points[3], column)};
  return blend(rows, row);
}

/// Newell's z is up; a rotation, which keeps the winding.
Vec3 y_up(Vec3d p) {
  return static_cast<Vec3>(Vec3d{p.x, p.z, -p.y});
}

Vec3d outward(const BezierPatch& patch, const Basis& row, const Basis& column) {
  const Vec3d down = evaluate(patch, row.slope, column.weight);
  Vec3d n = cross(evaluate(patch, row.weight, column.slope), down);
  // At the tips of knob and bottom the first row is one point; there the column's direction tends
  // to the mixed derivative.
  if (dot(n, n) < 1e-18) n = cross(evaluate(patch, row.slope, column.slope), down);
  return normalize(n);
}

}  // namespace

Mesh teapot(int n) {
  const FloatScope floats;
  require_range("teapot", "n", n, 1, 8192);
  const auto side = static_cast<std::uint32_t>(n) + 1;
  const std::size_t vertices = std::size_t{32} * side * side;

  Mesh mesh;
  mesh.name = "teapot";
  mesh.positions.reserve(vertices);
  mesh.normals.values.reserve(vertices);
  mesh.texcoords.values.reserve(vertices);
  mesh.indices.reserve(std::size_t{32} * 6 * (side - 1) * (side - 1));
  std::vector<Basis> basis;
  for (int i = 0; i <= n; ++i) basis.emplace_back(i, n);

  for (const BezierPatch& patch : teapot_patches()) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t i = 0; i < side; ++i)
      for (std::uint32_t j = 0; j < side; ++j) {
        mesh.positions.push_back(y_up(evaluate(patch, basis[i].weight, basis[j].weight)));
        mesh.normals.values.push_back(y_up(outward(patch, basis[i], basis[j])));
        mesh.texcoords.values.push_back(
            {static_cast<float>(double{1} * j / n), static_cast<float>(double{1} * i / n)});
      }
    for (std::uint32_t i = 0; i + 1 < side; ++i)
      for (std::uint32_t j = 0; j + 1 < side; ++j) {
        const std::uint32_t a = first + i * side + j, b = a + 1, c = a + side, d = c + 1;
        mesh.indices.insert(mesh.indices.end(), {a, b, d, a, d, c});
      }
  }
  return mesh;
}

}  // namespace rastrum::shapes
