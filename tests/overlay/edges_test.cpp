// SPDX-License-Identifier: BSD-3-Clause
// Edges of visible triangles: which sides are drawn, their width, equal bits everywhere.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/digest.hpp>
#include <rastrum/effects.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/every_way.hpp"
#include "tests/support/golden.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::edges_test {
namespace {

int count_sides(const SceneView& scene, double angle) {
  const SceneEdges edges(scene, angle);
  int sides = 0;
  std::uint64_t primitives = 0;
  for (const InstanceView& instance : scene.instances)
    primitives += primitive_count(instance.geometry);
  for (std::uint64_t i = 0; i < primitives; ++i)
    for (std::uint8_t bits = edges.sides(edges.find(static_cast<std::int64_t>(i))); bits != 0;
         bits = static_cast<std::uint8_t>(bits & (bits - 1)))
      ++sides;
  return sides;
}

int count_sides(const MeshView& mesh, double angle) {
  const InstanceView instance{.geometry = mesh};
  return count_sides(SceneView{.instances = {&instance, 1}}, angle);
}

/// Quads of four corners each, and the edges of those that a camera sees.
struct Quads {
  using Corners = std::vector<std::vector<Vec3>>;
  explicit Quads(Corners of_each) : corners(std::move(of_each)) {
    for (const auto& c : corners) {
      instances.add(MeshView{.positions = c, .indices = ring, .faces = {FaceKind::quads, {}}});
    }
  }
  [[nodiscard]] Image<float> factor(const Camera& camera, int size, double width) const {
    const SceneView scene{.instances = instances};
    Image<std::int64_t> ids(size, size);
    Renderer renderer;
    (void)renderer.render(scene, camera, {.width = size, .height = size}, {.ids = ids});
    Image<float> factor(size, size);
    Effects().edges(ids.view(), SceneEdges(scene), camera, width, factor);
    return factor;
  }
  Corners corners;
  std::vector<std::uint32_t> ring{0, 1, 2, 3};
  test::KeptInstances instances;
};

/// The same triangles without shared vertices.
Mesh soup(const Mesh& mesh) {
  Mesh apart;
  for (const std::uint32_t i : mesh.indices) apart.positions.push_back(mesh.positions[i]);
  return apart;
}

TEST(SceneEdges, AreThoseOfFacesThatMeetAtMoreThanAnAngle) {
  const Mesh box = shapes::boxes(1, 1);
  for (const Mesh& mesh : {box, soup(box)}) {
    EXPECT_EQ(count_sides(mesh.view(), 0), 36);   // of 12 triangles
    EXPECT_EQ(count_sides(mesh.view(), 30), 24);  // 12 edges, from both sides, without diagonals
    EXPECT_EQ(count_sides(mesh.view(), 89), 24);
    EXPECT_EQ(count_sides(mesh.view(), 91), 0);
  }
  // A single triangle has border edges, and so has an edge of three triangles.
  Mesh fins{.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}},
            .indices = {0, 1, 2, 1, 0, 3}};
  EXPECT_EQ(count_sides(fins.view(), 30), 4);  // they lie in one plane
  fins.indices = {0, 1, 2, 0, 1, 3};           // the same, flipped: no crease either
  EXPECT_EQ(count_sides(fins.view(), 30), 4);
  fins.indices = {0, 1, 2, 1, 0, 3, 0, 1, 4};
  EXPECT_EQ(count_sides(fins.view(), 30), 9);
  // A degenerate triangle is no neighbour.
  fins.indices = {0, 1, 2, 0, 0, 1, 1, 0, 3};
  EXPECT_EQ(count_sides(fins.view(), 30), 4);
}

TEST(SceneEdges, LeaveOutWhatCutsFaces) {
  const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {1.5F, 1, 0}, {0.5F, 2, 0}, {-0.5F, 1, 0}};
  const std::vector<std::uint32_t> ring{0, 1, 2, 3, 4}, offsets{0, 5};
  MeshView mesh{.positions = corners, .indices = ring, .faces = {FaceKind::polygons, offsets}};
  EXPECT_EQ(count_sides(mesh, 0), 5);
  const std::vector<std::uint32_t> quads{0, 1, 2, 4, 4, 2, 3, 3};
  mesh.indices = quads;
  mesh.faces = {FaceKind::quads, {}};
  // The other one repeats a corner, so its second triangle is degenerate.
  EXPECT_EQ(count_sides(mesh, 0), 4 + 3);
  mesh.faces = {FaceKind::strips, {}};
  mesh.indices = ring;
  EXPECT_EQ(count_sides(mesh, 0), 9);
}

TEST(SceneEdges, CountPrimitivesThroughInstances) {
  const Mesh box = shapes::boxes(1, 1);
  const std::vector<Vec3> centres{{0, 0, 0}, {1, 0, 0}};
  const test::KeptInstances instances{box.view(), PointsView{.positions = centres}, box.view()};
  const SceneView scene{.instances = instances};
  EXPECT_EQ(count_sides(scene, 30), 48);
  const SceneEdges edges(scene);
  EXPECT_EQ(edges.find(13).instance, 1U);
  EXPECT_EQ(edges.find(14).instance, 2U);
  EXPECT_EQ(edges.find(14).primitive, 0U);
  EXPECT_EQ(edges.sides(edges.find(12)), 0);
  EXPECT_THROW(static_cast<void>(edges.find(26)), Error);
  EXPECT_THROW(static_cast<void>(edges.find(-1)), Error);
  EXPECT_THROW(SceneEdges(scene, -1), Error);
  EXPECT_THROW(SceneEdges(scene, std::nan("")), Error);
}

TEST(Edges, AreAsWideAsAskedAndHiddenWithWhatHidesThem) {
  // 10 px a unit: a unit square hides the upper edges of a larger one of 4 units behind it.
  const Quads quads(
      Quads::Corners{{{-2, -2, -1}, {2, -2, -1}, {2, 2, -1}, {-2, 2, -1}},
                     {{-0.5F, -0.5F, 0}, {0.5F, -0.5F, 0}, {0.5F, 0.5F, 0}, {-0.5F, 0.5F, 0}}});
  const Camera camera{.eye = {0, 0, 5},
                      .target = {0, 0, 0},
                      .orthographic = true,
                      .orthographic_height = 6,
                      .far_plane = 20};
  for (const double width : {1.0, 2.5})
    EXPECT_TRUE(test::pixels_are_near(quads.factor(camera, 60, width), 1e-6, [&](int x, int y) {
      // Distance from the centre, px.
      const double away = std::max(std::fabs(x + 0.5 - 30), std::fabs(y + 0.5 - 30));
      double inside = INFINITY;  // of the visible edge
      if (away < 5)
        inside = 5 - away;
      else if (away < 20)
        inside = 20 - away;
      return 1 - std::clamp(width / 2 + 0.5 - inside, 0.0, 1.0);
    })) << width;
}

TEST(Edges, AreTheSameBitsForThreadsInstructionSetsAndAlgorithms) {
  Scene scene = shapes::scene_from_spec("boxes?count=3");
  const SceneBinding binding(scene);
  constexpr int kWidth = 331, kHeight = 203;
  const Camera camera = fit_picture(binding.view(), {.eye = {1.2, 0.9, 1.7}}, kWidth, kHeight);
  const SceneEdges edges(binding.view(), 30);
  const Digest drawn =
      test::EveryWay({{.threads = 1}, {.threads = 3}}).same([&](const test::RenderOptions& by) {
        Image<std::int64_t> ids(kWidth, kHeight);
        Renderer renderer(by);
        (void)renderer.render(binding.view(), camera, {.width = kWidth, .height = kHeight},
                              {.ids = ids});
        Image<float> factor(kWidth, kHeight);
        Effects(by.threads, by.isa).edges(ids.view(), edges, camera, 1.5, factor);
        return digest(factor.view());
      });
  EXPECT_TRUE(test::matches_golden("effects/edges", drawn));
}

TEST(Edges, OfTrianglesThatReachBehindTheEyeAreStraight) {
  // A floor of one square that begins behind the eye. Its sides meet at the middle of the horizon.
  const Quads floor(Quads::Corners{{{-1, -1, 1}, {1, -1, 1}, {1, -1, -50}, {-1, -1, -50}}});
  constexpr int kSize = 100;
  const Image<float> factor = floor.factor({.eye = {0, 0, 0}, .target = {0, 0, -1}}, kSize, 2);
  // The side at x = −1, y = −1 is the diagonal of the lower left quarter.
  for (int y = 55; y < 95; ++y) EXPECT_LT(factor(kSize - 1 - y, y), 0.01F) << y;
  EXPECT_EQ(factor(50, 80), 1);
}

TEST(Edges, RefuseWhatIsNotOfTheirScene) {
  const Mesh box = shapes::boxes(1, 1);
  const test::OneInstance instance(box.view());
  const SceneView scene = instance.view();
  const SceneEdges edges(scene);
  Image<std::int64_t> ids(4, 3);
  Image<float> factor(4, 3), other(5, 3);
  Effects effects;
  EXPECT_NO_THROW(effects.edges(ids.view(), edges, {}, 1, factor));
  EXPECT_THROW(effects.edges(ids.view(), edges, {}, 1, other), Error);
  EXPECT_THROW(effects.edges({}, edges, {}, 1, factor), Error);
  EXPECT_THROW(effects.edges(ids.view(), edges, {}, 0, factor), Error);
  EXPECT_THROW(effects.edges(ids.view(), edges, {}, std::nan(""), factor), Error);
  ids(2, 1) = 12;
  EXPECT_THROW(effects.edges(ids.view(), edges, {}, 1, factor), Error);
}

}  // namespace
}  // namespace rastrum::edges_test
