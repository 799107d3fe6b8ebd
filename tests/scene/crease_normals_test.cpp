// crease_normals against its definition, written once more without its tables.
#include <rastrum/mesh.hpp>

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/shapes.hpp>

namespace rastrum::test::crease_normals_test {
namespace {

Vec3 normal_at(const Attribute<Vec3>& normals, std::size_t triangle, std::size_t corner) {
  return normals.values[normals.indices[3 * triangle + corner]];
}

void expect_near(Vec3 actual, Vec3 expected) {
  EXPECT_NEAR(length(actual - expected), 0, 1e-6)
      << actual.x << " " << actual.y << " " << actual.z << " instead of " << expected.x << " "
      << expected.y << " " << expected.z;
}

/// A closed prism of n sides along z, of radius 1, without its ends, as a soup.
std::vector<Vec3> prism(int n, bool ends) {
  std::vector<Vec3> soup;
  const auto at = [&](int i, float z) {
    const double a = 2 * std::numbers::pi * (i % n) / n;
    return Vec3{static_cast<float>(std::cos(a)), static_cast<float>(std::sin(a)), z};
  };
  for (int i = 0; i < n; ++i) {
    const Vec3 a = at(i, 0), b = at(i + 1, 0), c = at(i + 1, 1), d = at(i, 1);
    soup.insert(soup.end(), {a, b, c, a, c, d});
    if (ends) soup.insert(soup.end(), {d, c, Vec3{0, 0, 1}, b, a, Vec3{0, 0, 0}});
  }
  return soup;
}

TEST(CreaseNormals, KeepTheRimOfACylinderAndSmoothItsSide) {
  constexpr int kSides = 12;  // 30° from side to side
  const std::vector<Vec3> soup = prism(kSides, true);
  const Attribute<Vec3> n = crease_normals(soup, {}, 40);
  ASSERT_EQ(n.indices.size(), soup.size());
  for (std::size_t t = 0; t < soup.size() / 3; ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 p = soup[3 * t + c], normal = normal_at(n, t, c);
      if (t % 4 < 2) {
        EXPECT_EQ(normal.z, 0) << "the side is not bent by the ends";
        EXPECT_GT(dot(normal, normalize(Vec3{p.x, p.y, 0})), 0.99F);
      } else {
        expect_near(normal, {0, 0, t % 4 == 2 ? 1.0F : -1.0F});
      }
    }
  // One value for what is shared: two at each point of a rim, one at each end, one of none.
  EXPECT_EQ(n.values.size(), 4 * kSides + 2 + 1U);
}

TEST(CreaseNormals, TheAngleDecides) {
  const std::vector<Vec3> soup = prism(12, false);
  const Attribute<Vec3> faces = crease_normals(soup, {}, 29.9);
  const Attribute<Vec3> smooth = crease_normals(soup, {}, 30.1);
  const double half = std::numbers::pi / 12;
  expect_near(normal_at(faces, 0, 0),
              {static_cast<float>(std::cos(half)), static_cast<float>(std::sin(half)), 0});
  EXPECT_GT(normal_at(smooth, 0, 0).x, 0.99F);
}

TEST(CreaseNormals, AGroupReachesRoundATip) {
  // Neighbours of a pyramid's tip with 8 sides are 41° apart, opposite ones 114°.
  Mesh tip;
  tip.positions.push_back({0, 0, 0.7F});
  for (int i = 0; i < 8; ++i) {
    const double a = i * std::numbers::pi / 4;
    tip.positions.push_back({static_cast<float>(std::cos(a)), static_cast<float>(std::sin(a)), 0});
  }
  for (std::uint32_t i = 0; i < 8; ++i)
    tip.indices.insert(tip.indices.end(), {0, i + 1, (i + 1) % 8 + 1});
  const Attribute<Vec3> n = crease_normals(tip.positions, tip.indices, 45);
  for (std::size_t t = 0; t < 8; ++t) expect_near(normal_at(n, t, 0), {0, 0, 1});
}

TEST(CreaseNormals, WithoutCreasesAreTheVertexNormals) {
  const Mesh mesh = shapes::torus_knot(2, 3, 64, 12);
  const std::vector<Vec3> all = vertex_normals(mesh.positions, mesh.indices);
  const Attribute<Vec3> n = crease_normals(mesh.positions, mesh.indices, 180);
  for (std::size_t i = 0; i < mesh.indices.size(); ++i)
    EXPECT_LT(length(n.values[n.indices[i]] - all[mesh.indices[i]]), 1e-6F) << i;
}

TEST(CreaseNormals, DoNotDependOnHowPointsAreNumbered) {
  const Mesh mesh = shapes::teapot(4);
  std::vector<Vec3> soup;
  for (const std::uint32_t i : mesh.indices) soup.push_back(mesh.positions[i]);
  soup[0].x += 0.0F;
  const Attribute<Vec3> a = crease_normals(mesh.positions, mesh.indices, 40);
  const Attribute<Vec3> b = crease_normals(soup, {}, 40);
  for (std::size_t i = 0; i < soup.size(); ++i)
    EXPECT_EQ(a.values[a.indices[i]], b.values[b.indices[i]]) << i;
}

TEST(CreaseNormals, MinusZeroIsZero) {
  const std::vector<Vec3> soup = {{0, 0, 0},     {1, 0, 0},     {0, 1, 0},
                                  {0, 0, -0.0F}, {0, 1, -0.0F}, {-1, 0, 0.25F}};
  const Attribute<Vec3> n = crease_normals(soup, {}, 40);
  EXPECT_EQ(n.indices[0], n.indices[3]);
  EXPECT_EQ(n.indices[2], n.indices[4]);
}

TEST(CreaseNormals, WhatHasNoAreaOrIsNotFiniteHasNone) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Vec3> soup = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0},  {1, 0, 0},
                                  {2, 0, 0}, {0, 0, 0}, {1, 0, 0}, {nan, 0, 0}};
  const Attribute<Vec3> n = crease_normals(soup, {}, 40);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(normal_at(n, 0, c), (Vec3{0, 0, 1}));
    EXPECT_EQ(normal_at(n, 1, c), (Vec3{}));
    EXPECT_EQ(normal_at(n, 2, c), (Vec3{}));
  }
  EXPECT_TRUE(crease_normals({}, {}, 40).indices.empty());
}

TEST(CreaseNormals, RefuseWhatIsOutOfRange) {
  const std::vector<Vec3> positions(3);
  const std::vector<std::uint32_t> indices = {0, 1, 3};
  EXPECT_THROW(static_cast<void>(crease_normals(positions, indices, 40)), Error);
  for (const double angle : {-1.0, 180.5, std::nan("")})
    EXPECT_THROW(static_cast<void>(crease_normals(positions, {}, angle)), Error);
}

}  // namespace
}  // namespace rastrum::test::crease_normals_test
