// SPDX-License-Identifier: BSD-3-Clause
// crease_normals against a plain version of its definition, without tables.
#include <rastrum/mesh.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/core/angle.hpp>
#include <rastrum/error.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/test_share.hpp"

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

/// A prism of n sides along z, with radius 1, with or without its ends, as a soup.
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

/// The definition, point by point: of the faces with area around a point, neighbours in the order
/// (end, face) that share an end are one group if their angle allows it.
Attribute<Vec3> plain_crease_normals(const std::vector<Vec3>& positions,
                                     const std::vector<std::uint32_t>& indices, double degrees) {
  const double cosine = sin_cos_degrees(degrees).cos;
  using Place = std::array<float, 3>;
  std::map<Place, std::size_t> number;
  std::vector<std::size_t> point;
  for (const Vec3& p : positions)
    point.push_back(
        number.try_emplace(Place{p.x + 0, p.y + 0, p.z + 0}, number.size()).first->second);
  std::vector<std::vector<std::size_t>> around(number.size());
  const auto area = [&](std::size_t corner) {
    const std::uint32_t* v = &indices[corner / 3 * 3];
    const Vec3d a(positions[v[0]]);
    return cross(Vec3d(positions[v[1]]) - a, Vec3d(positions[v[2]]) - a);
  };
  for (std::size_t c = 0; c < indices.size(); ++c)
    if (length(area(c)) > 0) around[point[indices[c]]].push_back(c);
  Attribute<Vec3> normals;
  normals.indices.resize(indices.size());
  normals.values.emplace_back();
  for (const std::vector<std::size_t>& corners : around) {
    std::vector<std::size_t> group(corners.size());
    std::iota(group.begin(), group.end(), std::size_t{0});
    std::vector<std::pair<std::size_t, std::size_t>> spokes;  // end, face
    for (std::size_t i = 0; i < corners.size(); ++i)
      for (const std::size_t step : {1U, 2U})
        spokes.emplace_back(point[indices[corners[i] / 3 * 3 + (corners[i] + step) % 3]], i);
    std::sort(spokes.begin(), spokes.end());
    for (std::size_t i = 1; i < spokes.size(); ++i) {
      const auto [a, b] = std::pair{spokes[i - 1].second, spokes[i].second};
      const Vec3d m = area(corners[a]), n = area(corners[b]);
      if (spokes[i - 1].first != spokes[i].first || dot(m, n) < cosine * (length(m) * length(n)))
        continue;
      const std::size_t from = std::max(group[a], group[b]), to = std::min(group[a], group[b]);
      std::replace(group.begin(), group.end(), from, to);
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (group[i] != i) {
        normals.indices[corners[i]] = normals.indices[corners[group[i]]];
        continue;
      }
      Vec3d sum{};
      for (std::size_t j = i; j < corners.size(); ++j)
        if (group[j] == i) sum = sum + area(corners[j]);
      const double l = length(sum);
      normals.indices[corners[i]] = static_cast<std::uint32_t>(normals.values.size());
      normals.values.push_back(l > 0 ? Vec3{static_cast<float>(sum.x / l),
                                            static_cast<float>(sum.y / l),
                                            static_cast<float>(sum.z / l)}
                                     : Vec3{});
    }
  }
  return normals;
}

/// A sheet of n² rough quads. Some triangles are flipped, doubled, missing or without area;
/// vertices are shared or not.
void rough_sheet(std::uint32_t n, std::uint32_t seed, std::vector<Vec3>& positions,
                 std::vector<std::uint32_t>& indices) {
  std::mt19937 random(seed);
  const auto one_in = [&](std::uint32_t k) { return random() % k == 0; };
  std::vector<float> heights((n + 1) * (n + 1));
  for (float& h : heights) h = static_cast<float>(random() % 8) / (one_in(4) ? 2.0F : 16.0F);
  const auto at = [&](std::uint32_t i) {
    return Vec3{static_cast<float>(i % (n + 1)), static_cast<float>(i / (n + 1)), heights[i]};
  };
  for (std::uint32_t i = 0; i < heights.size(); ++i) positions.push_back(at(i));
  for (std::uint32_t y = 0; y < n; ++y)
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
      for (std::array<std::uint32_t, 3> t : {std::array{a, b, d}, std::array{a, d, c}}) {
        if (one_in(16)) std::swap(t[0], t[1]);
        if (one_in(32)) t[2] = t[1];
        for (std::uint32_t& v : t)
          if (one_in(8)) {
            positions.push_back(positions[v]);
            v = static_cast<std::uint32_t>(positions.size()) - 1;
          }
        for (int times = one_in(16) ? 0 : one_in(16) ? 2 : 1; times > 0; --times)
          indices.insert(indices.end(), t.begin(), t.end());
      }
    }
}

TEST(CreaseNormals, AreTheDefinitionsOfRoughSheets) {
  for (const std::uint32_t n :
       {1U, 2U, 9U,
        static_cast<std::uint32_t>(test::share_of(150, 40))})  // the last is shared among threads
    for (const double degrees : {0.0, 30.0, 75.0, 180.0}) {
      std::vector<Vec3> positions;
      std::vector<std::uint32_t> indices;
      rough_sheet(n, n + static_cast<std::uint32_t>(degrees), positions, indices);
      const Attribute<Vec3> actual = crease_normals(positions, indices, degrees);
      const Attribute<Vec3> expected = plain_crease_normals(positions, indices, degrees);
      EXPECT_EQ(actual.indices, expected.indices)
          << n << " quads a side, " << degrees << " degrees";
      EXPECT_TRUE(actual.values == expected.values)
          << n << " quads a side, " << degrees << " degrees";
    }
}

TEST(CreaseNormals, OfConesTipToTipAreTwoGroups) {
  constexpr std::uint32_t kSides = 5;
  std::vector<Vec3> positions = {{0, 0, 0}};
  std::vector<std::uint32_t> indices;
  for (const float z : {1.0F, -1.0F})
    for (std::uint32_t i = 0; i < kSides; ++i) {
      const double a = 2 * std::numbers::pi * i / kSides;
      positions.push_back(
          {static_cast<float>(std::cos(a)), static_cast<float>(z * std::sin(a)), z});
      const std::uint32_t first = z > 0 ? 1 : 1 + kSides;
      indices.insert(indices.end(), {0, first + i, first + (i + 1) % kSides});
    }
  const Attribute<Vec3> actual = crease_normals(positions, indices, 180);
  EXPECT_EQ(actual.indices, plain_crease_normals(positions, indices, 180).indices);
  EXPECT_NE(actual.indices[0], actual.indices[3 * kSides]);
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
  // Values are shared: two at each point of a rim, one at each end, and one for no normal.
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
  // With 8 sides, neighbours at a pyramid's tip are 41° apart, opposite ones 114°.
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
