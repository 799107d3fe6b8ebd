// SPDX-License-Identifier: BSD-3-Clause
// Spheres, cylinders, cones, tubes and discs against their oracle, and all ways to draw them
// against each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <rastrum/render.hpp>

#include "tests/support/every_way.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/surface_oracle.hpp"
#include "tests/support/surface_scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test {
namespace surfaces_test {

constexpr int kWidth = 40, kHeight = 27;

/// Surfaces closer than this in reversed depth, relative, may be in either order, because depth is
/// float32. Triangles, which oracle_test.cpp tests, are snapped and have a float32 plane.
constexpr Real kDepthTie = 3e-7L, kTriangleTie = 2e-3L;
/// A silhouette closer than this to a pixel's centre is a tie, px.
constexpr Real kEdgeTie = 1e-6L, kTriangleEdgeTie = 1;

Frame draw(Renderer& renderer, const SurfaceScene& s, FrameOptions frame,
           unsigned kinds = kCounted & ~kColor8) {
  frame.width = s.width;
  frame.height = s.height;
  frame.clip_planes = s.clip_planes;
  return test::draw(renderer, s.view(), s.camera, frame, kinds);
}

/// The things that a pixel may show: several in a tie.
class Truth {
 public:
  Truth(const SurfaceScene& s, int x, int y) : s_(s), x_(x), y_(y) {}

  [[nodiscard]] bool allows(std::int64_t id, float depth) {
    if (allows_at(s_.primitives, 0, 0, id, depth)) return true;
    is_tie_ = true;
    // Also allows what is visible beside the centre.
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (allows_at(s_.primitives, dx * kEdgeTie, dy * kEdgeTie, id, depth)) return true;
    // Near a triangle's edge the triangle may be missing.
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
      // At a silhouette depth changes quickly within the tie.
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
    auto& [checked, seen, ties] = counts[s.kind];
    for (const auto& [x, y] : pixels(s.width, s.height)) {
      Truth truth(s, x, y);
      EXPECT_TRUE(truth.allows(p.ids(x, y), p.depth(x, y)))
          << "scene " << seed << " (" << s.kind << "), pixel (" << x << ", " << y << "): id "
          << p.ids(x, y) << " at depth " << p.depth(x, y)
          << ", primitives and what the oracle has:" << truth.text();
      ++checked;
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
  constexpr Shader kShaders[] = {Shader::phong, Shader::material, Shader::normal,    Shader::id,
                                 Shader::flat,  Shader::lambert,  Shader::wireframe, Shader::depth};
  return FrameOptions{.shader = kShaders[seed % 8],
                      .cull = seed % 11 == 3 ? Cull::back : Cull::none,
                      .opacity = seed % 3 == 1 ? 0.4F : 1,
                      .samples = seed % 5 == 2 ? 4 : 1};
}

/// Compares counters and the images of the surface at a pixel.
TEST(Surfaces, AreTheSameBitsEverywhere) {
  EveryWay ways{{.threads = 1},
                {.threads = 3},
                {.memory_limit = 3 << 20, .threads = 2, .isa = available_isas().back()}};
  const int n = share_of(154, 55);
  for (int seed = 0; seed < n; ++seed) {
    // Several bins; below a limit also several bands.
    SurfaceScene s = generate_surfaces(static_cast<std::uint64_t>(seed), 150, 97);
    if (seed % 4 == 1) add_clip_planes(s, static_cast<std::uint64_t>(seed));
    for (const unsigned kinds : {kCounted & ~kColor8, +kSurfaces}) {
      SCOPED_TRACE(testing::Message() << "scene " << seed << " (" << s.kind << "), " << kinds);
      ways.same([&](Renderer& renderer) { return draw(renderer, s, frame_of(seed), kinds); },
                [&](const Frame& got, const Frame& expected) {
                  if ((kinds & kOverdraw) != 0) kCountsToo(got, expected);
                });
    }
  }
}

/// A shader's normals point outward on both sides, under any affine matrix.
TEST(Surfaces, HaveTheNormalsOfTheOracle) {
  Renderer renderer({.threads = 1});
  int checked = 0, seams = 0;
  for (int seed = 0; seed < 220; ++seed) {
    const SurfaceScene s = generate_surfaces(static_cast<std::uint64_t>(seed), kWidth, kHeight);
    FrameOptions frame{.shader = Shader::normal};
    const Frame p = draw(renderer, s, frame);
    for (const auto& [x, y] : pixels(s.width, s.height)) {
      if (p.ids(x, y) < 0) continue;
      const auto hits = surfaces_at(s.eye, s.primitives, x + 0.5L, y + 0.5L);
      if (hits.empty() || hits.front().id != p.ids(x, y)) continue;
      const Point3 n = hits.front().normal;
      if (!(length(n) > 0)) continue;  // a triangle's
      ++checked;
      const Point3 d = n * (1 / length(n)) - (widen(p.color(x, y)) * 2 - Point3{1, 1, 1});
      const Real off = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
      // Where a side meets an end, rounding decides the normal; an apex has none.
      seams += off > 1e-4L;
    }
  }
  EXPECT_GT(checked, 50000);
  EXPECT_LE(seams, checked / 20000);
}

/// Covered samples of D3D11's pattern of 4 (in sixteenths), and a pixel's coverage by 64 samples.
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

/// The colour at the centre of a picture of one sphere, whose corners are empty.
Vec4 middle(const OneInstance& sphere, FrameOptions frame = {}) {
  frame.width = frame.height = 15;
  frame.shader = Shader::flat;
  const Frame f = test::draw(RendererOptions{}, sphere.view(),
                             {.eye = {0, 0, 0}, .target = {0, 0, -1}}, frame, kColor);
  EXPECT_EQ(f.color(0, 0).w, 0);
  return f.color(7, 7);
}

/// A closed surface has two layers: front over back.
TEST(Surfaces, AreBlendedFrontOverBack) {
  const Vec3 centre{0, 0, -4};
  const OneInstance sphere(SpheresView{.centers = std::span(&centre, 1)});
  EXPECT_EQ(middle(sphere, {.opacity = 0.5F}).w, 0.75F);
  EXPECT_EQ(middle(sphere, {.cull = Cull::back, .opacity = 0.5F}).w, 0.5F);
}

/// An instance's look works as on a mesh.
TEST(Surfaces, HaveTheirInstancesLook) {
  const Vec3 centre{0, 0, -4};
  const Vec4 green{0, 1, 0, 1};
  OneInstance instance(
      SpheresView{.centers = std::span(&centre, 1), .colors = std::span(&green, 1)});
  EXPECT_EQ(middle(instance).y, 1);
  instance.color = Vec4{1, 0, 0.5F, 1};
  EXPECT_EQ(middle(instance), (Vec4{1, 0, 0.5F, 1}));
  instance.opacity = 0.5F;
  EXPECT_EQ(middle(instance).w, 0.75F);
  instance.visible = false;
  EXPECT_EQ(middle(instance).w, 0);
}

TEST(Surfaces, AreSeenByACameraThatFits) {
  const Vec3 centres[] = {{10, 2, -3}, {11, 2, -3}};
  const float radii[] = {2, 0.5F};
  const OneInstance spheres(SpheresView{.centers = centres, .radii = radii});
  const Bounds b = bounds(spheres.view());
  EXPECT_NEAR(b.min.x, 8, 1e-6);
  EXPECT_NEAR(b.max.x, 12, 1e-6);
  EXPECT_NEAR(b.max.z, -1, 1e-6);
  const Frame f = test::draw(RendererOptions{}, spheres.view(),
                             fit_camera(spheres.view(), 0.8F, false), {.width = 64, .height = 64});
  EXPECT_GT(f.stats.pixels_covered, 1000U);
  for (int i = 0; i < 64; ++i)
    for (const auto id : {f.ids(i, 0), f.ids(i, 63), f.ids(0, i), f.ids(63, i)}) EXPECT_LT(id, 0);
}

}  // namespace surfaces_test
}  // namespace rastrum::test
