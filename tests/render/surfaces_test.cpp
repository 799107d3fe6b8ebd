// Spheres, cylinders, cones, tubes and discs against their oracle, and every way to draw them
// against the others.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/render.hpp>

#include "tests/support/random.hpp"
#include "tests/support/surface_oracle.hpp"
#include "tests/support/surface_scenes.hpp"

namespace rastrum::test {
namespace surfaces_test {

constexpr int kWidth = 40, kHeight = 27;

/// Two surfaces that lie closer than this, in reversed depth and relative to it, may come in either
/// order: depth is a float32. Triangles have one of a plane in float32, and snapped corners.
constexpr Real kDepthTie = 3e-7L, kTriangleTie = 2e-3L;
/// A silhouette that passes a pixel's centre closer than this, px.
constexpr Real kEdgeTie = 1e-6L, kTriangleEdgeTie = 0.02L;

struct Picture {
  Image<std::int64_t> ids;
  Image<float> depth;
  Image<Vec4> color;
  Image<std::uint32_t> overdraw;
  FrameStats stats;

  Picture(int width, int height)
      : ids(width, height), depth(width, height), color(width, height), overdraw(width, height) {}
};

Picture draw(Renderer& renderer, const SurfaceScene& s, FrameOptions frame) {
  frame.width = s.width;
  frame.height = s.height;
  Picture p(s.width, s.height);
  Targets targets;
  targets.ids = p.ids;
  targets.depth = p.depth;
  targets.color = p.color;
  targets.overdraw = p.overdraw;
  p.stats = renderer.render(s.view(), s.camera, frame, targets);
  return p;
}

/// The first pixel that differs in a bit.
testing::AssertionResult same(const Picture& a, const Picture& b) {
  for (int y = 0; y < a.ids.height(); ++y)
    for (int x = 0; x < a.ids.width(); ++x) {
      const auto fail = [&](const char* what) {
        return testing::AssertionFailure() << what << " at (" << x << ", " << y << "): id "
                                           << a.ids(x, y) << " and " << b.ids(x, y) << ", depth "
                                           << a.depth(x, y) << " and " << b.depth(x, y);
      };
      if (a.ids(x, y) != b.ids(x, y)) return fail("id");
      if (std::bit_cast<std::uint32_t>(a.depth(x, y)) !=
          std::bit_cast<std::uint32_t>(b.depth(x, y)))
        return fail("depth");
      if (a.overdraw(x, y) != b.overdraw(x, y)) return fail("overdraw");
      const Vec4 c = a.color(x, y), d = b.color(x, y);
      if (std::bit_cast<std::uint32_t>(c.x) != std::bit_cast<std::uint32_t>(d.x) ||
          std::bit_cast<std::uint32_t>(c.y) != std::bit_cast<std::uint32_t>(d.y) ||
          std::bit_cast<std::uint32_t>(c.z) != std::bit_cast<std::uint32_t>(d.z) ||
          std::bit_cast<std::uint32_t>(c.w) != std::bit_cast<std::uint32_t>(d.w))
        return fail("colour");
    }
  return testing::AssertionSuccess();
}

int scene_count(int daily) {
  const char* const full = std::getenv("RASTRUM_SURFACE_SCENES");
  return full != nullptr ? std::atoi(full) : daily;
}

/// What may be seen at a pixel: more than one thing in a tie.
class Truth {
 public:
  Truth(const SurfaceScene& s, int x, int y) : s_(s), x_(x), y_(y) {}

  [[nodiscard]] bool allows(std::int64_t id, float depth) {
    if (allows_at(0, 0, id, depth, 0)) return true;
    // In a tie of silhouettes: what is seen beside the centre.
    for (const Real away : {kEdgeTie, kTriangleEdgeTie}) {
      if (away == kTriangleEdgeTie && !touches_triangle()) break;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          if (allows_at(dx * away, dy * away, id, depth, away)) {
            is_tie_ = true;
            return true;
          }
    }
    return false;
  }
  [[nodiscard]] bool is_tie() const { return is_tie_; }
  [[nodiscard]] std::string text() const {
    std::string t;
    for (const SurfaceHit& h : surfaces_at(s_.eye, s_.primitives, x_ + 0.5L, y_ + 0.5L))
      t += " " + std::to_string(h.id) + (h.front ? "f" : "b") + "@" + std::to_string(h.depth);
    return t;
  }

 private:
  [[nodiscard]] bool is_triangle(std::int64_t id) const {
    return std::ranges::any_of(s_.primitives, [&](const SurfacePrimitive& p) {
      return p.id == id && p.kind == SurfaceKind::triangle;
    });
  }
  [[nodiscard]] bool touches_triangle() const {
    return std::ranges::any_of(s_.primitives, [](const SurfacePrimitive& p) {
      return p.kind == SurfaceKind::triangle;
    });
  }
  [[nodiscard]] bool allows_at(Real dx, Real dy, std::int64_t id, float depth, Real away) {
    const auto hits = surfaces_at(s_.eye, s_.primitives, x_ + 0.5L + dx, y_ + 0.5L + dy);
    if (hits.empty()) return id == -1;
    const auto cut = [](Real d) { return std::clamp<Real>(d, 0, 1); };
    const Real nearest = cut(hits.front().depth);
    for (const SurfaceHit& h : hits) {
      const bool loose = is_triangle(h.id) || is_triangle(hits.front().id);
      const Real tie = loose ? kTriangleTie : kDepthTie;
      if (cut(h.depth) < nearest - tie * std::max(nearest, loose ? Real(0.05) : Real(0))) break;
      if (h.id != id) continue;
      // At a silhouette depth runs away within the tie.
      const Real off = std::abs(cut(h.depth) - static_cast<Real>(depth));
      const Real slack = away > 0 ? Real(3e-3) : tie;
      if (off > slack * std::max(nearest, loose ? Real(0.05) : Real(0)) + Real(1e-12)) continue;
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
  const int n = scene_count(1100);
  for (int seed = 0; seed < n; ++seed) {
    SurfaceScene s = generate_surfaces(static_cast<std::uint64_t>(seed), kWidth, kHeight);
    FrameOptions frame;
    frame.cull = seed % 5 == 3 ? Cull::back : seed % 7 == 3 ? Cull::front : Cull::none;
    for (SurfacePrimitive& p : s.primitives) {
      p.culls_back = frame.cull == Cull::back;
      p.culls_front = frame.cull == Cull::front;
    }
    const Picture p = draw(reference, s, frame);
    ASSERT_EQ(p.stats.triangles.dropped, s.dropped) << "scene " << seed;
    auto& [pixels, seen, ties] = counts[s.kind];
    for (int y = 0; y < s.height; ++y)
      for (int x = 0; x < s.width; ++x) {
        Truth truth(s, x, y);
        ASSERT_TRUE(truth.allows(p.ids(x, y), p.depth(x, y)))
            << "scene " << seed << " (" << s.kind << "), pixel (" << x << ", " << y << "): id "
            << p.ids(x, y) << " at depth " << p.depth(x, y) << ", the oracle has" << truth.text();
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

std::vector<std::unique_ptr<Renderer>> all_renderers() {
  std::vector<std::unique_ptr<Renderer>> all;
  for (const Isa isa : available_isas())
    for (const int threads : {1, 3}) {
      RendererOptions o;
      o.device = Device::threads;
      o.threads = threads;
      o.isa = isa;
      all.push_back(std::make_unique<Renderer>(o));
    }
  RendererOptions limited;
  limited.threads = 2;
  limited.memory_limit = 3 << 20;
  all.push_back(std::make_unique<Renderer>(limited));
  return all;
}

FrameOptions frame_of(int seed) {
  constexpr Shader kShaders[] = {Shader::phong, Shader::material, Shader::normal, Shader::id,
                                 Shader::flat,  Shader::lambert,  Shader::wireframe};
  FrameOptions frame;
  frame.shader = kShaders[seed % 7];
  frame.opacity = seed % 3 == 1 ? 0.4F : 1;
  frame.samples = seed % 5 == 2 ? 4 : 1;
  frame.cull = seed % 11 == 3 ? Cull::back : Cull::none;
  return frame;
}

TEST(Surfaces, AreTheSameBitsEverywhere) {
  Renderer reference({.device = Device::serial});
  const auto renderers = all_renderers();
  const int n = scene_count(154);
  for (int seed = 0; seed < n; ++seed) {
    // Several bins and, below a limit, several bands.
    const SurfaceScene s = generate_surfaces(static_cast<std::uint64_t>(seed), 150, 97);
    const FrameOptions frame = frame_of(seed);
    const Picture expected = draw(reference, s, frame);
    for (const auto& renderer : renderers) {
      const Picture p = draw(*renderer, s, frame);
      ASSERT_TRUE(same(expected, p))
          << "scene " << seed << " (" << s.kind << "), " << name(renderer->options().isa.value_or(Isa::scalar))
          << ", " << renderer->options().threads << " threads, limit "
          << renderer->options().memory_limit;
      ASSERT_EQ(expected.stats.triangles.dropped, p.stats.triangles.dropped);
      ASSERT_EQ(expected.stats.triangles.culled, p.stats.triangles.culled);
      ASSERT_EQ(expected.stats.fragments, p.stats.fragments);
    }
  }
}

}  // namespace surfaces_test
}  // namespace rastrum::test
