// Spheres, cones and tubes that bins make when they see them (raster/bin/bin_quadrics.hpp):
// thousands of them, hidden and seen, small and large, beside what must be made before and beside
// triangles. surfaces_test.cpp has a few at a time, and the oracle.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/random.hpp"

namespace rastrum::test {
namespace deferred_quadrics_test {

/// Looks along −z; at distance 1 a unit is half the picture's height.
Camera camera_at_origin(bool orthographic) {
  Camera camera;
  camera.eye = {0, 0, 0};
  camera.target = {0, 0, -1};
  camera.near_plane = 1;
  camera.fov_rad = 2 * std::atan(1.0F);
  camera.orthographic = orthographic;
  if (orthographic) {
    camera.orthographic_height = 6;
    camera.far_plane = 10;
  }
  return camera;
}

/// A scene with some of everything: spheres, tubes, cones and triangles, from small to large.
class Crowd {
 public:
  explicit Crowd(std::uint64_t seed) : random_(seed) {
    for (int i = 0; i < 2000; ++i) add_sphere(0.01F, 0.15F);
    for (int i = 0; i < 12; ++i) add_sphere(0.4F, 1.5F);  // many bins, and the near plane
    for (int i = 0; i < 150; ++i) add_line();
    for (int i = 0; i < 120; ++i) add_cone();
    SpheresView spheres;
    spheres.centers = centres_;
    spheres.radii = sphere_radii_;
    spheres.colors = colors_;
    TubesView tubes;
    tubes.positions = line_positions_;
    offsets_.push_back(static_cast<std::uint32_t>(line_positions_.size()));
    tubes.offsets = offsets_;
    tubes.radii = line_radii_;
    tubes.colors = line_colors_;
    CylindersView cones;
    cones.positions = cone_positions_;
    cones.radii = cone_radii_;
    CylindersView open = cones;
    open.caps = false;
    instances_ = {InstanceView{spheres, turned(0)},    InstanceView{tubes, turned(0.2)},
                  InstanceView{mesh_.view(), ahead()}, InstanceView{cones, turned(0)},
                  InstanceView{open, turned(0.1)},     InstanceView{spheres, turned(-0.3)}};
  }
  [[nodiscard]] SceneView view() const { return {instances_, {}, {}}; }

 private:
  float real(double a, double b) { return static_cast<float>(random_.real(a, b)); }
  Vec3 place() {
    const float z = real(-6, -0.9);
    return {real(-1.6, 1.6) * -z, real(-1.2, 1.2) * -z, z};
  }
  /// Squeezed, so that spheres become ellipsoids, but for 0.
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
      // Points, round ends, and balls that hold their neighbours.
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
  std::vector<InstanceView> instances_;
};

struct Picture {
  Image<std::int64_t> ids;
  Image<float> depth;
  Image<Vec4> color;
  FrameStats stats;
};

/// Without overdraw: who counts that sees all, and nothing is deferred.
Picture draw(Renderer& renderer, const SceneView& scene, const Camera& camera,
             const FrameOptions& frame) {
  Picture p{Image<std::int64_t>(frame.width, frame.height),
            Image<float>(frame.width, frame.height),
            Image<Vec4>(frame.width, frame.height),
            {}};
  Targets targets;
  targets.ids = p.ids;
  targets.depth = p.depth;
  targets.color = p.color;
  p.stats = renderer.render(scene, camera, frame, targets);
  return p;
}

testing::AssertionResult same(const Picture& a, const Picture& b) {
  const auto bits = [](float v) { return std::bit_cast<std::uint32_t>(v); };
  for (int y = 0; y < a.ids.height(); ++y)
    for (int x = 0; x < a.ids.width(); ++x) {
      const Vec4 c = a.color(x, y), d = b.color(x, y);
      if (a.ids(x, y) != b.ids(x, y) || bits(a.depth(x, y)) != bits(b.depth(x, y)) ||
          bits(c.x) != bits(d.x) || bits(c.y) != bits(d.y) || bits(c.z) != bits(d.z) ||
          bits(c.w) != bits(d.w))
        return testing::AssertionFailure()
               << "at (" << x << ", " << y << "): id " << a.ids(x, y) << " and " << b.ids(x, y)
               << ", depth " << a.depth(x, y) << " and " << b.depth(x, y) << ", red " << c.x
               << " and " << d.x;
    }
  return testing::AssertionSuccess();
}

std::uint64_t counter(const FrameStats& stats, std::string_view name) {
  for (const auto& c : stats.counters)
    if (c.first == name) return c.second;
  return 0;
}

TEST(DeferredQuadrics, AreTheSameBitsEverywhere) {
  std::vector<std::unique_ptr<Renderer>> renderers;
  for (const Isa isa : available_isas())
    for (const int threads : {1, 3}) {
      RendererOptions o;
      o.device = Device::threads;
      o.threads = threads;
      o.isa = isa;
      renderers.push_back(std::make_unique<Renderer>(o));
    }
  // Bands, and pairs of pieces and bins in turns.
  RendererOptions limited;
  limited.threads = 2;
  limited.memory_limit = 3 << 20;
  renderers.push_back(std::make_unique<Renderer>(limited));
  Renderer reference({.device = Device::serial});
  constexpr Shader kShaders[] = {Shader::phong, Shader::material, Shader::id, Shader::normal};
  std::uint64_t hidden = 0;
  for (int seed = 0; seed < 8; ++seed) {
    const Crowd crowd(static_cast<std::uint64_t>(seed));
    const Camera camera = camera_at_origin(seed % 4 == 3);
    FrameOptions frame;
    frame.width = 223;
    frame.height = 141;
    frame.shader = kShaders[seed % 4];
    frame.cull = seed == 5 ? Cull::back : seed == 6 ? Cull::front : Cull::none;
    const Picture expected = draw(reference, crowd.view(), camera, frame);
    for (const auto& renderer : renderers) {
      const Picture p = draw(*renderer, crowd.view(), camera, frame);
      ASSERT_TRUE(same(expected, p))
          << "seed " << seed << ", " << name(renderer->options().isa.value_or(Isa::scalar)) << ", "
          << renderer->options().threads << " threads, limit " << renderer->options().memory_limit;
      EXPECT_EQ(expected.stats.triangles.culled, p.stats.triangles.culled);
      EXPECT_EQ(expected.stats.triangles.dropped, p.stats.triangles.dropped);
      EXPECT_EQ(expected.stats.pixels_covered, p.stats.pixels_covered);
      EXPECT_LE(p.stats.fragments, expected.stats.fragments);
      hidden = std::max(hidden, counter(p.stats, "hidden pieces"));
    }
  }
  EXPECT_GT(hidden, 1000U);
}

/// A wall of spheres before everything else: behind it no sample is looked at.
TEST(DeferredQuadrics, AreNotMadeWhereTheyAreHidden) {
  std::vector<Vec3> centres;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x)
      for (int layer = 0; layer < 20; ++layer)
        centres.push_back({static_cast<float>(x - 10) * 0.1F, static_cast<float>(y - 10) * 0.1F,
                           // The nearest one is submitted last.
                           -4.0F + 0.1F * static_cast<float>(layer)});
  SpheresView spheres;
  spheres.centers = centres;
  spheres.radius = 0.08F;  // their front layer covers a pixel about twice
  const InstanceView instance{spheres};
  FrameOptions frame;
  frame.width = frame.height = 256;
  Renderer renderer({.threads = 1});
  const Picture p = draw(renderer, {{&instance, 1}, {}, {}}, camera_at_origin(false), frame);
  if (renderer.options().isa == Isa::scalar || available_isas().size() == 1)
    GTEST_SKIP() << "the scalar kernels defer nothing";
  EXPECT_GT(counter(p.stats, "hidden pieces"), 5000U);
  EXPECT_LT(p.stats.fragments, 5 * p.stats.pixels_covered);
}

}  // namespace deferred_quadrics_test
}  // namespace rastrum::test
