// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <rastrum/scene/shapes/marching_cubes_table.hpp>
#include <rastrum/shapes.hpp>
#include "tests/scene/mesh_properties.hpp"

namespace rastrum::test::gyroid_test {
namespace {

TEST(MarchingCubes, EveryCaseUsesItsCrossedEdgesAndNoOther) {
  for (unsigned inside = 0; inside < 256; ++inside) {
    const shapes::CellTriangles& cell = shapes::kMarchingCubes[inside];
    ASSERT_GE(cell.count, 0);
    ASSERT_LE(cell.count, 5);
    unsigned used = 0, crossed = 0;
    for (int t = 0; t < cell.count; ++t)
      for (const int edge : cell.edge[t]) used |= 1U << edge;
    for (int edge = 0; edge < 12; ++edge) {
      const int start = shapes::edge_start(edge), end = start | 1 << edge / 4;
      if ((inside >> start & 1U) != (inside >> end & 1U)) crossed |= 1U << edge;
    }
    EXPECT_EQ(used, crossed) << inside;
  }
}

TEST(Gyroid, IsWatertightInside) {
  // Coarse grids reach all ambiguous cases, fine ones the surface.
  for (const auto& [cells, periods] :
       {std::pair{2, 1.3F}, {3, 2.0F}, {5, 3.7F}, {9, 8.0F}, {16, 13.0F}, {40, 2.0F}, {64, 2.0F}}) {
    const Mesh mesh = shapes::gyroid(cells, periods);
    ASSERT_GT(mesh.triangle_count(), 0U) << cells;
    const auto on_the_same_face = [](Vec3 a, Vec3 b) {
      return (a.x == b.x && std::abs(a.x) == 1) || (a.y == b.y && std::abs(a.y) == 1) ||
             (a.z == b.z && std::abs(a.z) == 1);
    };
    std::size_t open = 0;
    for (const auto& [edge, use] : edge_uses(mesh)) {
      ASSERT_NE(edge.first, edge.second);
      ASSERT_LE(use.forward, 1);
      ASSERT_LE(use.backward, 1);
      const bool border = on_the_same_face(mesh.positions[edge.first], mesh.positions[edge.second]);
      if (use.forward + use.backward == 1) {
        ++open;
        EXPECT_TRUE(border) << cells;
      }
    }
    EXPECT_GT(open, 0U);
  }
}

TEST(Gyroid, LiesOnTheSurfaceWithItsNormals) {
  const Mesh mesh = shapes::gyroid(64, 2);
  const auto field = [](Vec3 p) {
    const double k = 2 * std::numbers::pi;
    const double x = k * p.x, y = k * p.y, z = k * p.z;
    return std::sin(x) * std::cos(y) + std::sin(y) * std::cos(z) + std::sin(z) * std::cos(x);
  };
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3 p = mesh.positions[v], n = mesh.normals.values[v];
    EXPECT_NEAR(field(p), 0, 0.01);
    EXPECT_NEAR(length(n), 1, 1e-5);
    // The field rises along the normal and is level across it.
    EXPECT_GT(field(p + n * 0.01F) - field(p - n * 0.01F), 0.02);
    const Vec3 across = normalize(cross(n, std::abs(n.x) < 0.7F ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    EXPECT_NEAR(field(p + across * 0.001F) - field(p - across * 0.001F), 0, 1e-4);
  }
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 face = face_normal(mesh, t);
    ASSERT_GT(length(face), 0);
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_GT(dot(face, attribute_at(mesh, mesh.normals, 3 * t + c)), 0);
  }
}

TEST(Gyroid, HasTheAreaOfTheMinimalSurface) {
  // The area is 3.0915 a² per cubic period a (Schoen's surface); the nodal approximation differs by
  // far less than the tolerance. Two periods: 8 cells of edge 1.
  EXPECT_NEAR(area(shapes::gyroid(96, 2)), 8 * 3.0915, 0.1);
}

}  // namespace
}  // namespace rastrum::test::gyroid_test
