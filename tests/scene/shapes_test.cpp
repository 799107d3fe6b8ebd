// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include <rastrum/scene/shapes/teapot_patches.hpp>
#include <rastrum/shapes.hpp>
#include "tests/scene/mesh_properties.hpp"

namespace rastrum::test::shapes_test {
namespace {

constexpr double kPi = std::numbers::pi;

/// Expects valid indices, and unit normals on the front of their triangles' planes (up to a
/// triangle's curvature).
void expect_sound(const Mesh& mesh) {
  ASSERT_EQ(mesh.indices.size() % 3, 0U);
  for (std::size_t corner = 0; corner < 3 * mesh.triangle_count(); ++corner) {
    ASSERT_LT(position_index(mesh, corner), mesh.positions.size());
    ASSERT_TRUE(is_finite(position_at(mesh, corner)));
    if (mesh.normals.empty()) continue;
    const Vec3 n = attribute_at(mesh, mesh.normals, corner);
    ASSERT_NEAR(length(n), 1, 1e-5) << corner;
    const Vec3 face = face_normal(mesh, corner / 3);
    if (length(face) > 1e-7F) {
      ASSERT_GT(dot(n, normalize(face)), 0.4F) << corner;
    }
  }
  if (!mesh.texcoords.empty())
    for (std::size_t corner = 0; corner < 3 * mesh.triangle_count(); ++corner) {
      const Vec2 uv = attribute_at(mesh, mesh.texcoords, corner);
      ASSERT_TRUE(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1);
    }
}

TEST(Sphere, IsClosedAndHasItsVolume) {
  for (const auto& [rings, segments] : {std::pair{2, 3}, {3, 4}, {32, 64}, {101, 37}}) {
    const Mesh mesh = shapes::sphere(rings, segments);
    expect_sound(mesh);
    EXPECT_EQ(mesh.triangle_count(), static_cast<std::size_t>(2 * (rings - 1) * segments));
    EXPECT_TRUE(is_closed_and_oriented(mesh));
    EXPECT_GT(signed_volume(mesh), 0);
  }
  EXPECT_NEAR(signed_volume(shapes::sphere(400, 800)), 4 * kPi / 3, 1e-3);
  for (const Vec3 p : shapes::sphere().positions) EXPECT_NEAR(length(p), 1, 1e-6);
}

TEST(Sphere, TextureHasNoSeam) {
  expect_no_seam(shapes::sphere(16, 32), {32, 16});
}

TEST(TorusKnot, IsAClosedTube) {
  for (const auto& [p, q] : {std::pair{2, 3}, {3, 2}, {1, 0}, {5, 7}}) {
    const Mesh mesh = shapes::torus_knot(p, q, 400, 16, 0.05F);
    expect_sound(mesh);
    EXPECT_EQ(mesh.triangle_count(), 2U * 400 * 16);
    EXPECT_TRUE(is_closed_and_oriented(mesh));
    EXPECT_GT(signed_volume(mesh), 0);
  }
  // (1, 0) is a circle of radius 1.4: a torus, whose volume is known.
  const Mesh torus = shapes::torus_knot(1, 0, 600, 300, 0.25F);
  EXPECT_NEAR(signed_volume(torus), 2 * kPi * kPi * 1.4 * 0.0625, 1e-3);
}

TEST(TorusKnot, TextureRunsAlongAndAroundTheTube) {
  // Position i · sides + j has the coordinates (i / segments, j / sides), or 1 where they close.
  const Mesh mesh = shapes::torus_knot(2, 3, 32, 8);
  for (std::size_t corner = 0; corner < 3 * mesh.triangle_count(); ++corner) {
    const std::uint32_t p = position_index(mesh, corner);
    const Vec2 uv = attribute_at(mesh, mesh.texcoords, corner);
    EXPECT_EQ(static_cast<std::uint32_t>(uv.x * 32) % 32, p / 8);
    EXPECT_EQ(static_cast<std::uint32_t>(uv.y * 8) % 8, p % 8);
  }
}

TEST(Boxes, AreClosedAndHaveTheirVolume) {
  for (const int count : {1, 2, 5}) {
    const Mesh mesh = shapes::boxes(count, 0.5F);
    expect_sound(mesh);
    const int n = count * count * count;
    EXPECT_EQ(mesh.triangle_count(), static_cast<std::size_t>(12 * n));
    EXPECT_EQ(mesh.positions.size(), static_cast<std::size_t>(8 * n));
    EXPECT_TRUE(is_closed_and_oriented(mesh));
    EXPECT_NEAR(signed_volume(mesh), 0.125 * n, 1e-4);
    EXPECT_EQ(box_of(mesh).max.x, static_cast<float>(count) / 2 - 0.25F);
  }
}

TEST(Teapot, DataAreNewells) {
  // Points of the usual listing of 306 (Crow 1987), with their numbers there.
  const auto patches = shapes::teapot_patches();
  std::map<std::tuple<double, double, double>, int> points;
  for (const auto& patch : patches)
    for (const auto& row : patch.points)
      for (const auto& p : row) ++points[{p.x + 0.0, p.y + 0.0, p.z}];
  const auto has = [&](double x, double y, double z) { return points.count({x, y, z}) != 0; };
  EXPECT_TRUE(has(1.4, 0, 2.4));               // 1
  EXPECT_TRUE(has(-0.805, -1.4375, 2.53125));  // 23
  EXPECT_TRUE(has(-2.65, -0.3, 0.9375));       // 151
  EXPECT_TRUE(has(3.525, 0.25, 2.49375));      // 198
  EXPECT_TRUE(has(0.45, -0.8, 3.15));          // 209
  EXPECT_TRUE(has(0.798, -1.425, 0));          // 305
  // 306 without 4 that no patch uses and 12 on the bottom's rim that are listed twice.
  EXPECT_EQ(points.size(), 290U);
  double low = INFINITY, high = -INFINITY;
  for (const auto& [p, uses] : points) {
    low = std::min(low, std::get<2>(p));
    high = std::max(high, std::get<2>(p));
  }
  EXPECT_EQ(low, 0);
  EXPECT_EQ(high, 3.15);
}

TEST(Teapot, HasItsSizeAndFacesOutward) {
  const Mesh mesh = shapes::teapot(16);
  expect_sound(mesh);
  EXPECT_EQ(mesh.triangle_count(), 64U * 16 * 16);
  const Box box = box_of(mesh);
  EXPECT_EQ(box.min.x, -3.0F);
  EXPECT_NEAR(box.max.x, 3.434F, 1e-3);
  EXPECT_EQ(box.min.y, 0.0F);
  EXPECT_EQ(box.max.y, 3.15F);
  EXPECT_EQ(box.min.z, -2.0F);
  EXPECT_EQ(box.max.z, 2.0F);
  // The pot, its lid and bottom enclose the body but for the lid's gap. The volume is that of the
  // profile's revolution (0.56 makes circles to within 0.3 %).
  EXPECT_NEAR(signed_volume(shapes::teapot(64)), 25.93, 0.05);
}

TEST(Teapot, PatchesMeetWithoutACrack) {
  // With equal positions merged, the only open edges are the teapot's by design: the rim with its
  // lid, the ends of handle and spout.
  for (const int n : {3, 7, 16}) {
    const Mesh mesh = shapes::teapot(n);
    std::map<std::tuple<float, float, float>, std::uint32_t> ids;
    Mesh glued{.positions = mesh.positions};
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      std::uint32_t id[3];
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3 p = position_at(mesh, 3 * t + c);
        id[c] = ids.try_emplace({p.x, p.y, p.z}, position_index(mesh, 3 * t + c)).first->second;
      }
      if (id[0] != id[1] && id[1] != id[2] && id[2] != id[0])
        glued.indices.insert(glued.indices.end(), id, id + 3);
    }
    std::size_t open = 0;
    for (const auto& [edge, use] : edge_uses(glued)) {
      EXPECT_LE(use.forward, 1);
      EXPECT_LE(use.backward, 1);
      open += use.forward + use.backward == 1 ? 1 : 0;
    }
    // Open rings: rim and lid (4 quarters each), both ends of handle and spout (2 halves each).
    EXPECT_EQ(open, static_cast<std::size_t>((4 + 4 + 2 + 2 + 2 + 2) * n));
  }
}

TEST(Hairball, IsMadeOfRibbonsInTheUnitBall) {
  const Mesh mesh = shapes::hairball(50, 40, 0.01F, 3);
  expect_sound(mesh);
  EXPECT_EQ(mesh.triangle_count(), 2U * 50 * 40);
  for (const Vec3 p : mesh.positions) EXPECT_LE(length(p), 1.000001F);
  for (std::size_t v = 0; v < mesh.positions.size(); v += 2)
    EXPECT_NEAR(length(mesh.positions[v + 1] - mesh.positions[v]), 0.01, 1e-6);
  // A strand does not depend on the number of strands, but on the seed.
  const Mesh fewer = shapes::hairball(7, 40, 0.01F, 3);
  EXPECT_EQ(std::memcmp(fewer.positions.data(), mesh.positions.data(),
                        fewer.positions.size() * sizeof(Vec3)),
            0);
  EXPECT_FALSE(shapes::hairball(7, 40, 0.01F, 4).positions[0] == fewer.positions[0]);
}

TEST(Soup, EdgesHaveTheSizesAskedFor) {
  const Mesh mesh = shapes::soup(5000, 0.1F, 0.3F, 9);
  EXPECT_EQ(mesh.triangle_count(), 5000U);
  float shortest = INFINITY, longest = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 p = position_at(mesh, 3 * t + c);
      const float l = length(p - position_at(mesh, 3 * t + (c + 1) % 3));
      shortest = std::min(shortest, l);
      longest = std::max(longest, l);
      EXPECT_LE(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 1.0F);
    }
  EXPECT_NEAR(shortest, 0.1, 1e-3);
  EXPECT_NEAR(longest, 0.3, 1e-3);
  EXPECT_LE(longest, 0.300001F);
  EXPECT_GE(shortest, 0.099999F);
}

TEST(Shapes, AreTheSameEveryTime) {
  for (const shapes::ShapeInfo& info : shapes::catalogue()) {
    const std::string spec = info.name == "hairball" ? "hairball?strands=300" : info.name;
    if (shapes::scene_from_spec(spec).meshes.empty()) continue;
    const Mesh a = shapes::from_spec(spec), b = shapes::from_spec(spec);
    EXPECT_EQ(a.indices, b.indices) << spec;
    ASSERT_EQ(a.positions.size(), b.positions.size()) << spec;
    EXPECT_EQ(
        std::memcmp(a.positions.data(), b.positions.data(), a.positions.size() * sizeof(Vec3)), 0)
        << spec;
  }
}

TEST(Shapes, RandomNumbersAreFixedForever) {
  // Pinned, because a change of the generator would change every picture.
  const auto expect = [](Vec3 p, Vec3 q) { EXPECT_LT(length(p - q), 1e-6F); };
  expect(shapes::soup(1).positions[0], {-0.208649814F, 0.0785896778F, -0.557197332F});
  expect(shapes::hairball(1, 1).positions[3], {0.336357236F, 0.938907027F, 0.0626000389F});
  expect(shapes::spheres(1).centers[0], {-0.065366514F, 0.250104606F, 0.734310627F});
  expect(shapes::cylinders(1).positions[1], {0.00824894942F, 0.625561178F, 0.0483151376F});
  expect(shapes::discs(1).normals[0], {-0.971962929F, 0.23506093F, 0.00586459273F});
}

}  // namespace
}  // namespace rastrum::test::shapes_test
