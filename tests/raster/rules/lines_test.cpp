// SPDX-License-Identifier: BSD-3-Clause
// Points and lines: the library's exact coverage against the brute-force oracle, the rules of the
// public conformance suites (dEQP and piglit), and the clipper of lines.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/raster/rules/clip.hpp>
#include <rastrum/raster/rules/points_and_lines.hpp>

#include "tests/support/oracle.hpp"
#include "tests/support/random.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::lines_test {
namespace {

using raster::Piece;
using raster::ProjectedVertex;
using raster::Rect;
using raster::SetupResult;

using Pixels = std::set<std::pair<int, int>>;

constexpr int kSide = 40;
constexpr Rect kView{0, 0, kSide, kSide};

ProjectedVertex vertex(std::int64_t x_fx8, std::int64_t y_fx8, float depth = 0.5F) {
  return {static_cast<std::int32_t>(x_fx8), static_cast<std::int32_t>(y_fx8), depth, 1};
}

/// By row_span. Expects the same from cover_8x8 and cover_blocks, and that the bounds contain it.
Pixels pixels_of(const Piece& piece, Rect view) {
  Pixels rows, blocks, walked;
  const Rect box = raster::piece_bounds(piece, view);
  for (int y = view.y0; y < view.y1; ++y) {
    const raster::Span span = raster::row_span(piece, y, view.x0, view.x1);
    for (int x = span.begin; x < span.end; ++x) {
      rows.emplace(x, y);
      EXPECT_TRUE(x >= box.x0 && x < box.x1 && y >= box.y0 && y < box.y1) << x << ", " << y;
    }
  }
  const auto add = [&](Pixels& to, int bx, int by, std::uint64_t mask) {
    for (; mask != 0; mask &= mask - 1) {
      const int bit = std::countr_zero(mask);
      to.emplace(bx * 8 + bit % 8, by * 8 + bit / 8);
    }
  };
  for (int by = view.y0 / 8; by <= (view.y1 - 1) / 8; ++by)
    for (int bx = view.x0 / 8; bx <= (view.x1 - 1) / 8; ++bx)
      add(blocks, bx, by, raster::cover_8x8(piece, bx, by) & raster::samples_inside(view, bx, by));
  if (!box.empty())
    raster::cover_blocks(
        piece, box, view, [](int, int) { return false; },
        [&](int bx, int by, std::uint64_t mask) {
          EXPECT_NE(mask, 0U);
          add(walked, bx, by, mask);
        });
  EXPECT_EQ(rows, blocks);
  EXPECT_EQ(rows, walked);
  return rows;
}

Pixels drawn(const SnappedLine& l, Rect view = kView) {
  Piece piece;
  const auto [a, b] = std::pair(l.v[0], l.v[1]);
  if (raster::make_line(vertex(a.x_fx8, a.y_fx8), vertex(b.x_fx8, b.y_fx8), 7, 0,
                        static_cast<std::uint32_t>(l.width), view, piece) == SetupResult::culled)
    return {};
  return pixels_of(piece, view);
}

template <class Shape>
Pixels expected(const Shape& shape, Rect view = kView) {
  Pixels out;
  for (int y = view.y0; y < view.y1; ++y)
    for (int x = view.x0; x < view.x1; ++x)
      if (covers(shape, x, y)) out.emplace(x, y);
  return out;
}

/// Often on corners, edges, centres and quarters of pixels.
std::int64_t coordinate(Random& r, int min_px, int max_px) {
  constexpr int kSteps[] = {1, 32, 64, 128, 256};
  const int step = kSteps[r.integer(0, 4)];
  return std::int64_t{r.integer(min_px * 256 / step, max_px * 256 / step)} * step;
}

SnappedLine random_line(Random& r, int min_px, int max_px, int max_width) {
  SnappedLine l;
  const auto place = [&] { return coordinate(r, min_px, max_px); };
  for (SnappedVertex& v : l.v) {
    v.x_fx8 = place();
    v.y_fx8 = place();
  }
  // Also short, axis-parallel and exactly diagonal lines.
  if (r.chance(0.3)) {
    l.v[1].x_fx8 = l.v[0].x_fx8 + r.integer(-384, 384);
    l.v[1].y_fx8 = l.v[0].y_fx8 + r.integer(-384, 384);
  }
  if (r.chance(0.1)) l.v[1].x_fx8 = l.v[0].x_fx8;
  if (r.chance(0.1)) l.v[1].y_fx8 = l.v[0].y_fx8;
  if (r.chance(0.1)) {
    const std::int64_t d = l.v[1].x_fx8 - l.v[0].x_fx8;
    l.v[1].y_fx8 = l.v[0].y_fx8 + (r.chance(0.5) ? d : -d);
  }
  l.width = r.chance(0.5) ? 1 : r.integer(1, max_width);
  return l;
}

/// Expects the oracle's coverage for lines of `make(random)`. Returns the number of pixels, and of
/// lines without any.
template <class Make>
std::pair<std::size_t, std::size_t> expect_oracle(std::uint64_t all, Rect view, const Make& make) {
  std::size_t pixels = 0, empty = 0;
  for (std::uint64_t seed = 0; seed < all && !testing::Test::HasFailure(); ++seed) {
    Random r(seed);
    const SnappedLine l = make(r);
    const Pixels want = expected(l, view);
    EXPECT_EQ(drawn(l, view), want)
        << "seed " << seed << ": (" << l.v[0].x_fx8 << ", " << l.v[0].y_fx8 << ") to ("
        << l.v[1].x_fx8 << ", " << l.v[1].y_fx8 << ") width " << l.width;
    pixels += want.size();
    empty += want.empty();
  }
  return {pixels, empty};
}

TEST(Lines, EqualTheOracle) {
  const auto all = static_cast<std::uint64_t>(share_of(6000, 100));
  const auto [pixels, empty] =
      expect_oracle(all, kView, [](Random& r) { return random_line(r, -6, kSide + 6, 7); });
  EXPECT_GT(pixels, 10 * all);
  EXPECT_GT(empty, all / 60);
}

TEST(Lines, EqualTheOracleAcrossTheGuardBand) {
  const auto all = static_cast<std::uint64_t>(share_of(400, 50));
  const auto [pixels, empty] = expect_oracle(all, {32000, 31990, 32024, 32020}, [](Random& r) {
    // Through a place of the window, from one side of the guard band to the other.
    const double x = r.real(32000, 32024), y = r.real(31990, 32020), angle = r.real(0, 6.28319);
    const double c = std::cos(angle), s = std::sin(angle);
    SnappedLine l;
    for (int i = 0; i < 2; ++i) {
      const double reach = r.real(1000, 33000) * (i == 0 ? -1 : 1);
      l.v[i].x_fx8 = std::lround((x + reach * c) * 256);
      l.v[i].y_fx8 = std::lround((y + reach * s) * 256);
    }
    l.width = r.integer(1, 4);
    return l;
  });
  EXPECT_GT(pixels, 25 * all);
}

TEST(Lines, AreOneFragmentWideAndNearTheIdealLine) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random r(seed);
    const SnappedLine l = random_line(r, 60, 100, 5);
    const std::int64_t dx = l.v[1].x_fx8 - l.v[0].x_fx8, dy = l.v[1].y_fx8 - l.v[0].y_fx8;
    const bool x_major = std::abs(dx) >= std::abs(dy);
    // (along the major axis, across it)
    const auto turned = [&](const SnappedVertex& v) {
      return x_major ? std::pair(v.x_fx8, v.y_fx8) : std::pair(v.y_fx8, v.x_fx8);
    };
    const auto start = turned(l.v[0]), end = turned(l.v[1]);
    std::map<int, std::vector<int>> minor_of;
    for (const auto& [x, y] : drawn(l, {0, 0, 160, 160}))
      minor_of[x_major ? x : y].push_back(x_major ? y : x);
    for (auto& [major, minors] : minor_of) {
      ASSERT_EQ(minors.size(), static_cast<std::size_t>(l.width)) << seed;
      std::ranges::sort(minors);
      ASSERT_EQ(minors.back() - minors.front(), l.width - 1) << seed;
      // The middle of the fragments is within half a pixel of the line.
      const double t = (major * 256 + 128.0 - static_cast<double>(start.first)) /
                       static_cast<double>(end.first - start.first);
      const double ideal =
          (static_cast<double>(start.second) + t * static_cast<double>(end.second - start.second)) /
          256;
      ASSERT_LE(std::abs((minors.front() + minors.back() + 1) / 2.0 - ideal), 0.5 + 1e-9) << seed;
    }
    // Every pixel along the major axis between the moved ends has its fragments.
    const auto [low, high] = std::minmax({start.first, end.first});
    for (auto m = static_cast<int>((low - 1) / 256) + 1; m < static_cast<int>((high - 1) / 256);
         ++m)
      ASSERT_EQ(minor_of.count(m), 1U) << seed;
  }
}

TEST(Lines, SharedEndsLeaveNeitherGapNorDouble) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Random r(seed);
    // A straight line cut at points exactly on it, drawn forwards and backwards.
    const int parts = r.integer(2, 6), sx = r.integer(-200, 200), sy = r.integer(-200, 200);
    const std::int64_t x = coordinate(r, 10, 30), y = coordinate(r, 10, 30);
    const int width = r.integer(1, 4);
    const auto point = [&](int i) { return SnappedVertex{x + i * sx, y + i * sy, 0.5F}; };
    for (const bool reverse : {false, true}) {
      const auto segment = [&](int from, int to) {
        return reverse ? SnappedLine{{point(to), point(from)}, width}
                       : SnappedLine{{point(from), point(to)}, width};
      };
      std::vector<std::pair<int, int>> all;
      for (int i = 0; i < parts; ++i)
        for (const auto& p : drawn(segment(i, i + 1))) all.push_back(p);
      const Pixels whole = drawn(segment(0, parts));
      ASSERT_EQ(all.size(), whole.size()) << seed;
      ASSERT_EQ(Pixels(all.begin(), all.end()), whole) << seed;
    }
  }
}

TEST(Lines, AClosedPolygonOfPixelCentresHasEachCornerOnce) {
  // Lines are half-open: each of the four corners belongs to one.
  const std::pair<int, int> corners[] = {{10, 10}, {30, 14}, {26, 33}, {5, 28}};
  std::map<std::pair<int, int>, int> times;
  for (int i = 0; i < 4; ++i) {
    const auto at = [&](int c) {
      return SnappedVertex{corners[c % 4].first * 256 + 128, corners[c % 4].second * 256 + 128, 0};
    };
    for (const auto& p : drawn({{at(i), at(i + 1)}})) ++times[p];
  }
  for (const auto& corner : corners) EXPECT_EQ(times[corner], 1);
}

TEST(Lines, AHorizontalLineBetweenRowsIsDrawnInTheUpperOne) {
  // Like the top-left rule for samples on an edge.
  const Pixels row = drawn({{{5 * 256 + 128, 9 * 256}, {9 * 256 + 128, 9 * 256}}});
  EXPECT_EQ(row, (Pixels{{5, 8}, {6, 8}, {7, 8}, {8, 8}}));
  const Pixels column = drawn({{{9 * 256, 5 * 256 + 128}, {9 * 256, 8 * 256 + 128}}});
  EXPECT_EQ(column, (Pixels{{8, 5}, {8, 6}, {8, 7}}));
}

TEST(Points, AreSquaresUnderTheTopLeftRule) {
  std::size_t pixels = 0;
  const std::uint64_t all = static_cast<std::uint64_t>(share_of(4000, 100));
  for (std::uint64_t seed = 0; seed < all; ++seed) {
    Random r(seed);
    SnappedPoint p;
    p.v.x_fx8 = coordinate(r, -10, kSide + 10);
    p.v.y_fx8 = coordinate(r, -10, kSide + 10);
    p.size_fx8 = r.chance(0.5) ? r.integer(1, 20) * 256 : r.integer(256, 20 * 256);
    Piece piece;
    const Pixels want = expected(p);
    const SetupResult result = raster::make_point(
        vertex(p.v.x_fx8, p.v.y_fx8), 3, 0, static_cast<std::int32_t>(p.size_fx8), kView, piece);
    ASSERT_EQ(result == SetupResult::culled, want.empty()) << seed;
    if (!want.empty()) {
      ASSERT_EQ(pixels_of(piece, kView), want) << seed;
    }
    // A whole size covers size² samples.
    if (p.size_fx8 % 256 == 0) {
      ASSERT_EQ(expected(p, {-40, -40, 80, 80}).size(),
                static_cast<std::size_t>(p.size_fx8 / 256 * p.size_fx8 / 256));
    }
    pixels += want.size();
  }
  EXPECT_GT(pixels, 25 * all);
}

/// The ends of a line inside of the near plane and the guard band, by bisection in long double.
struct Ends {
  long double x[2], y[2], z[2];
};

bool inside(const raster::Vec4d& a, const raster::Vec4d& b, long double t, long double half) {
  using L = long double;
  const L x = a.x + (L{b.x} - a.x) * t, y = a.y + (L{b.y} - a.y) * t, z = a.z + (L{b.z} - a.z) * t,
          w = a.w + (L{b.w} - a.w) * t;
  return z <= w && half * (x + w) >= -32768 * w && half * (x + w) <= 65536 * w &&
         half * (w - y) >= -32768 * w && half * (w - y) <= 65536 * w;
}

TEST(ClipLine, EqualsHalvingInLongDouble) {
  constexpr int kSize = 256;
  const raster::Viewport viewport = raster::Viewport::of(kSize, kSize);
  int clipped = 0, gone = 0;
  for (std::uint64_t seed = 0; seed < 5000; ++seed) {
    Random r(seed);
    raster::Vec4d c[2];
    ProjectedVertex v[2];
    for (int i = 0; i < 2; ++i) {
      const double scale = std::exp2(r.real(-2, 12));
      c[i] = {static_cast<float>(r.real(-scale, scale)), static_cast<float>(r.real(-scale, scale)),
              0.5F, static_cast<float>(r.real(-1, 3))};
      v[i] = raster::project({static_cast<float>(c[i].x), static_cast<float>(c[i].y), 0.5F,
                              static_cast<float>(c[i].w)},
                             viewport);
    }
    const bool whole[2] = {v[0].x_fx8 != raster::kNeedsClip, v[1].x_fx8 != raster::kNeedsClip};
    if (whole[0] && whole[1]) continue;
    ++clipped;
    // A point of the line that is inside, if any: the inside is an interval.
    long double t_in = -1;
    if (whole[0]) t_in = 0;
    if (whole[1]) t_in = 1;
    for (int i = 0; i <= 20000 && t_in < 0; ++i)
      if (inside(c[0], c[1], i / 20000.0L, kSize / 2)) t_in = i / 20000.0L;
    ProjectedVertex out[2] = {v[0], v[1]};
    const bool any = raster::clip_line(c, out, viewport);
    if (t_in < 0) {  // an interval shorter than the steps may be missed
      gone += !any;
      continue;
    }
    ASSERT_TRUE(any) << seed;
    for (int i = 0; i < 2; ++i) {
      if (whole[i]) {
        EXPECT_EQ(out[i].x_fx8, v[i].x_fx8);
        EXPECT_EQ(out[i].depth, v[i].depth);
        continue;
      }
      long double in = t_in, outside = i;
      for (int step = 0; step < 80; ++step) {
        const long double middle = (in + outside) / 2;
        (inside(c[0], c[1], middle, kSize / 2) ? in : outside) = middle;
      }
      const long double w = c[0].w + (static_cast<long double>(c[1].w) - c[0].w) * in;
      const long double x =
          (c[0].x + (static_cast<long double>(c[1].x) - c[0].x) * in) / w * 128 + 128;
      const long double y =
          128 - (c[0].y + (static_cast<long double>(c[1].y) - c[0].y) * in) / w * 128;
      EXPECT_NEAR(static_cast<double>(x), out[i].x_fx8 / 256.0, 1 / 256.0) << seed;
      EXPECT_NEAR(static_cast<double>(y), out[i].y_fx8 / 256.0, 1 / 256.0) << seed;
      EXPECT_NEAR(static_cast<double>(0.5L / w), out[i].depth, 1e-5) << seed;
    }
    // The reversed line has the same ends.
    const raster::Vec4d back[2] = {c[1], c[0]};
    ProjectedVertex reverse[2] = {v[1], v[0]};
    ASSERT_TRUE(raster::clip_line(back, reverse, viewport));
    for (int i = 0; i < 2; ++i) {
      EXPECT_EQ(out[i].x_fx8, reverse[1 - i].x_fx8) << seed;
      EXPECT_EQ(out[i].y_fx8, reverse[1 - i].y_fx8) << seed;
      EXPECT_EQ(out[i].depth, reverse[1 - i].depth) << seed;
    }
  }
  EXPECT_GT(clipped, 1500);
  EXPECT_GT(gone, 200);
}

}  // namespace
}  // namespace rastrum::test::lines_test
