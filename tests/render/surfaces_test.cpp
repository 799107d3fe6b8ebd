// Spheres, cylinders, cones, tubes and discs against their oracle, and every way to draw them
// against the others.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/render.hpp>

#include "tests/support/every_way.hpp"
#include "tests/support/random.hpp"
#include "tests/support/surface_oracle.hpp"
#include "tests/support/surface_scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test {
namespace surfaces_test {

constexpr int kWidth = 40, kHeight = 27;

/// Two surfaces that lie closer than this, in reversed depth and relative to it, may come in either
/// order: depth is a float32. Triangles, which have a test of their own (oracle_test.cpp), are
/// snapped and have one of a plane in float32.
constexpr Real kDepthTie = 3e-7L, kTriangleTie = 2e-3L;
/// A silhouette that passes a pixel's centre closer than this, px.
constexpr Real kEdgeTie = 1e-6L, kTriangleEdgeTie = 1;

Frame draw(Renderer& renderer, const SurfaceScene& s, FrameOptions frame) {
  frame.width = s.width;
  frame.height = s.height;
  frame.clip_planes = s.clip_planes;
  return test::draw(renderer, s.view(), s.camera, frame, kIds | kDepth | kColor | kOverdraw);
}

/// The things that may be seen at a pixel: more than one in a tie.
class Truth {
 public:
  Truth(const SurfaceScene& s, int x, int y) : s_(s), x_(x), y_(y) {}

  [[nodiscard]] bool allows(std::int64_t id, float depth) {
    if (allows_at(s_.primitives, 0, 0, id, depth)) return true;
    is_tie_ = true;
    // Allows things that are seen beside the centre.
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (allows_at(s_.primitives, dx * kEdgeTie, dy * kEdgeTie, id, depth)) return true;
    // Near a triangle's edge it may be there or not.
    std::vector<SurfacePrimitive> others = s_.primitives;
    std::erase_if(others, is_triangle);
    if (others.size() == s_.primitives.size() || !is_at_triangle_edge()) return false;
    return is_triangle_id(id) || allows_at(others, 0, 0, id, depth);
  }
  [[nodiscard]] bool is_tie() const { return is_tie_; }
  [[nodiscard]] std::string text() const {
    std::string t;
    for (const SurfacePrimitive& p : s_.primitives)
      t += " " + std::to_string(p.id) + ":" + std::to_string(static_cast<int>(p.kind));
    t += ";";
    for (const SurfaceHit& h : surfaces_at(s_.eye, s_.primitives, x_ + 0.5L, y_ + 0.5L))
      t += " " + std::to_string(h.id) + (h.front ? "f" : "b") + "@" + std::to_string(h.depth);
    return t;
  }

 private:
  static bool is_triangle(const SurfacePrimitive& p) { return p.kind == SurfaceKind::triangle; }
  [[nodiscard]] bool is_triangle_id(std::int64_t id) const {
    return std::ranges::any_of(
        s_.primitives, [&](const SurfacePrimitive& p) { return p.id == id && is_triangle(p); });
  }
  [[nodiscard]] bool is_at_triangle_edge() const {
    std::vector<SurfacePrimitive> triangles = s_.primitives;
    std::erase_if(triangles, [](const SurfacePrimitive& p) { return !is_triangle(p); });
    std::size_t least = triangles.size(), most = 0;
    for (int dy = -4; dy <= 4; ++dy)
      for (int dx = -4; dx <= 4; ++dx) {
        const Real px = x_ + 0.5L + dx * kTriangleEdgeTie / 4;
        const Real py = y_ + 0.5L + dy * kTriangleEdgeTie / 4;
        const std::size_t n = surfaces_at(s_.eye, triangles, px, py).size();
        least = std::min(least, n);
        most = std::max(most, n);
      }
    return least != most;
  }
  [[nodiscard]] bool allows_at(const std::vector<SurfacePrimitive>& scene, Real dx, Real dy,
                               std::int64_t id, float depth) {
    const auto hits = surfaces_at(s_.eye, scene, x_ + 0.5L + dx, y_ + 0.5L + dy);
    if (hits.empty()) return id == -1;
    const auto cut = [](Real d) { return std::clamp<Real>(d, 0, 1); };
    const Real nearest = cut(hits.front().depth);
    for (const SurfaceHit& h : hits) {
      const bool loose = is_triangle_id(h.id) || is_triangle_id(hits.front().id);
      const Real tie = loose ? kTriangleTie * std::max(nearest, Real(0.05)) : kDepthTie * nearest;
      if (cut(h.depth) < nearest - tie) break;
      if (h.id != id) continue;
      // At a silhouette depth runs away within the tie.
      const bool is_beside = dx != 0 || dy != 0;
      const Real slack = loose ? tie : is_beside ? Real(3e-3) * nearest : tie;
      if (std::abs(cut(h.depth) - static_cast<Real>(depth)) > slack + Real(1e-12)) continue;
      is_tie_ |= &h != hits.data();
      return true;
    }
    return false;
  }

  const SurfaceScene& s_;
  int x_, y_;
  bool is_tie_ = false;
};

TEST(Surfaces, AreThoseOfTheOracle) {
  Renderer reference({.device = Device::serial});
  std::map<std::string, std::array<int, 3>> counts;  // of a kind: pixels, seen, ties
  const int n = share_of(1100, 55);
  for (int seed = 0; seed < n; ++seed) {
    SurfaceScene s = generate_surfaces(static_cast<std::uint64_t>(seed), kWidth, kHeight);
    if (seed % 4 == 1) add_clip_planes(s, static_cast<std::uint64_t>(seed));
    FrameOptions frame;
    frame.cull = seed % 5 == 3 ? Cull::back : seed % 7 == 3 ? Cull::front : Cull::none;
    for (SurfacePrimitive& p : s.primitives) {
      p.culls_back = frame.cull == Cull::back;
      p.culls_front = frame.cull == Cull::front;
    }
    const Frame p = draw(reference, s, frame);
    ASSERT_EQ(p.stats.triangles.dropped, s.dropped) << "scene " << seed;
    auto& [pixels, seen, ties] = counts[s.kind];
    for (int y = 0; y < s.height; ++y)
      for (int x = 0; x < s.width; ++x) {
        Truth truth(s, x, y);
        EXPECT_TRUE(truth.allows(p.ids(x, y), p.depth(x, y)))
            << "scene " << seed << " (" << s.kind << "), pixel (" << x << ", " << y << "): id "
            << p.ids(x, y) << " at depth " << p.depth(x, y)
            << ", primitives and what the oracle has:" << truth.text();
        ++pixels;
        seen += p.ids(x, y) >= 0;
        ties += truth.is_tie();
      }
  }
  int all = 0, tied = 0;
  for (const auto& [kind, c] : counts) {
    all += c[0];
    tied += c[2];
    EXPECT_GT(c[1], c[0] / 100) << kind << ": too little to be seen";
  }
  EXPECT_LT(tied, all / 200);
  std::printf("%d of %d pixels are ties\n", tied, all);
}

FrameOptions frame_of(int seed) {
  constexpr Shader kShaders[] = {Shader::phong, Shader::material, Shader::normal,   Shader::id,
                                 Shader::flat,  Shader::lambert,  Shader::wireframe};
  return FrameOptions{.shader = kShaders[seed % 7],
                      .cull = seed % 11 == 3 ? Cull::back : Cull::none,
                      .opacity = seed % 3 == 1 ? 0.4F : 1,
                      .samples = seed % 5 == 2 ? 4 : 1};
}

TEST(Surfaces, AreTheSameBitsEverywhere) {
  EveryWay ways{{.threads = 1},
                {.threads = 3},
                {.memory_limit = 3 << 20, .threads = 2, .isa = available_isas().back()}};
  const int n = share_of(154, 55);
  for (int seed = 0; seed < n; ++seed) {
    // Several bins and, below a limit, several bands.
    SurfaceScene s = generate_surfaces(static_cast<std::uint64_t>(seed), 150, 97);
    if (seed % 4 == 1) add_clip_planes(s, static_cast<std::uint64_t>(seed));
    const FrameOptions frame = frame_of(seed);
    SCOPED_TRACE(testing::Message() << "scene " << seed << " (" << s.kind << ")");
    ways.same([&](Renderer& renderer) { return draw(renderer, s, frame); },
              [&](const Frame& p, const Frame& expected) {
                EXPECT_TRUE(same_counts(p.stats, expected.stats));
              });
  }
}

/// Normals for a shader point outwards, whatever side is seen, under any affine matrix, too.
TEST(Surfaces, HaveTheNormalsOfTheOracle) {
  Renderer renderer({.threads = 1});
  int pixels = 0, seams = 0;
  for (int seed = 0; seed < 220; ++seed) {
    const SurfaceScene s = generate_surfaces(static_cast<std::uint64_t>(seed), kWidth, kHeight);
    FrameOptions frame{.shader = Shader::normal};
    const Frame p = draw(renderer, s, frame);
    for (int y = 0; y < s.height; ++y)
      for (int x = 0; x < s.width; ++x) {
        if (p.ids(x, y) < 0) continue;
        const auto hits = surfaces_at(s.eye, s.primitives, x + 0.5L, y + 0.5L);
        if (hits.empty() || hits.front().id != p.ids(x, y)) continue;
        const Point3 n = hits.front().normal;
        const Real length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
        if (!(length > 0)) continue;  // a triangle's
        ++pixels;
        const Vec4 c = p.color(x, y);
        const Real off = std::max({std::abs(n.x / length - (2 * Real(c.x) - 1)),
                                   std::abs(n.y / length - (2 * Real(c.y) - 1)),
                                   std::abs(n.z / length - (2 * Real(c.z) - 1))});
        // Where a side meets an end, rounding decides whose normal it is; an apex has none.
        seams += off > 1e-4L;
      }
  }
  EXPECT_GT(pixels, 50000);
  EXPECT_LE(seams, pixels / 20000);
}

/// Samples at the places of D3D11's pattern of 4 (in sixteenths), and the share of a pixel that 64
/// samples find.
TEST(Surfaces, SilhouettesAreThoseOfTheSamples) {
  constexpr int kPattern[4][2] = {{-2, -6}, {6, -2}, {-6, 2}, {2, 6}};
  Renderer renderer({.threads = 1});
  int edges = 0, ties = 0;
  double off_64 = 0;
  for (int seed = 0; seed < 5 * kSurfaceKinds; ++seed) {
    SurfaceScene s = generate_surfaces(static_cast<std::uint64_t>(seed), kWidth, kHeight);
    if (std::ranges::any_of(s.primitives, [](const SurfacePrimitive& p) {
          return p.kind == SurfaceKind::triangle;
        }))
      continue;
    FrameOptions frame{.shader = Shader::flat, .samples = 4};
    const Frame p = draw(renderer, s, frame);
    for (int y = 0; y < s.height; ++y)
      for (int x = 0; x < s.width; ++x) {
        const auto is_covered = [&](Real dx, Real dy) {
          return !surfaces_at(s.eye, s.primitives, x + 0.5L + dx, y + 0.5L + dy).empty();
        };
        int covered = 0;
        for (const auto& at : kPattern) covered += is_covered(at[0] / 16.0L, at[1] / 16.0L);
        const float alpha = p.color(x, y).w;
        ties += alpha != static_cast<float>(covered) / 4;
        if (covered == 0 || covered == 4) continue;
        ++edges;
        int of_64 = 0;
        for (int i = 0; i < 64; ++i) of_64 += is_covered((i % 8 - 3.5L) / 8, (i / 8 - 3.5L) / 8);
        off_64 += std::abs(static_cast<double>(alpha) - of_64 / 64.0);
      }
  }
  ASSERT_GT(edges, 500);
  EXPECT_EQ(ties, 0);
  EXPECT_LT(off_64 / edges, 0.13);
}

/// A closed surface has two layers.
TEST(Surfaces, AreBlendedFrontOverBack) {
  const Vec3 centre{0, 0, -4};
  SpheresView spheres{.centers = std::span(&centre, 1)};
  const InstanceView instance{spheres};
  Camera camera{.eye = {0, 0, 0}, .target = {0, 0, -1}};
  for (const Cull cull : {Cull::none, Cull::back}) {
    FrameOptions frame{
        .width = 15, .height = 15, .shader = Shader::flat, .cull = cull, .opacity = 0.5F};
    Image<Vec4> color(15, 15);
    Renderer renderer;
    (void)renderer.render({{&instance, 1}, {}, {}}, camera, frame, {.color = color});
    EXPECT_EQ(color(7, 7).w, cull == Cull::none ? 0.75F : 0.5F);
    EXPECT_EQ(color(0, 0).w, 0);
  }
}

/// An instance's own look, as a mesh's.
TEST(Surfaces, HaveTheirInstancesLook) {
  const Vec3 centre{0, 0, -4};
  const Vec4 green{0, 1, 0, 1};
  SpheresView spheres{.centers = std::span(&centre, 1), .colors = std::span(&green, 1)};
  Camera camera{.eye = {0, 0, 0}, .target = {0, 0, -1}};
  FrameOptions frame{.width = 15, .height = 15, .shader = Shader::flat};
  Renderer renderer;
  const auto middle = [&](const InstanceView& instance) {
    Image<Vec4> color(15, 15);
    (void)renderer.render({{&instance, 1}, {}, {}}, camera, frame, {.color = color});
    return color(7, 7);
  };
  InstanceView instance{spheres};
  EXPECT_EQ(middle(instance).y, 1);
  instance.color = Vec4{1, 0, 0.5F, 1};
  EXPECT_EQ(middle(instance).x, 1);
  EXPECT_EQ(middle(instance).y, 0);
  EXPECT_EQ(middle(instance).z, 0.5F);
  instance.opacity = 0.5F;
  EXPECT_EQ(middle(instance).w, 0.75F);
  instance.visible = false;
  EXPECT_EQ(middle(instance).w, 0);
}

TEST(Surfaces, AreSeenByACameraThatFits) {
  const Vec3 centres[] = {{10, 2, -3}, {11, 2, -3}};
  const float radii[] = {2, 0.5F};
  SpheresView spheres{.centers = centres, .radii = radii};
  const InstanceView instance{spheres};
  const SceneView scene{{&instance, 1}, {}, {}};
  const Bounds b = bounds(scene);
  EXPECT_NEAR(b.min.x, 8, 1e-6);
  EXPECT_NEAR(b.max.x, 12, 1e-6);
  EXPECT_NEAR(b.max.z, -1, 1e-6);
  const Camera camera = fit_camera(scene, 0.8F, false);
  FrameOptions frame{.width = 64, .height = 64};
  Image<std::int64_t> ids(64, 64);
  Renderer renderer;
  const FrameStats stats = renderer.render(scene, camera, frame, {.ids = ids});
  EXPECT_GT(stats.pixels_covered, 1000U);
  for (int i = 0; i < 64; ++i)
    EXPECT_TRUE(ids(i, 0) < 0 && ids(i, 63) < 0 && ids(0, i) < 0 && ids(63, i) < 0) << i;
}

TEST(Surfaces, RefuseArraysThatDoNotFit) {
  const std::vector<Vec3> positions{{0, 0, -4}, {1, 0, -4}, {2, 0, -4}, {3, 0, -4}};
  const std::vector<float> few{1};
  const std::vector<std::uint32_t> odd{0, 1, 2}, beyond{0, 4}, falling{0, 2, 2}, past{0, 5};
  const std::vector<Vec4> colors{{1, 1, 1, 1}};
  struct Case {
    GeometryView geometry;
    const char* says;
  };
  const Case cases[] = {
      {SpheresView{positions, few}, "radii are fewer (1) than spheres (4)"},
      {SpheresView{positions, {}, 1, colors}, "colors are fewer (1) than spheres (4)"},
      {SpheresView{positions, {}, 1, {}, 3}, "material 3 is out of range, there are 1"},
      {CylindersView{positions, odd}, "the number of ends, 3, is odd"},
      {CylindersView{positions, beyond},
       "indices[1]: index 4 is out of range, there are 4 positions"},
      {CylindersView{positions, {}, few}, "radii are fewer (1) than positions (4)"},
      {TubesView{positions, falling},
       "offsets[2] is 2, which does not lie above the one before, 2"},
      {TubesView{positions, past}, "offsets[1] is 5, but there are 4 positions"},
      {DiscsView{positions}, "normals are fewer (0) than discs (4)"},
  };
  const Material material;
  Renderer renderer;
  for (const Case& c : cases) {
    const InstanceView instances[] = {{SpheresView{}}, {c.geometry}};
    Image<Rgba8> image(8, 8);
    FrameOptions frame{.width = 8, .height = 8};
    try {
      (void)renderer.render({instances, {&material, 1}, {}}, {}, frame, {.color8 = image});
      ADD_FAILURE() << "not refused: " << c.says;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), Errc::invalid_argument);
      EXPECT_NE(std::string(e.what()).find("instance 1: "), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find(c.says), std::string::npos) << e.what();
    }
  }
}

}  // namespace surfaces_test
}  // namespace rastrum::test
