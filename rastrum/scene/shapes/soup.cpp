// SPDX-License-Identifier: BSD-3-Clause
// Unconnected random triangles: the rasterizer's worst case for order and locality. Not indexed.

#include <algorithm>
#include <cmath>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/scene/shapes/random.hpp>
#include <rastrum/scene/shapes/require.hpp>
#include <rastrum/shapes.hpp>

namespace rastrum::shapes {

Mesh soup(int count, float min_size, float max_size, std::uint64_t seed) {
  const FloatScope floats;
  require_range("soup", "count", count, 1, 1431655765);  // 3 · count < 2³²
  require_range("soup", "max_size", max_size, 1e-6, 1.5);
  require_range("soup", "min_size", min_size, 1e-6, max_size);
  Mesh mesh;
  mesh.name = "soup";
  mesh.positions.resize(3 * static_cast<std::size_t>(count));
  // No vertex is farther from the centroid than 2/3 of a median, and no median is longer than the
  // longest edge.
  const double room = 1 - static_cast<double>(max_size) * 2 / 3;
  for (std::size_t t = 0; t < static_cast<std::size_t>(count); ++t) {
    Random random(seed, t);
    // Lengths that violate the triangle inequality are drawn again.
    double a = 0, b = 0, c = 0;
    do {
      a = random.uniform(double{min_size}, double{max_size});
      b = random.uniform(double{min_size}, double{max_size});
      c = random.uniform(double{min_size}, double{max_size});
    } while (2 * std::max({a, b, c}) > a + b + c);
    // One corner at 0, one at a on the first axis; the third is b from the first and c from the
    // second.
    const double x = (a * a + b * b - c * c) / (2 * a);
    const double y = std::sqrt(std::max(b * b - x * x, 0.0));
    const Vec3d axis = random.unit_vector();
    Vec3d across{};
    do across = cross(axis, random.unit_vector());
    while (dot(across, across) < 1e-6);
    across = normalize(across);
    const Vec3d centre = {random.uniform(-room, room), random.uniform(-room, room),
                          random.uniform(-room, room)};
    const Vec3d origin = centre - axis * ((a + x) / 3) - across * (y / 3);
    mesh.positions[3 * t] = static_cast<Vec3>(origin);
    mesh.positions[3 * t + 1] = static_cast<Vec3>(origin + axis * a);
    mesh.positions[3 * t + 2] = static_cast<Vec3>(origin + axis * x + across * y);
  }
  return mesh;
}

}  // namespace rastrum::shapes
