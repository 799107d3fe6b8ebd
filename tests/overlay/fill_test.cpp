// SPDX-License-Identifier: BSD-3-Clause
// Fills: coverage against the exact area of simple polygons, and against brute force if polygons
// overlap; shapes outside of the picture; blending.
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/digest.hpp>
#include <rastrum/overlay.hpp>

#include "tests/support/golden.hpp"
#include "tests/support/pixels.hpp"

namespace rastrum::fill_test {
namespace {

struct P {
  double x, y;
};

/// The part of `polygon` on one side of x (or y) = at; `keep_greater` says which side.
std::vector<P> clipped(const std::vector<P>& polygon, bool along_x, double at, bool keep_greater) {
  std::vector<P> kept;
  const auto side = [&](P p) { return ((along_x ? p.x : p.y) - at) * (keep_greater ? 1 : -1); };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const P a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double sa = side(a), sb = side(b);
    if (sa >= 0) kept.push_back(a);
    if ((sa < 0) != (sb < 0)) {
      const double t = sa / (sa - sb);
      kept.push_back({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)});
    }
  }
  return kept;
}

double area(const std::vector<P>& polygon) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const P a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    sum += a.x * b.y - a.y * b.x;
  }
  return std::fabs(sum) / 2;
}

double area_in_pixel(const std::vector<P>& polygon, int x, int y) {
  auto part = clipped(polygon, true, x, true);
  part = clipped(part, true, x + 1, false);
  part = clipped(part, false, y, true);
  return area(clipped(part, false, y + 1, false));
}

int winding(const std::vector<std::vector<P>>& polygons, double x, double y) {
  int around = 0;
  for (const auto& polygon : polygons)
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const P a = polygon[i], b = polygon[(i + 1) % polygon.size()];
      if ((a.y <= y) == (b.y <= y)) continue;
      const double at = a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
      if (at > x) around += a.y <= y ? 1 : -1;
    }
  return around;
}

overlay::Path path_of(const std::vector<std::vector<P>>& polygons) {
  overlay::Path path;
  for (const auto& polygon : polygons)
    for (std::size_t i = 0; i < polygon.size(); ++i)
      if (i == 0)
        path.move_to(polygon[i].x, polygon[i].y);
      else
        path.line_to(polygon[i].x, polygon[i].y);
  return path;
}

/// Points on the grid of paths, so that rounding causes no difference.
P random_point(std::mt19937& random, int low, int high) {
  std::uniform_int_distribution<int> at(low * 256, high * 256);
  const double x = at(random) / 256.0;
  return {x, at(random) / 256.0};
}

TEST(Fill, CoversTheAreaOfTriangles) {
  std::mt19937 random(7);
  for (int i = 0; i < 200; ++i) {
    const std::vector<P> triangle{random_point(random, -6, 30), random_point(random, -6, 30),
                                  random_point(random, -6, 30)};
    Image<std::uint8_t> coverage(24, 20);
    overlay::fill(coverage.view(), path_of({triangle}));
    ASSERT_TRUE(test::pixels_are_near(
        coverage, 2.6, [&](int x, int y) { return 255 * area_in_pixel(triangle, x, y); }))
        << "triangle " << i;
  }
}

TEST(Fill, RectanglesAreExact) {
  overlay::Path path;
  path.add_rectangle(1.25, 2.5, 4.75, 3.25);
  Image<std::uint8_t> coverage(6, 5);
  overlay::fill(coverage.view(), path);
  EXPECT_EQ(coverage(0, 2), 0);
  EXPECT_EQ(coverage(1, 2), 96);   // 3/4 · 1/2 of 255
  EXPECT_EQ(coverage(2, 2), 128);  // 127.5
  EXPECT_EQ(coverage(4, 3), 48);   // 3/4 · 1/4
  EXPECT_EQ(coverage(5, 3), 0);
}

TEST(Fill, WhatOverlapsCountsOnceAndHolesStay) {
  // A frame with a hole of opposite winding, and a bar twice over both.
  const std::vector<std::vector<P>> polygons{{{1, 1}, {19, 2}, {18, 17}, {2, 18}},
                                             {{5, 5}, {6, 14}, {14, 13}, {15, 6}},
                                             {{0, 8}, {20, 10}, {20, 12.5}, {0, 9}},
                                             {{0, 8}, {20, 10}, {20, 12.5}, {0, 9}}};
  Image<std::uint8_t> coverage(20, 20);
  overlay::fill(coverage.view(), path_of(polygons));
  constexpr int kSamples = 101;
  int hole = 0;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) {
      int inside = 0;
      for (int j = 0; j < kSamples; ++j)
        for (int i = 0; i < kSamples; ++i)
          inside += winding(polygons, x + (i + 0.5) / kSamples, y + (j + 0.5) / kSamples) != 0;
      ASSERT_NEAR(coverage(x, y), 255.0 * inside / (kSamples * kSamples), 5) << x << ", " << y;
      hole += x > 6 && x < 13 && y > 6 && y < 13 && coverage(x, y) == 0;
    }
  EXPECT_GT(hole, 10);
}

TEST(Fill, APictureIsAPartOfALargerOne) {
  std::mt19937 random(3);
  std::vector<std::vector<P>> polygons, moved;
  for (int i = 0; i < 8; ++i) {
    polygons.push_back({random_point(random, -20, 60), random_point(random, -20, 60),
                        random_point(random, -20, 60)});
    moved.push_back(polygons.back());
    for (P& p : moved.back()) p = {p.x + 32, p.y + 32};
  }
  Image<std::uint8_t> small(30, 30), large(100, 100);
  overlay::fill(small.view(), path_of(polygons));
  overlay::fill(large.view(), path_of(moved));
  EXPECT_TRUE(test::pixels_are(small, [&](int x, int y) { return large(x + 32, y + 32); }));
}

TEST(Fill, BlendsStraightAndPremultiplied) {
  Image<Rgba8> color8(2, 1);
  Image<Vec4> color(2, 1);
  color8(1, 0) = {200, 100, 0, 255};
  color(1, 0) = {200 / 255.0F, 100 / 255.0F, 0, 1};
  overlay::Path path;
  path.add_rectangle(0, 0, 2, 1);
  overlay::fill({color8.view(), color.view()}, path, {0, 0, 255, 51});
  // Over nothing the colour stays as it is, not premultiplied.
  EXPECT_EQ(color8(0, 0), (Rgba8{0, 0, 255, 51}));
  EXPECT_EQ(color8(1, 0), (Rgba8{160, 80, 51, 255}));
  EXPECT_NEAR(color(0, 0).z, 0.2, 1e-6);
  EXPECT_NEAR(color(0, 0).w, 0.2, 1e-6);
  EXPECT_NEAR(color(1, 0).x, 160 / 255.0, 1e-6);
  EXPECT_NEAR(color(1, 0).w, 1, 1e-6);
}

TEST(Fill, TouchesOnlyWhatTheTestAllows) {
  Image<Rgba8> color8(4, 4);
  overlay::Path path;
  path.add_rectangle(0, 0, 4, 4);
  overlay::fill({.color8 = color8.view()}, path, {255, 255, 255, 255},
                [](int x, int y) { return x == y; });
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) EXPECT_EQ(color8(x, y).a, x == y ? 255 : 0);
}

TEST(Fill, RefusesWhatIsNoPlaceAndViewsThatDiffer) {
  overlay::Path path;
  EXPECT_THROW(path.move_to(std::nan(""), 0), Error);
  EXPECT_THROW(path.line_to(0, 1e9), Error);
  path.add_rectangle(0, 0, 1, 1);
  Image<Rgba8> color8(4, 4);
  Image<Vec4> color(4, 5);
  EXPECT_THROW(overlay::fill({color8.view(), color.view()}, path, {}), Error);
}

TEST(Fill, StrokesAndDiscsAreTheSameBits) {
  overlay::Path path;
  for (int i = 0; i < 24; ++i)
    path.add_line(50 + i, 50, 50 + 45 * std::sqrt(i / 24.0), 5 + 90 * (i / 24.0), 0.5 + i / 8.0);
  path.add_disc(70.3, 40.7, 17.2);
  Image<Rgba8> picture(100, 100);
  overlay::fill({.color8 = picture.view()}, path, {255, 200, 20, 230});
  EXPECT_TRUE(test::matches_golden("overlay/strokes", digest(picture)));
}

}  // namespace
}  // namespace rastrum::fill_test
