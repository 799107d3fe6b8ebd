// The clipper by itself: against a rasterizer in homogeneous coordinates that never clips (Olano
// and Greer, "Triangle scan conversion using 2D homogeneous coordinates", 1997), in long double.
#include <rastrum/raster/clip.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/pieces.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test {
namespace {

using Real = long double;

// A line a x + b y + c in px; ≥ 0 is inside.
struct Line {
  Real a = 0, b = 0, c = 0;
  // Signed distance in px; a line at infinity has every sample on one side.
  [[nodiscard]] Real distance(Real x, Real y) const {
    const Real n = std::hypot(a, b), e = a * x + b * y + c;
    return n > 0 ? e / n : std::copysign(std::numeric_limits<Real>::infinity(), e);
  }
};

// The triangle's part in front of the near plane, as four half planes of the screen.
struct ExactTriangle {
  std::array<Line, 4> lines;
  bool edge_on = false;

  ExactTriangle(const ProjectedTriangle& t, int width, int height) {
    const Real hw = Real(width) / 2, hh = Real(height) / 2;
    Real x[3], y[3], w[3];
    for (int i = 0; i < 3; ++i) {
      w[i] = t.clip[i].w;
      x[i] = (t.clip[i].x + w[i]) * hw;
      y[i] = (w[i] - t.clip[i].y) * hh;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      lines[i] = {y[j] * w[k] - w[j] * y[k], w[j] * x[k] - x[j] * w[k], x[j] * y[k] - y[j] * x[k]};
    }
    const Real det = x[0] * lines[0].a + y[0] * lines[0].b + w[0] * lines[0].c;
    edge_on = det == 0;
    const Real sign = det < 0 ? -1 : 1;
    for (std::size_t i = 0; i < 3; ++i) {
      Line& l = lines[i];
      l = {l.a * sign, l.b * sign, l.c * sign};
      const Real in_front = Real(t.clip[i].w) - t.clip[i].z;
      lines[3].a += l.a * in_front;
      lines[3].b += l.b * in_front;
      lines[3].c += l.c * in_front;
    }
  }
  // How deep inside all of the half planes the sample lies, in px; negative outside.
  [[nodiscard]] Real depth(int px, int py) const {
    Real d = std::numeric_limits<Real>::infinity();
    for (const Line& l : lines) d = std::min(d, l.distance(px + Real(0.5), py + Real(0.5)));
    return d;
  }
};

// How far snapping may move a corner, and float32 before it: px has four roundings of 2⁻²⁴.
Real tolerance(const raster::ClippedPolygon& polygon) {
  Real largest = 0;
  for (int i = 0; i < polygon.size; ++i)
    for (const std::int32_t v : {polygon.vertices[i].x_fx8, polygon.vertices[i].y_fx8})
      largest = std::max(largest, std::abs(Real(v)) / 256);
  return (1.0L / 512 + largest * 0x1p-22L) * std::sqrt(2.0L) + 1e-9L;
}

// At least `count` triangles that need the clipper, from the generated scenes whose coordinates are
// moderate (near FLT_MAX no precision tells on which side of an edge a sample lies).
template <class F>
void for_each_clipped(int count, int width, int height, F&& f) {
  int seen = 0;
  for (std::uint64_t seed = 0; seen < count; ++seed) {
    const GeneratedScene g = generate(seed, width, height);
    if (g.kind == "extreme") continue;
    const SceneBinding binding(g.scene);
    for (const ProjectedTriangle& t : project(binding.view(), g.camera, width, height)) {
      if (t.fate != Fate::needs_clip) continue;
      ++seen;
      f(t, seed);
    }
  }
}

constexpr int kWidth = 48, kHeight = 40;

TEST(Clip, CoversWhatAnExactHomogeneousRasterizerCovers) {
  int inside = 0, polygons = 0;
  for_each_clipped(20000, kWidth, kHeight, [&](const ProjectedTriangle& t, std::uint64_t seed) {
    const ExactTriangle exact(t, kWidth, kHeight);
    if (exact.edge_on) return;
    const raster::ClippedPolygon polygon = clip(t, kWidth, kHeight);
    const raster::Vec4d corners[3] = {{t.clip[0].x, t.clip[0].y, t.clip[0].z, t.clip[0].w},
                                      {t.clip[1].x, t.clip[1].y, t.clip[1].z, t.clip[1].w},
                                      {t.clip[2].x, t.clip[2].y, t.clip[2].z, t.clip[2].w}};
    const bool front = raster::orientation(corners) > 0;
    const std::vector<SnappedTriangle> pieces = fan_of(polygon, front, t.id);
    polygons += polygon.size > 0;
    const Real unsure = tolerance(polygon);
    const OracleImage image = brute_force(kWidth, kHeight, pieces);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const Real depth = exact.depth(x, y);
        const std::uint32_t n = image.overdraw[static_cast<std::size_t>(y * kWidth + x)];
        if (depth > unsure) {
          ++inside;
          EXPECT_EQ(n, 1U) << "seed " << seed << " id " << t.id << " sample " << x << "," << y
                           << " lies " << double(depth) << " px inside";
        } else if (depth < -unsure) {
          EXPECT_EQ(n, 0U) << "seed " << seed << " id " << t.id << " sample " << x << "," << y
                           << " lies " << double(-depth) << " px outside";
        }
      }
    }
  });
  // The comparison saw something.
  EXPECT_GT(polygons, 5000);
  EXPECT_GT(inside, 1000000);
}

// No sample twice, not even on the inner edges of the fan or where snapping bends the polygon.
TEST(Clip, PiecesDoNotOverlap) {
  for_each_clipped(20000, kWidth, kHeight, [&](const ProjectedTriangle& t, std::uint64_t seed) {
    const raster::ClippedPolygon polygon = clip(t, kWidth, kHeight);
    for (const bool front : {false, true}) {
      const OracleImage image = brute_force(kWidth, kHeight, fan_of(polygon, front, t.id));
      EXPECT_LE(*std::max_element(image.overdraw.begin(), image.overdraw.end()), 1U)
          << "seed " << seed << " id " << t.id;
    }
  });
}

TEST(Clip, KeepsThePositionsOfCornersThatNeedNoCut) {
  for_each_clipped(20000, kWidth, kHeight, [&](const ProjectedTriangle& t, std::uint64_t seed) {
    const raster::ClippedPolygon polygon = clip(t, kWidth, kHeight);
    for (int i = 0; i < 3; ++i) {
      if (!t.has_position[i]) continue;
      const SnappedVertex& v = t.snapped.v[i];
      bool found = false;
      for (int k = 0; k < polygon.size; ++k)
        found =
            found || (polygon.vertices[k].x_fx8 == v.x_fx8 &&
                      polygon.vertices[k].y_fx8 == v.y_fx8 && polygon.vertices[k].depth == v.depth);
      // A polygon of no area may be dropped whole.
      EXPECT_TRUE(found || polygon.size == 0)
          << "seed " << seed << " id " << t.id << " corner " << i;
    }
  });
}

// New vertices depend on their edge alone: every way to submit a triangle gives the same set.
TEST(Clip, NewVerticesDoNotDependOnTheOrderOfCorners) {
  for_each_clipped(5000, kWidth, kHeight, [&](const ProjectedTriangle& t, std::uint64_t seed) {
    const auto sorted = [](const raster::ClippedPolygon& p) {
      std::vector<std::array<std::int32_t, 2>> v;
      for (int i = 0; i < p.size; ++i) v.push_back({p.vertices[i].x_fx8, p.vertices[i].y_fx8});
      std::sort(v.begin(), v.end());
      return v;
    };
    const auto reference = sorted(clip(t, kWidth, kHeight));
    std::array<int, 3> order{0, 1, 2};
    while (std::next_permutation(order.begin(), order.end())) {
      ProjectedTriangle turned = t;
      for (int i = 0; i < 3; ++i) {
        turned.clip[i] = t.clip[order[static_cast<std::size_t>(i)]];
        turned.has_position[i] = t.has_position[order[static_cast<std::size_t>(i)]];
        turned.snapped.v[i] = t.snapped.v[order[static_cast<std::size_t>(i)]];
      }
      EXPECT_EQ(sorted(clip(turned, kWidth, kHeight)), reference)
          << "seed " << seed << " id " << t.id;
    }
  });
}

TEST(Clip, StaysInsideTheGuardBandUpToTheLargestCoordinates) {
  int polygons = 0;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    const GeneratedScene g = generate(seed, kWidth, kHeight);
    const SceneBinding binding(g.scene);
    for (const ProjectedTriangle& t : project(binding.view(), g.camera, kWidth, kHeight)) {
      if (t.fate != Fate::needs_clip) continue;
      const raster::ClippedPolygon p = clip(t, kWidth, kHeight);
      ASSERT_TRUE(p.size == 0 || (p.size >= 3 && p.size <= raster::kMaxPolygon));
      polygons += p.size > 0 && g.kind == "extreme";
      for (int i = 0; i < p.size; ++i) {
        const raster::ProjectedVertex& v = p.vertices[i];
        EXPECT_GE(std::min(v.x_fx8, v.y_fx8), -(1 << 23));
        EXPECT_LE(std::max(v.x_fx8, v.y_fx8), 1 << 24);
        EXPECT_TRUE(std::isfinite(v.depth)) << "seed " << seed << " id " << t.id;
      }
    }
  }
  EXPECT_GT(polygons, 100);
}

// The depth of a new vertex is that of the plane through the original three.
TEST(Clip, DepthOfNewVertices) {
  int checked = 0;
  for_each_clipped(20000, kWidth, kHeight, [&](const ProjectedTriangle& t, std::uint64_t seed) {
    const raster::ClippedPolygon polygon = clip(t, kWidth, kHeight);
    for (int i = 0; i < polygon.size; ++i) {
      // Where all corners have depths in [0, 1] the new ones lie between them, the near plane's
      // at 1.
      EXPECT_LE(polygon.vertices[i].depth, 1.0F) << "seed " << seed << " id " << t.id;
      ++checked;
    }
  });
  EXPECT_GT(checked, 10000);
}

}  // namespace
}  // namespace rastrum::test
