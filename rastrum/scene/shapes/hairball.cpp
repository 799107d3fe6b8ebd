// SPDX-License-Identifier: BSD-3-Clause
// Crossing curves in the unit ball as thin ribbons: long thin triangles, great depth complexity, no
// order; the worst case of transparency (paper 4). After the hairball of Laine and Karras, 2010,
// without its data.

#include <algorithm>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/scene/shapes/random.hpp>
#include <rastrum/scene/shapes/require.hpp>
#include <rastrum/shapes.hpp>

namespace rastrum::shapes {
namespace {

/// A cubic between random points of the sphere. Its inner control points lie in the ball, and so
/// does the curve.
struct Strand {
  Vec3d p[4] = {};

  Strand(Random& random, double radius) {
    p[0] = random.unit_vector() * radius;
    for (int i : {1, 2}) {
      // In separate statements, because compilers choose the order of a product's operands.
      const double r = radius * elementary::cbrt(random.uniform());
      p[i] = random.unit_vector() * r;
    }
    p[3] = random.unit_vector() * radius;
  }
  [[nodiscard]] Vec3d point(double t) const {
    const double s = 1 - t;
    return p[0] * (s * s * s) + p[1] * (3 * s * s * t) + p[2] * (3 * s * t * t) +
           p[3] * (t * t * t);
  }
  [[nodiscard]] Vec3d direction(double t) const {
    const double s = 1 - t;
    return (p[1] - p[0]) * (s * s) + (p[2] - p[1]) * (2 * s * t) + (p[3] - p[2]) * (t * t);
  }
};

Vec3d reject(Vec3d a, Vec3d unit_direction) {
  return a - unit_direction * dot(a, unit_direction);
}

}  // namespace

Mesh hairball(int strands, int segments, float width, std::uint64_t seed) {
  const FloatScope floats;
  require_range("hairball", "strands", strands, 1, 1 << 30);
  require_range("hairball", "segments", segments, 1, 1 << 20);
  require_range("hairball", "width", width, 1e-6, 0.5);
  require_size("hairball", "strands and segments", 2.0 * strands * (segments + 1.0));
  const auto rows = static_cast<std::size_t>(segments) + 1;
  const auto count = static_cast<std::size_t>(strands);

  Mesh mesh;
  mesh.name = "hairball";
  mesh.positions.resize(2 * count * rows);
  mesh.normals.values.resize(2 * count * rows);
  mesh.texcoords.values.resize(2 * count * rows);
  mesh.indices.resize(6 * count * (rows - 1));
  const double half = double{width} / 2;

  parallel::Threads exec;
  parallel::for_each_index(
      exec, count,
      [&](std::size_t strand) {
        Random random(seed, strand);
        const Strand curve(random, 1 - half);
        // The ribbon's side follows the curve with the least twist.
        Vec3d side = random.unit_vector();
        Vec3d along = random.unit_vector();
        for (std::size_t i = 0; i < rows; ++i) {
          const double t = static_cast<double>(i) / segments;
          const Vec3d direction = curve.direction(t);
          if (dot(direction, direction) > 1e-12) along = normalize(direction);
          Vec3d projected = reject(side, along);
          while (dot(projected, projected) < 1e-6) projected = reject(random.unit_vector(), along);
          side = normalize(projected);
          const Vec3d centre = curve.point(t);
          for (const int k : {0, 1}) {
            const std::size_t v = 2 * (strand * rows + i) + static_cast<std::size_t>(k);
            mesh.positions[v] = static_cast<Vec3>(centre + side * (k == 0 ? -half : half));
            mesh.normals.values[v] = static_cast<Vec3>(cross(side, along));
            mesh.texcoords.values[v] = {static_cast<float>(k), static_cast<float>(t)};
          }
        }
        for (std::size_t i = 0; i + 1 < rows; ++i) {
          const auto a = static_cast<std::uint32_t>(2 * (strand * rows + i));
          const std::uint32_t quad[6] = {a, a + 1, a + 3, a, a + 3, a + 2};
          std::copy_n(quad, 6, &mesh.indices[6 * (strand * (rows - 1) + i)]);
        }
      },
      64);
  return mesh;
}

}  // namespace rastrum::shapes
