// SPDX-License-Identifier: BSD-3-Clause
// Edges and normals of meshes as lines.
#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/mesh.hpp>
#include <rastrum/shapes.hpp>

namespace rastrum::test::line_art_test {
namespace {

TEST(LineArt, EdgesAreThereOnceInTheOrderOfTheirTriangles) {
  Mesh quad;
  quad.positions.resize(4);
  quad.indices = {0, 1, 2, 2, 1, 3};
  EXPECT_EQ(edge_indices(quad.view()), (std::vector<std::uint32_t>{0, 1, 1, 2, 0, 2, 1, 3, 2, 3}));
  quad.indices.clear();
  quad.positions.resize(3);
  EXPECT_EQ(edge_indices(quad.view()), (std::vector<std::uint32_t>{0, 1, 1, 2, 0, 2}));
  EXPECT_TRUE(edge_indices(Mesh{}.view()).empty());
}

TEST(LineArt, AClosedMeshHasThreeEdgesForTwoTriangles) {
  for (const char* spec : {"torus_knot", "sphere", "boxes"}) {
    const Mesh mesh = shapes::from_spec(spec);
    const std::vector<std::uint32_t> pairs = edge_indices(mesh.view());
    EXPECT_EQ(pairs.size() / 2, mesh.triangle_count() * 3 / 2) << spec;
    std::set<std::pair<std::uint32_t, std::uint32_t>> all;
    for (std::size_t i = 0; i < pairs.size(); i += 2)
      all.emplace(std::min(pairs[i], pairs[i + 1]), std::max(pairs[i], pairs[i + 1]));
    EXPECT_EQ(all.size() * 2, pairs.size()) << spec;
  }
}

TEST(LineArt, NormalsBeginAtTheVerticesAndHaveTheLength) {
  Mesh sphere = shapes::sphere(8, 12);
  for (const bool own_normals : {true, false}) {
    if (!own_normals) sphere.normals = {};
    const std::vector<Vec3> lines = normal_lines(sphere.view(), 0.25F);
    ASSERT_EQ(lines.size(), 2 * (own_normals ? sphere.positions.size() : sphere.triangle_count()));
    for (std::size_t i = 0; i < lines.size(); i += 2) {
      EXPECT_NEAR(length(lines[i + 1] - lines[i]), 0.25F, 1e-5F);
      // Outward.
      EXPECT_GT(dot(lines[i + 1] - lines[i], lines[i]), 0.2F * length(lines[i]));
    }
  }
}

TEST(LineArt, NormalsWithIndicesOfTheirOwnAreDrawnAtTheCorners) {
  Mesh m{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .indices = {0, 1, 2}};
  m.normals.values = {{0, 0, 2}, {0, 0, 0}};
  m.normals.indices = {0, 1, 0};
  // A corner with a zero normal has no line.
  EXPECT_EQ(normal_lines(m.view(), 3),
            (std::vector<Vec3>{{0, 0, 0}, {0, 0, 3}, {0, 1, 0}, {0, 1, 3}}));
  m.normals.indices = {0, 1, 2};
  EXPECT_THROW((void)normal_lines(m.view(), 1), Error);
  m.normals = {};
  m.indices = {0, 1, 3};
  EXPECT_THROW((void)normal_lines(m.view(), 1), Error);
}

}  // namespace
}  // namespace rastrum::test::line_art_test
