// SPDX-License-Identifier: BSD-3-Clause
// Spheres, cones and tubes that bins set up on first sight (raster/bin/bin_quadrics.hpp):
// thousands, hidden and visible, small and large, beside primitives that are set up before and
// beside triangles. surfaces_test.cpp has a few at a time, and the oracle.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/every_way.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test {
namespace bin_quadrics_test {

/// Looks along −z; at distance 1 a unit is half the picture's height.
Camera camera_at_origin(bool orthographic) {
  Camera camera{.eye = {0, 0, 0},
                .target = {0, 0, -1},
                .fov_rad = 2 * std::atan(1.0F),
                .orthographic = orthographic,
                .near_plane = 1};
  if (orthographic) {
    camera.orthographic_height = 6;
    camera.far_plane = 10;
  }
  return camera;
}

/// A scene of spheres, tubes, cones and triangles of all sizes.
class Crowd {
 public:
  explicit Crowd(std::uint64_t seed) : random_(seed) {
    for (int i = 0; i < 2000; ++i) add_sphere(0.01F, 0.15F);
    for (int i = 0; i < 12; ++i) add_sphere(0.4F, 1.5F);  // many bins, and the near plane
    for (int i = 0; i < 150; ++i) add_line();
    for (int i = 0; i < 120; ++i) add_cone();
    const SpheresView spheres{.centers = centres_, .radii = sphere_radii_, .colors = colors_};
    TubesView tubes{.positions = line_positions_};
    offsets_.push_back(static_cast<std::uint32_t>(line_positions_.size()));
    tubes.offsets = offsets_;
    tubes.radii = line_radii_;
    tubes.colors = line_colors_;
    CylindersView cones{.positions = cone_positions_, .radii = cone_radii_};
    CylindersView open = cones;
    open.caps = false;
    instances_.add(spheres, turned(0));
    instances_.add(tubes, turned(0.2));
    instances_.add(mesh_.view(), ahead());
    instances_.add(cones, turned(0));
    instances_.add(open, turned(0.1));
    instances_.add(spheres, turned(-0.3));
  }
  [[nodiscard]] SceneView view() const { return {instances_, {}, {}}; }

 private:
  float real(double a, double b) { return static_cast<float>(random_.real(a, b)); }
  Vec3 place() {
    const float z = real(-6, -0.9);
    return {real(-1.6, 1.6) * -z, real(-1.2, 1.2) * -z, z};
  }
  /// Scaled unevenly, so that spheres become ellipsoids, except for 0.
  static Mat4d turned(double by) {
    Mat4d m = Mat4d::identity();
    m.m[0][1] = by;
    m.m[1][1] = 1 - std::abs(by);
    m.m[0][3] = by;
    return m;
  }
  static Mat4d ahead() {
    Mat4d m = Mat4d::identity();
    m.m[2][3] = -3;
    return m;
  }
  Vec4 color() { return {real(0, 1), real(0, 1), real(0, 1), 1}; }
  void add_sphere(float least, float most) {
    centres_.push_back(place());
    sphere_radii_.push_back(random_.chance(0.02) ? 0 : real(least, most));
    colors_.push_back(color());
  }
  void add_line() {
    offsets_.push_back(static_cast<std::uint32_t>(line_positions_.size()));
    Vec3 p = place();
    const float radius = real(0.01, 0.08);
    for (int i = 0; i < 5; ++i) {
      line_positions_.push_back(p);
      line_colors_.push_back(color());
      // Points, round ends, and balls that contain their neighbours.
      line_radii_.push_back(random_.chance(0.1) ? 0 : random_.chance(0.1) ? 6 * radius : radius);
      p = p + Vec3{real(-0.3, 0.3), real(-0.3, 0.3), real(-0.3, 0.3)};
    }
  }
  void add_cone() {
    const Vec3 p = place();
    cone_positions_.insert(cone_positions_.end(),
                           {p, p + Vec3{real(-0.5, 0.5), real(-0.5, 0.5), real(-0.5, 0.5)}});
    cone_radii_.insert(cone_radii_.end(),
                       {real(0.02, 0.2), random_.chance(0.3) ? 0 : real(0, 0.2)});
  }

  Random random_;
  std::vector<Vec3> centres_, line_positions_, cone_positions_;
  std::vector<float> sphere_radii_, line_radii_, cone_radii_;
  std::vector<Vec4> colors_, line_colors_;
  std::vector<std::uint32_t> offsets_;
  Mesh mesh_ = shapes::soup(400, 0.05F, 0.5F);
  KeptInstances instances_;
};

/// Without overdraw, which would count hidden fragments too and so defer nothing.
constexpr unsigned kKinds = kColor | kDepth | kIds;

TEST(BinQuadrics, AreTheSameBitsEverywhere) {
  // Also bands, and pairs of pieces and bins in turns.
  EveryWay ways{{.threads = 1},
                {.threads = 3},
                {.memory_limit = 3 << 20, .threads = 2, .isa = available_isas().back()}};
  constexpr Shader kShaders[] = {Shader::phong, Shader::material, Shader::id, Shader::normal};
  std::uint64_t hidden = 0;
  for (int seed = 0; seed < 8; ++seed) {
    const Crowd crowd(static_cast<std::uint64_t>(seed));
    const Camera camera = camera_at_origin(seed % 4 == 3);
    FrameOptions frame{.width = 223,
                       .height = 141,
                       .shader = kShaders[seed % 4],
                       .cull = seed == 5   ? Cull::back
                               : seed == 6 ? Cull::front
                                           : Cull::none};
    ways.same(
        [&](Renderer& renderer) {
          SCOPED_TRACE(seed);
          return draw(renderer, crowd.view(), camera, frame, kKinds);
        },
        [&](const Frame& p, const Frame& expected) {
          EXPECT_TRUE(same_triangles(p.stats, expected.stats));
          EXPECT_LE(p.stats.fragments, expected.stats.fragments);
          for (const auto& [name, value] : p.stats.counters)
            if (name == "hidden pieces") hidden = std::max(hidden, value);
        });
  }
  EXPECT_GT(hidden, 1000U);
}

/// A wall of spheres in front of everything: no sample behind it is tested.
TEST(BinQuadrics, AreNotMadeWhereTheyAreHidden) {
  std::vector<Vec3> centres;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x)
      for (int layer = 0; layer < 20; ++layer)
        centres.push_back({static_cast<float>(x - 10) * 0.1F, static_cast<float>(y - 10) * 0.1F,
                           // The nearest one is submitted last.
                           -4.0F + 0.1F * static_cast<float>(layer)});
  SpheresView spheres{.centers = centres};
  spheres.radius = 0.08F;  // their front layer covers a pixel about twice
  const InstanceView instance{spheres};
  FrameOptions frame{.width = 256, .height = 256};
  Renderer renderer({.threads = 1});
  const Frame p = draw(renderer, {{&instance, 1}, {}, {}}, camera_at_origin(false), frame, kKinds);
  if (renderer.options().isa == Isa::scalar || available_isas().size() == 1)
    GTEST_SKIP() << "the scalar kernels defer nothing";
  EXPECT_GT(counter(p.stats, "hidden pieces"), 5000U);
  EXPECT_LT(p.stats.fragments, 5 * p.stats.pixels_covered);
}

}  // namespace bin_quadrics_test
}  // namespace rastrum::test
