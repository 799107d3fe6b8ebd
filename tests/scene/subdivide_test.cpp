// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/shapes.hpp>
#include "tests/scene/mesh_properties.hpp"

#include "tests/support/refused.hpp"

namespace rastrum::test::subdivide_test {
namespace {

TEST(Subdivide, KeepsAreaBoundsAndClosedness) {
  for (const char* spec : {"sphere?rings=6&segments=9", "torus_knot?segments=40&sides=6",
                           "boxes?count=2", "gyroid?cells=8", "soup?count=100", "teapot?n=2"}) {
    SCOPED_TRACE(spec);
    const Mesh mesh = shapes::from_spec(spec);
    const bool closed = is_closed_and_oriented(mesh);
    for (const int times : {1, 2, 3}) {
      const Mesh fine = shapes::subdivide(mesh, times);
      EXPECT_EQ(fine.triangle_count(), mesh.triangle_count() << 2 * times);
      EXPECT_NEAR(area(fine) / area(mesh), 1, 1e-4);
      const Box a = box_of(mesh), b = box_of(fine);
      EXPECT_TRUE(a.min == b.min && a.max == b.max);
      EXPECT_EQ(is_closed_and_oriented(fine), closed);
      EXPECT_NEAR(signed_volume(fine), signed_volume(mesh), 1e-4 * (1 + area(mesh)));
    }
  }
}

TEST(Subdivide, SharesMidpoints) {
  // Euler: V − E + F stays 2 on a sphere, so there is one new vertex per edge.
  const Mesh mesh = shapes::sphere(10, 20);
  const Mesh fine = shapes::subdivide(mesh, 1);
  EXPECT_EQ(fine.positions.size(), mesh.positions.size() + edge_uses(mesh).size());
  EXPECT_EQ(fine.positions.size() - edge_uses(fine).size() + fine.triangle_count(), 2U);
}

TEST(Subdivide, ChildrenLieWhereTheDocumentationSays) {
  Mesh mesh = shapes::soup(50);
  mesh.colors.values.resize(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.colors.values.size(); ++i)
    mesh.colors.values[i] = {static_cast<float>(i), static_cast<float>(i * i), 1, 0.5F};
  // Normals with indices of their own, in another order than the positions.
  mesh.normals.values = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5F, 0.5F, 0}};
  for (std::uint32_t c = 0; c < 150; ++c) mesh.normals.indices.push_back(c * 7 % 4);
  mesh.face_materials.resize(50);
  std::iota(mesh.face_materials.begin(), mesh.face_materials.end(), 3U);

  const Mesh fine = shapes::subdivide(mesh, 1);
  // Corners of the four children, as weights of the parent's corners.
  const float weight[4][3][3] = {{{1, 0, 0}, {.5F, .5F, 0}, {.5F, 0, .5F}},
                                 {{.5F, .5F, 0}, {0, 1, 0}, {0, .5F, .5F}},
                                 {{.5F, 0, .5F}, {0, .5F, .5F}, {0, 0, 1}},
                                 {{.5F, .5F, 0}, {0, .5F, .5F}, {.5F, 0, .5F}}};
  ASSERT_EQ(fine.triangle_count(), 200U);
  for (std::size_t t = 0; t < 50; ++t)
    for (std::size_t child = 0; child < 4; ++child) {
      EXPECT_EQ(fine.face_materials[4 * t + child], t + 3);
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t corner = 3 * (4 * t + child) + c;
        const auto expect = [&](auto f) {
          const auto& w = weight[child][c];
          return f(3 * t) * w[0] + f(3 * t + 1) * w[1] + f(3 * t + 2) * w[2];
        };
        const Vec3 p = expect([&](std::size_t k) { return position_at(mesh, k); });
        EXPECT_NEAR(length(position_at(fine, corner) - p), 0, 1e-6);
        const Vec3 n = expect([&](std::size_t k) { return attribute_at(mesh, mesh.normals, k); });
        EXPECT_NEAR(length(attribute_at(fine, fine.normals, corner) - n), 0, 1e-6);
        const Vec4 colour =
            expect([&](std::size_t k) { return attribute_at(mesh, mesh.colors, k); });
        const Vec4 d = attribute_at(fine, fine.colors, corner) - colour;
        EXPECT_NEAR(std::abs(d.x) + std::abs(d.y) + std::abs(d.z) + std::abs(d.w), 0, 1e-3);
      }
    }
}

TEST(Subdivide, KeepsSeamsOfTheTexture) {
  // Positions are shared across the sphere's seam, texture coordinates are not.
  expect_no_seam(shapes::subdivide(shapes::sphere(8, 16), 2), {64, 32});
}

TEST(Subdivide, ZeroTimesAndEmptyMeshes) {
  const Mesh mesh = shapes::boxes(1);
  EXPECT_EQ(shapes::subdivide(mesh, 0).indices, mesh.indices);
  EXPECT_EQ(shapes::subdivide(Mesh{}, 3).triangle_count(), 0U);
}

TEST(Subdivide, LargeCoordinatesStayFinite) {
  Mesh mesh{.positions = {{3e38F, 0, 0}, {3e38F, 1, 0}, {3e38F, 0, 1}}};
  for (const Vec3 p : shapes::subdivide(mesh, 2).positions) EXPECT_TRUE(is_finite(p));
}

TEST(Subdivide, RefusesWhatCannotBeNumbered) {
  const Mesh sphere = shapes::sphere(100, 200);
  const auto split = [&](int times) {
    return [&, times] { (void)shapes::subdivide(sphere, times); };
  };
  expect_refused("39600 triangles split 11 times", Errc::out_of_memory, split(11));
  expect_refused("times", split(17));
  expect_refused("", split(-1));
}

TEST(Subdivide, RefusesIndicesOutOfRange) {
  Mesh mesh = shapes::boxes(1);
  const auto split = [&] { (void)shapes::subdivide(mesh, 1); };
  mesh.indices[5] = 8;
  expect_refused("position index 8 but only 8", split);
  mesh = shapes::boxes(1);
  mesh.normals.indices[0] = 6;
  expect_refused("normal index 6", split);
  mesh = shapes::boxes(1);
  mesh.texcoords.indices.pop_back();
  expect_refused("", split);
}

TEST(Subdivide, SplitsScalars) {
  Mesh m{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
         .indices = {0, 1, 2},
         .scalars = {{"v", {0, 1, 3}, Per::vertex},
                     {"c", {0, 1, 3}, Per::corner},
                     {"f", {7}, Per::face},
                     {"m", {9}, Per::mesh}}};
  const Mesh out = shapes::subdivide(m, 1);
  ASSERT_EQ(out.positions.size(), 6U);
  ASSERT_EQ(out.scalars[0].values.size(), 6U);
  // At a triangle's corner both have the same number.
  for (std::size_t c = 0; c < 12; ++c)
    EXPECT_EQ(out.scalars[1].values.at(c), out.scalars[0].values.at(out.indices[c])) << c;
  EXPECT_EQ(out.scalars[2].values, (std::vector<double>{7, 7, 7, 7}));
  EXPECT_EQ(out.scalars[3].values, (std::vector<double>{9}));
  m.scalars[0].values.pop_back();
  EXPECT_THROW((void)shapes::subdivide(m, 1), Error);
}

}  // namespace
}  // namespace rastrum::test::subdivide_test
