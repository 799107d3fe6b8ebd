// SPDX-License-Identifier: BSD-3-Clause
// A fit, which reads only some runs of a scene's vertices, finds the same as one that reads all.
#include <rastrum/scene/vertices_in_use.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/transform.hpp>

#include "tests/support/matrices.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::scene_vertices_test {
namespace {

/// The first of the farthest vertices along x, for VerticesInUse::reduce.
struct FirstFarthest {
  double x = -std::numeric_limits<double>::infinity();
  Vec3d at;

  void add(const Vec3d& p) { merge({p.x, p}); }
  void merge(const FirstFarthest& later) {
    if (later.x > x) *this = later;
  }
  [[nodiscard]] std::array<double, 1> values() const { return {x}; }
  [[nodiscard]] static std::array<double, 1> bounds(const VerticesInUse::WorldBox& b) {
    return {b.centre.x + b.half.x};
  }
};

/// Vertices in a lattice, so that many are equally far. One in eight has no triangle, and one in
/// fifty is NaN.
struct Vertices {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> indices;
};
Vertices vertices(std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  Vertices made;
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = [&] { return static_cast<float>(random() % 41) / 4 - 5; };
    made.positions.push_back({number(), number(), number()});
    if (random() % 50 == 0) made.positions.back().y = std::numeric_limits<float>::quiet_NaN();
    if (random() % 8 != 0)
      made.indices.insert(made.indices.end(), 3, static_cast<std::uint32_t>(i));
  }
  return made;
}

/// The vertices that a fit reads, in order.
std::vector<Vec3d> in_order(const SceneView& scene) {
  std::vector<Vec3d> all;
  const auto add = [&](const InstanceView& instance, const Vec3d& p) {
    const Vec3d world = place_of(instance.object_to_world, p);
    if (is_finite(world)) all.push_back(world);
  };
  for (const InstanceView& instance : scene.instances) {
    if (const MeshView* const mesh = instance.mesh()) {
      std::vector<bool> used(mesh->positions.size());
      for (std::size_t c = 0; c < mesh->corner_count(); ++c) used[mesh->vertex(c)] = true;
      for (std::size_t v = 0; v < used.size(); ++v)
        if (used[v]) add(instance, mesh->positions.wide(v));
    } else {
      const auto& points = *instance.geometry.get_if<PointsView>();
      for (std::size_t i = 0; i < points.size(); ++i)
        add(instance, points.positions.wide(points.vertex(i)));
    }
  }
  return all;
}

TEST(SceneVertices, FindWhatAllVerticesHave) {
  const Vertices a = vertices(9000, 1), b = vertices(1500, 2);
  MeshView whole, part;
  whole.positions = a.positions;
  whole.indices = a.indices;
  part = whole;  // in the same memory
  part.indices = std::span(a.indices).first(300);
  PointsView points{.positions = b.positions};
  const Mat4d turned = translation({0.3, -20, 4}) * rotation(rotation_about({1, 2, 3}, 0.7));
  const std::vector<InstanceView> instances = {{part},
                                               {whole},
                                               {part, turned},
                                               {points, translation({0.1, 0, 0})},
                                               {points, turned},
                                               {whole, turned},
                                               {whole, translation({0, 0, 1})}};
  for (std::size_t first = 0; first < instances.size(); ++first)
    for (std::size_t end = first; end <= instances.size(); ++end) {
      SCOPED_TRACE(testing::Message() << first << " to " << end);
      SceneView scene{.instances = std::span(instances).subspan(first, end - first)};
      const std::vector<Vec3d> all = in_order(scene);
      FirstFarthest farthest;
      ExtentOfVertices extent;
      ReachOfVertices reach{{1, 2, 3}};
      for (const Vec3d& p : all) {
        farthest.add(p);
        extent.add(p);
        reach.add(p);
      }
      const VerticesInUse in_use(scene);
      EXPECT_EQ(in_use.reduce(FirstFarthest{}).at, farthest.at);
      EXPECT_EQ(in_use.reduce(ExtentOfVertices{}).min, extent.min);
      EXPECT_EQ(in_use.reduce(ExtentOfVertices{}).max, extent.max);
      EXPECT_EQ(in_use.reduce(ReachOfVertices{{1, 2, 3}}).reach, reach.reach);
      EXPECT_EQ(bounds(scene).vertices_in_use, all.size());
    }
}

/// Runs that cannot change the result are not read. Otherwise a fit of a million instances would
/// cost a second per pass.
TEST(SceneVertices, MostRunsStayUnread) {
  class Counted final : public FitVertices {
   public:
    explicit Counted(const SceneView& scene) : of_(scene) {}
    [[nodiscard]] std::size_t runs() const override { return of_.runs(); }
    [[nodiscard]] std::optional<Box> box(std::size_t run) const override { return of_.box(run); }
    [[nodiscard]] const Mat4d& object_to_world(std::size_t run) const override {
      return of_.object_to_world(run);
    }
    void read(std::span<const std::size_t> runs,
              FunctionRef<void(std::size_t, std::span<const Vec3d>)> f) const override {
      read_ += runs.size();
      of_.read(runs, f);
    }
    mutable std::size_t read_ = 0;

   private:
    SceneVertices of_;
  };
  class Ranks final : public FitRanks {
   public:
    explicit Ranks(const FitVertices& beyond) : beyond_(beyond) {}
    void own(FunctionRef<void()> work) override { work(); }
    [[nodiscard]] std::vector<double> gather(std::span<const double> numbers) override {
      return {numbers.begin(), numbers.end()};
    }
    [[nodiscard]] const FitVertices* beyond() const override { return &beyond_; }

   private:
    const FitVertices& beyond_;
  };
  const Vertices a = vertices(2000, 3);
  MeshView mesh{.positions = a.positions, .indices = a.indices};
  std::vector<InstanceView> instances;
  for (int i = 0; i < 500; ++i)
    instances.push_back({mesh, translation({i * 7 % 500 * 20.0, 0, 0})});
  SceneView scene{.instances = instances};
  const Counted counted(scene);
  Ranks ranks(counted);
  EXPECT_EQ(VerticesInUse({}, &ranks).reduce(FirstFarthest{}).at,
            VerticesInUse(scene).reduce(FirstFarthest{}).at);
  EXPECT_LE(counted.read_, 2U);
}

TEST(SceneVertices, RefusesRadiiThatThereAreNot) {
  const std::vector<Vec3> centers(4);
  const std::vector<float> radii(3);
  SpheresView spheres{.centers = centers, .radii = radii};
  const std::vector<InstanceView> instances = {{spheres}};
  SceneView scene{.instances = instances};
  EXPECT_EQ(refusal_of([&] { (void)SceneVertices(scene); }),
            "radii: there are 3, and number 3 is asked for");
}

}  // namespace
}  // namespace rastrum::test::scene_vertices_test
