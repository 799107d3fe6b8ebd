// SPDX-License-Identifier: BSD-3-Clause
// The clipper against a rasterizer in homogeneous coordinates, which never clips (Olano and Greer,
// "Triangle scan conversion using 2D homogeneous coordinates", 1997), in long double.
#include <rastrum/raster/rules/clip.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include <rastrum/device.hpp>
#include <rastrum/raster/draws/vertices.hpp>
#include <rastrum/raster/kernels/kernels.hpp>

#include "tests/support/pieces.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::clip_test {
namespace {

using Real = long double;

constexpr int kWidth = 48, kHeight = 40;

// A line a x + b y + c in px; ≥ 0 is inside.
struct Line {
  Real a = 0, b = 0, c = 0;
  // Signed distance in px. A line at infinity has every sample on one side.
  [[nodiscard]] Real distance(Real x, Real y) const {
    const Real n = std::hypot(a, b), e = a * x + b * y + c;
    return n > 0 ? e / n : std::copysign(std::numeric_limits<Real>::infinity(), e);
  }
};

// The triangle's part in front of the near plane, as four half planes of the screen.
struct ExactTriangle {
  std::array<Line, 4> lines;
  Line z, w;  // z and w of the triangle, up to a common factor
  bool edge_on = false;

  ExactTriangle(const ProjectedTriangle& t, int width, int height) {
    const Real hw = Real(width) / 2, hh = Real(height) / 2;
    Real x[3], y[3], cw[3];
    for (int i = 0; i < 3; ++i) {
      cw[i] = t.clip[i].w;
      x[i] = (t.clip[i].x + cw[i]) * hw;
      y[i] = (cw[i] - t.clip[i].y) * hh;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      lines[i] = {y[j] * cw[k] - cw[j] * y[k], cw[j] * x[k] - x[j] * cw[k],
                  x[j] * y[k] - y[j] * x[k]};
    }
    const Real det = x[0] * lines[0].a + y[0] * lines[0].b + cw[0] * lines[0].c;
    edge_on = det == 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Line& l = lines[i];
      z = {z.a + l.a * t.clip[i].z, z.b + l.b * t.clip[i].z, z.c + l.c * t.clip[i].z};
      w = {w.a + l.a * t.clip[i].w, w.b + l.b * t.clip[i].w, w.c + l.c * t.clip[i].w};
    }
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
  [[nodiscard]] Real z_over_w(int px, int py) const {
    const Real x = px + Real(0.5), y = py + Real(0.5);
    return (z.a * x + z.b * y + z.c) / (w.a * x + w.b * y + w.c);
  }
  // How far inside of all half planes the sample is, in px; negative outside.
  [[nodiscard]] Real depth(int px, int py) const {
    Real d = std::numeric_limits<Real>::infinity();
    for (const Line& l : lines) d = std::min(d, l.distance(px + Real(0.5), py + Real(0.5)));
    return d;
  }
};

// How far snapping may move a corner. The clipper's corners come from float64, the triangle's own
// from float32 px with four roundings of 2⁻²⁴.
Real tolerance(const ProjectedTriangle& t) {
  Real largest = 0;
  for (std::size_t i = 0; i < 3; ++i)
    if (t.has_position[i])
      for (const std::int64_t v : {t.snapped.v[i].x_fx8, t.snapped.v[i].y_fx8})
        largest = std::max(largest, std::abs(Real(v)) / 256);
  return (1.0L / 512 + largest * 0x1p-22L) * std::sqrt(2.0L) + 1e-9L;
}

using Polygon = raster::ClippedPolygon;
enum class Size { moderate, any };

// Calls f(triangle, polygon) for at least `count` triangles of generated scenes that need the
// clipper. Comparisons with the exact rasterizer need moderate coordinates: near FLT_MAX no
// precision can tell a sample's side of an edge.
template <class F>
void for_each_clipped(int count, Size size, F&& f) {
  constexpr int width = kWidth, height = kHeight;
  int seen = 0;
  for (std::uint64_t seed = 0; seen < count; ++seed) {
    const GeneratedScene g = generate(seed, width, height);
    if (g.kind == "extreme" && size == Size::moderate) continue;
    for (const ProjectedTriangle& t : project(g.view(), g.camera, width, height)) {
      if (t.fate != Fate::needs_clip) continue;
      ++seen;
      SCOPED_TRACE(testing::Message() << "seed " << seed << " id " << t.id);
      f(t, clip(t, width, height));
    }
  }
}

TEST(Clip, CoversWhatAnExactHomogeneousRasterizerCovers) {
  int inside = 0, polygons = 0;
  for_each_clipped(
      share_of(8000, 200), Size::moderate, [&](const ProjectedTriangle& t, const Polygon& polygon) {
        const ExactTriangle exact(t, kWidth, kHeight);
        if (exact.edge_on) return;
        const raster::Vec4d corners[3] = {{t.clip[0].x, t.clip[0].y, t.clip[0].z, t.clip[0].w},
                                          {t.clip[1].x, t.clip[1].y, t.clip[1].z, t.clip[1].w},
                                          {t.clip[2].x, t.clip[2].y, t.clip[2].z, t.clip[2].w}};
        const bool front = raster::orientation(corners) > 0;
        const std::vector<SnappedTriangle> pieces = fan_of(polygon, front, t.id);
        polygons += polygon.size > 0;
        const Real unsure = tolerance(t);
        const OracleImage image = brute_force(kWidth, kHeight, pieces);
        for (int y = 0; y < kHeight; ++y) {
          for (int x = 0; x < kWidth; ++x) {
            const Real depth = exact.depth(x, y);
            const std::uint32_t n = image.overdraw[static_cast<std::size_t>(y * kWidth + x)];
            if (depth > unsure) {
              ++inside;
              EXPECT_EQ(n, 1U) << x << "," << y << " lies " << double(depth) << " px inside";
            } else if (depth < -unsure) {
              EXPECT_EQ(n, 0U) << x << "," << y << " lies " << double(-depth) << " px outside";
            }
          }
        }
      });
  // The comparison was not empty.
  EXPECT_GT(polygons, share_of(2000));
  EXPECT_GT(inside, share_of(400000));
}

// No sample is covered twice, not even on the fan's inner edges or where snapping bends the
// polygon.
TEST(Clip, PiecesDoNotOverlap) {
  for_each_clipped(
      share_of(20000, 200), Size::moderate,
      [&](const ProjectedTriangle& t, const Polygon& polygon) {
        for (const bool front : {false, true}) {
          const OracleImage image = brute_force(kWidth, kHeight, fan_of(polygon, front, t.id));
          EXPECT_LE(*std::max_element(image.overdraw.begin(), image.overdraw.end()), 1U);
        }
      });
}

TEST(Clip, KeepsThePositionsOfCornersThatNeedNoCut) {
  for_each_clipped(share_of(20000, 200), Size::moderate,
                   [&](const ProjectedTriangle& t, const Polygon& polygon) {
                     for (int i = 0; i < 3; ++i) {
                       if (!t.has_position[i]) continue;
                       const SnappedVertex& v = t.snapped.v[i];
                       bool found = false;
                       for (int k = 0; k < polygon.size; ++k)
                         found = found || (polygon.vertices[k].x_fx8 == v.x_fx8 &&
                                           polygon.vertices[k].y_fx8 == v.y_fx8 &&
                                           polygon.vertices[k].depth == v.depth);
                       // A polygon without area may be dropped.
                       EXPECT_TRUE(found || polygon.size == 0) << "corner " << i;
                     }
                   });
}

// New vertices depend only on their edge: every order of a triangle's corners gives the same set.
TEST(Clip, NewVerticesDoNotDependOnTheOrderOfCorners) {
  for_each_clipped(
      share_of(20000, 200), Size::any, [&](const ProjectedTriangle& t, const Polygon& polygon) {
        const auto sorted = [](const Polygon& p) {
          std::vector<std::array<std::int32_t, 2>> v;
          for (int i = 0; i < p.size; ++i) v.push_back({p.vertices[i].x_fx8, p.vertices[i].y_fx8});
          std::sort(v.begin(), v.end());
          return v;
        };
        const auto reference = sorted(polygon);
        std::array<int, 3> order{0, 1, 2};
        while (std::next_permutation(order.begin(), order.end())) {
          ProjectedTriangle turned = t;
          for (int i = 0; i < 3; ++i) {
            turned.clip[i] = t.clip[order[static_cast<std::size_t>(i)]];
            turned.has_position[i] = t.has_position[order[static_cast<std::size_t>(i)]];
            turned.snapped.v[i] = t.snapped.v[order[static_cast<std::size_t>(i)]];
          }
          EXPECT_EQ(sorted(clip(turned, kWidth, kHeight)), reference);
        }
      });
}

TEST(Clip, StaysInsideTheGuardBandUpToTheLargestCoordinates) {
  int polygons = 0;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    const GeneratedScene g = generate(seed, kWidth, kHeight);
    for (const ProjectedTriangle& t : project(g.view(), g.camera, kWidth, kHeight)) {
      if (t.fate != Fate::needs_clip) continue;
      const Polygon p = clip(t, kWidth, kHeight);
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

// Rounding can bend such polygons until a plane crosses them four times.
TEST(Clip, NeverHasMoreCornersThanItsPolygonHolds) {
  constexpr double kKnown[][3][4] = {
      {{0x1.495a12p+4, -0x1.0b6f92p+65, 0, -0x1.e6da3cp+8},
       {-0x1.5b3b28p+14, -0x1.8ed2aep+12, -0x1.f2afbcp+34, 0x1.40c054p+51},
       {0x1.9f7a14p+74, 0x1.91efc6p+122, -0x1.18b2e6p+96, -0x1.4b0a9ep+89}},
      {{-0x1.fcbcd4p+48, -0x1.492818p+37, 0x1.3eacf6p+78, 0x1.fcd508p+97},
       {0x1.78b596p+74, 0x1.67a0cep+98, -0x1.1afc36p+114, -0x1.1c52acp+90},
       {0x1.aa4c16p+8, 0x1.925402p-4, 0x1.e84826p+35, 0}},
      {{0, -0x1.e95e9ep+38, 0x1.106a64p-10, -0x1.9d0a78p+35},
       {0x1.0f5ef6p+51, -0x1.6f7c1ep+1, -0x1.e1d8ep+119, -0x1.a5a238p+102},
       {0x1.b85e62p+35, 0x1.4e3af2p+40, -0x1.e1f1acp+119, 0x1.22ce5cp+55}},
  };
  const auto expect_sane = [](const ProjectedTriangle& t) {
    const Polygon p = clip(t, kWidth, kHeight);
    ASSERT_TRUE(p.size == 0 || (p.size >= 3 && p.size <= raster::kMaxPolygon)) << p.size;
  };
  const auto triangle = [](const double(&v)[3][4]) {
    ProjectedTriangle t;
    for (std::size_t i = 0; i < 3; ++i) {
      t.clip[i] = {v[i][0], v[i][1], v[i][2], v[i][3]};
      t.has_position[i] = snap(t.clip[i], kWidth, kHeight, t.snapped.v[i]);
    }
    return t;
  };
  for (const auto& known : kKnown) expect_sane(triangle(known));
  Random r(1);
  const int count = share_of(1000000);
  for (int i = 0; i < count && !HasFatalFailure(); ++i) {
    double v[3][4];
    for (auto& corner : v) {
      for (double& c : corner) {
        const auto magnitude = static_cast<float>(std::exp2(r.real(-10, 124)));
        c = r.chance(0.1) ? 0 : r.chance(0.5) ? magnitude : -magnitude;
      }
    }
    expect_sane(triangle(v));
  }
}

// Depth is z / w, which is linear on the screen. The pieces' planes follow the triangle's, up to
// its slope times the snapping of a corner, and the float32 rounding of the piece's plane.
TEST(Clip, DepthFollowsTheTriangle) {
  int checked = 0;
  for_each_clipped(5000, Size::moderate, [&](const ProjectedTriangle& t, const Polygon& polygon) {
    const ExactTriangle exact(t, kWidth, kHeight);
    if (exact.edge_on) return;
    const Real unsure = tolerance(t);
    std::vector<SnappedTriangle> pieces = fan_of(polygon, true, t.id);
    for (const SnappedTriangle& p : fan_of(polygon, false, t.id)) pieces.push_back(p);
    for (const SnappedTriangle& p : pieces) {
      for (int y = 0; y < kHeight; y += 3) {
        for (int x = 0; x < kWidth; x += 3) {
          if (exact.depth(x, y) <= unsure || !covers(p, x, y)) continue;
          const Real here = exact.z_over_w(x, y);
          const Real slope =
              std::abs(exact.z_over_w(x + 1, y) - here) + std::abs(exact.z_over_w(x, y + 1) - here);
          const SnappedVertex& origin = p.v[0];
          const Real reach =
              std::abs(Real(origin.x_fx8) / 256 - x) + std::abs(Real(origin.y_fx8) / 256 - y);
          const Real roundings = (std::abs(Real(origin.depth)) + reach * slope) * 0x1p-22L;
          EXPECT_NEAR(double(depth_at(p, x, y)), double(std::clamp<Real>(here, 0, 1)),
                      double(slope * unsure + roundings))
              << x << "," << y;
          ++checked;
        }
      }
    }
  });
  EXPECT_GT(checked, 10000);
}

// Setup drops triangles outside of one plane without the clipper. The clipper must keep nothing of
// these, for coordinates of all sizes, and setup must drop most of them.
TEST(Clip, WhatSetupLeavesOutTheClipperDoesToo) {
  using raster::kNeedsClip;
  constexpr std::uint32_t kTriangles = raster::kSetupBatch;
  constexpr raster::Viewport kViewport{960, 540};
  Random random(11);
  std::uint64_t left_out = 0, outside = 0, kept = 0;
  for (int batch = 0; batch < share_of(3000, 30); ++batch) {
    // The guard band's planes are about 50 times as far as the picture's edge.
    const double reach =
        batch % 2 == 0 ? 40 : 2;  // of exponents: from all sizes to those of scenes
    Mat4d matrix = Mat4d::identity();
    for (auto& row : matrix.m)
      for (double& v : row) v = random.real(-1, 1) * std::exp2(random.real(-reach, reach));
    const Mat4 matrix32(matrix);
    std::vector<Vec3> positions;
    for (std::uint32_t t = 0; t < kTriangles; ++t) {
      const double size = std::exp2(random.real(-reach, reach));
      const Vec3d centre{random.real(-4, 4), random.real(-4, 4), random.real(-4, 4)};
      for (int c = 0; c < 3; ++c) {
        const double own = batch % 3 == 0 ? std::exp2(random.real(-reach, reach)) : 1;
        positions.push_back({static_cast<float>((centre.x + random.real(-1, 1)) * size * own),
                             static_cast<float>((centre.y + random.real(-1, 1)) * size * own),
                             static_cast<float>((centre.z + random.real(-1, 1)) * size * own)});
      }
    }
    for (const Isa isa : available_isas()) {
      std::vector<raster::ProjectedVertex> projected(positions.size());
      const raster::Kernels& kernel = raster::kernels(isa);
      kernel.project(positions.data(), positions.size(), matrix32, kViewport, projected.data());
      raster::SetupInput input;
      input.vertices = projected.data();
      input.vertex_count = projected.size();
      input.count = kTriangles;
      input.view = {0, 0, 1920, 1080};
      input.bin_columns = 30;
      std::vector<raster::Piece> pieces(kTriangles);
      std::vector<raster::BinFragment> fragments(raster::kSetupFragments);
      std::vector<std::uint32_t> slow(kTriangles);
      const raster::SetupOutput out =
          kernel.setup(input, pieces.data(), fragments.data(), slow.data());
      const std::set<std::uint32_t> asked(slow.begin(), slow.begin() + out.slow);
      for (std::uint32_t t = 0; t < kTriangles; ++t) {
        raster::ProjectedVertex v[3];
        raster::Vec4d corner[3];
        bool needs_clip = false, finite = true;
        for (std::uint32_t c = 0; c < 3; ++c) {
          v[c] = projected[3 * t + c];
          corner[c] = raster::clip_position_of(positions[3 * t + c], matrix32, matrix);
          needs_clip |= v[c].x_fx8 == kNeedsClip;
          finite &= std::isfinite(corner[c].x) && std::isfinite(corner[c].y) &&
                    std::isfinite(corner[c].z) && std::isfinite(corner[c].w);
        }
        if (!needs_clip) continue;
        if (asked.count(t) != 0) {
          if (isa != Isa::scalar && finite && reach == 2) {
            const bool nothing = raster::clip_triangle(corner, v, kViewport).size < 3;
            (nothing ? outside : kept) += 1;
          }
          continue;
        }
        ASSERT_TRUE(finite) << name(isa);
        ASSERT_LT(raster::clip_triangle(corner, v, kViewport).size, 3) << name(isa);
        if (reach == 2) ++left_out;
      }
    }
  }
  if (available_isas().size() == 1)
    GTEST_SKIP() << "there is plain C++ alone, which leaves out none";
  EXPECT_GT(kept, 1000U);
  EXPECT_GT(left_out, 10 * outside);
}

}  // namespace
}  // namespace rastrum::test::clip_test
