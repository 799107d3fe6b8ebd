// SPDX-License-Identifier: BSD-3-Clause
// A terrain's values at a point; the options beyond the original: filters, projections, roll, fog,
// the matrix; and odd input.
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/terrain.hpp>
#include <rastrum/terrain/ceiling.hpp>
#include <rastrum/terrain/map_view.hpp>
#include <rastrum/terrain/setup.hpp>

#include "tests/support/isa.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/refused.hpp"
#include "tests/terrain/maps.hpp"
#include "tests/terrain/picture.hpp"

namespace rastrum::terrain::terrain_test {
namespace {

using test::TerrainLook;
using test::TerrainPainter;
using Picture = test::TerrainPicture;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kPi = 3.14159265358979323846;

TerrainLook size(int width, int height) {
  return TerrainLook({.width = width, .height = height});
}

/// Expects that a renderer or its frame refuses this look, with `part` in the message.
void refused(const std::string& part, const TerrainLook& look, const TerrainCamera& camera = {},
             Errc code = Errc::invalid_argument) {
  const Terrain flat(HeightMap{Image<float>(4, 4), {}});
  SCOPED_TRACE(part);
  test::expect_refused(part, code, [&] { TerrainPainter(look).render(flat, camera, {}); });
}

Pyramid pyramid_of(const HeightMap& map, bool mipmaps) {
  return {std::make_unique<const Image<float>>(map.heights),
          std::make_unique<const Image<Rgba8>>(map.colors), mipmaps};
}

TEST(Tiled, FloorsNegativeCoordinates) {
  struct Case {
    int i;
    Tiling tiling;
    int expected;
  };
  for (const Case& c : {Case{-1, Tiling::repeat, 2},
                        {-3, Tiling::repeat, 0},
                        {7, Tiling::repeat, 1},
                        {-1, Tiling::mirror, 0},
                        {3, Tiling::mirror, 2},
                        {-4, Tiling::mirror, 2},
                        {6, Tiling::mirror, 0},
                        {-5, Tiling::clamp, 0},
                        {5, Tiling::clamp, 2},
                        {5, Tiling::none, 2}})
    EXPECT_EQ(tiled(c.i, 3, c.tiling), c.expected) << c.i << ", " << static_cast<int>(c.tiling);
}

TEST(Bilinear, IsRightAtCentresAndAtWholeCoordinates) {
  std::mt19937 random(2);
  const HeightMap map = test::random_map(8, 8, random, 1);
  const Pyramid pyramid = pyramid_of(map, false);
  const MapView view(pyramid, {.filter = MapFilter::bilinear}, terrain::Setup{});
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      const float u = static_cast<float>(x), v = static_cast<float>(y);
      EXPECT_EQ(view.height_at(u + 0.5F, v + 0.5F, 0), map.heights(x, y));
      EXPECT_EQ(view.color_at(u + 0.5F, v + 0.5F, 0), map.colors(x, y));
      const float mean = (map.heights((x + 7) % 8, (y + 7) % 8) + map.heights(x, (y + 7) % 8) +
                          map.heights((x + 7) % 8, y) + map.heights(x, y)) /
                         4;
      EXPECT_NEAR(view.height_at(u, v, 0), mean, 1e-4F) << x << ", " << y;
    }
}

TEST(Pyramid, HoldsMaximaAndMeansOfOddSizesAndHoles) {
  HeightMap map{Image<float>(3, 2), Image<Rgba8>(3, 2)};
  const float heights[] = {1, kNaN, kNaN, 2, 5, kNaN};
  std::copy_n(heights, 6, map.heights.pixels().data());
  map.colors(0, 0) = {10, 0, 0, 255};
  map.colors(1, 0) = {20, 0, 0, 255};
  map.colors(2, 0) = {30, 0, 0, 255};
  map.colors(2, 1) = {41, 0, 0, 255};
  const Pyramid pyramid = pyramid_of(map, true);
  ASSERT_EQ(pyramid.height_levels(), 3);
  EXPECT_EQ(pyramid.heights(1)(0, 0), 5);
  EXPECT_TRUE(std::isnan(pyramid.heights(1)(1, 0)));
  EXPECT_EQ(pyramid.heights(2)(0, 0), 5);
  EXPECT_EQ(pyramid.colors(1)(0, 0).r, 8);   // (10 + 20 + 0 + 0 + 2) / 4
  EXPECT_EQ(pyramid.colors(1)(1, 0).r, 36);  // (30 + 41 + 1) / 2
}

TEST(MapView, TilesHeightsAndColoursOfAnotherSizeAsTheTerrainDoes) {
  std::mt19937 random(12);
  HeightMap map = test::random_map(10, 13, random, 1);
  map.colors = test::random_map(37, 91, random).colors;
  const Terrain terrain(map);
  const Pyramid pyramid(terrain.heights(), terrain.colors(), false);
  std::uniform_real_distribution<float> at(-70, 70);
  for (const Tiling tiling : {Tiling::repeat, Tiling::mirror, Tiling::clamp, Tiling::none}) {
    const MapView view(pyramid, {.tiling = tiling}, terrain::Setup{});
    for (int i = 0; i < 5000; ++i) {
      const float x = at(random), y = at(random);
      const auto x64 = static_cast<double>(x), y64 = static_cast<double>(y);
      const float there = terrain.height_at(x64, y64, tiling);
      if (tiling == Tiling::none) {
        EXPECT_EQ(std::isnan(there), x < 0 || x >= 10 || y < 0 || y >= 13) << x << ", " << y;
      }
      if (std::isnan(there)) {
        EXPECT_TRUE(std::isnan(view.height_at(x, y, 0))) << x << ", " << y;
        continue;  // nothing with a colour
      }
      EXPECT_EQ(view.height_at(x, y, 0), there);
      // float32 may round across a texel's edge.
      const Rgba8 color = view.color_at(x, y, 0);
      bool found = false;
      for (const double dx : {-1e-5, 1e-5})
        for (const double dy : {-1e-5, 1e-5})
          found = found || terrain.color_at(x64 + dx, y64 + dy, tiling) == color;
      EXPECT_TRUE(found) << x << ", " << y << " tiling " << static_cast<int>(tiling);
    }
  }
}

TEST(Mip, TakesTheLevelOfTheStepOrOfTheColumnsWidth) {
  // A column is z / 50 wide.
  TerrainLook options(
      {.width = 100, .height = 50, .distance = 500, .dz = 0, .filter = MapFilter::mip});
  const Terrain flat(HeightMap{Image<float>(4, 4), {}});
  const terrain::Setup fine = set_up(options, {}, flat);
  for (const Slice& slice : fine.slices) {
    const int level = slice.z <= 100 ? 0 : slice.z <= 200 ? 1 : slice.z <= 400 ? 2 : 3;
    EXPECT_EQ(slice.level, level) << slice.z;
  }
  options.step = 5;
  for (const Slice& slice : set_up(options, {}, flat).slices)
    EXPECT_EQ(slice.level, slice.z < 400 ? 2 : 3) << slice.z;
}

TEST(Mip, FarTerrainIsTheMeanOfItsColours) {
  HeightMap map{Image<float>(64, 64), Image<Rgba8>(64, 64)};
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      map.colors(x, y) = (x + y) % 2 == 0 ? Rgba8{200, 0, 0, 255} : Rgba8{0, 0, 100, 255};
  TerrainLook options({.width = 80, .height = 60, .distance = 4000});
  const TerrainCamera camera{.altitude = 30, .horizon_px = 10};
  const Picture aliased(Terrain(map), camera, options);
  options.filter = MapFilter::mip;
  const Picture mean(Terrain(map), camera, options);
  int far = 0;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x) {
      if (mean.is_sky(x, y) || mean.depth(x, y) < 100) continue;
      ++far;
      EXPECT_EQ(mean.colors(x, y), (Rgba8{100, 0, 50, 255}));
      EXPECT_NE(aliased.colors(x, y), (Rgba8{100, 0, 50, 255}));
    }
  EXPECT_GT(far, 300);
}

TEST(Mip, ColoursOfTwiceTheSizeAreReadOneLevelUp) {
  HeightMap map{Image<float>(2, 2), Image<Rgba8>(4, 4)};
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x)
      map.colors(x, y) = {static_cast<std::uint8_t>(40 * x), static_cast<std::uint8_t>(40 * y), 0,
                          255};
  const Pyramid pyramid = pyramid_of(map, true);
  const MapView view(pyramid, {.filter = MapFilter::mip}, terrain::Setup{});
  EXPECT_EQ(view.color_at(0.1F, 0.9F, 0), (Rgba8{20, 20, 0, 255}));
  EXPECT_EQ(view.color_at(1.9F, 0.1F, 0), (Rgba8{100, 20, 0, 255}));
  EXPECT_EQ(view.color_at(1.9F, 0.1F, 1), (Rgba8{60, 60, 0, 255}));
}

TEST(Ceiling, IsNeverBelowAHeightOfTheRectangle) {
  std::mt19937 random(6);
  for (int i = 0; i < 300; ++i) {
    const int width = 1 + static_cast<int>(random() % 90);
    const int height = 1 + static_cast<int>(random() % 90);
    const HeightMap map = test::random_map(width, height, random, 1);
    const Ceiling ceiling(std::make_unique<const Image<float>>(map.heights));
    const auto tiling = static_cast<Tiling>(i % 4);
    const auto range = [&] {
      const auto first = static_cast<std::int64_t>(random() % 400) - 200;
      return CellRange{first, first + static_cast<std::int64_t>(random() % 60)};
    };
    const CellRange x = range(), y = range();
    float highest = -kInfinity;
    for (std::int64_t v = y.first; v <= y.last; ++v)
      for (std::int64_t u = x.first; u <= x.last; ++u)
        highest = std::max(highest, map.heights(static_cast<int>(tiled(u, width, tiling)),
                                                static_cast<int>(tiled(v, height, tiling))));
    EXPECT_GE(ceiling.over(x, y, tiling), highest) << i;
  }
}

TEST(Roll, QuarterTurnsAreThePixelsThemselves) {
  std::mt19937 random(7);
  const Terrain terrain(test::random_map(64, 64, random));
  for (const auto projection : {Projection::planar, Projection::cylindrical}) {
    const TerrainLook options(
        {.width = 90, .height = 90, .distance = 200, .projection = projection});
    const TerrainCamera level{.x = 3, .y = 5, .altitude = 300, .horizon_px = 30};
    const Picture upright(terrain, level, options);
    for (int quarter = -4; quarter <= 4; ++quarter) {
      TerrainCamera rolled = level;
      rolled.roll_rad = quarter * kPi / 2;
      const Picture picture(terrain, rolled, options);
      std::size_t wrong = 0;
      for (int y = 0; y < 90; ++y)
        for (int x = 0; x < 90; ++x) {
          int u = x, v = y;  // this pixel's place before the turn
          for (int t = 0; t < (quarter + 8) % 4; ++t) {
            const int before = u;
            u = 89 - v;
            v = before;
          }
          wrong += !(picture.colors(x, y) == upright.colors(u, v)) ||
                   picture.depth(x, y) != upright.depth(u, v);
        }
      EXPECT_EQ(wrong, 0U) << "quarter " << quarter;
    }
  }
}

/// A wall across the view, coloured by the place, in a picture that is not square.
TEST(Roll, AnyAngleShowsWhatTheTurnedRaysMeet) {
  const Terrain wall = Terrain::of(
      [](double, double y) { return y < -49.5 ? 1000.0F : -1000.0F; },
      [](double x, double) {
        return Rgba8{static_cast<std::uint8_t>(std::clamp(128 + x, 0.0, 255.0)), 0, 0, 255};
      });
  TerrainLook options({.width = 120, .height = 80, .distance = 60, .dz = 0});
  for (const auto projection : {Projection::planar, Projection::cylindrical})
    for (const double roll : {0.5, -1.1, 2.0, 3.5}) {
      options.projection = projection;
      const Picture picture(wall, {.x = 0, .y = 0, .altitude = 0, .roll_rad = roll}, options);
      for (int y = 0; y < 80; ++y)
        for (int x = 0; x < 120; ++x) {
          const double across = std::cos(roll) * (x + 0.5 - 60) - std::sin(roll) * (y + 0.5 - 40);
          // A column's ray, with the cylinder's samples at equal distances.
          double right = 50 * across / 60;
          if (projection == Projection::cylindrical) {
            const double angle = across / 60 * kPi / 4;
            right = std::tan(angle) * 50;
            if (std::abs(angle) > 0.5) continue;
          }
          EXPECT_NEAR(picture.colors(x, y).r, 128 + right, 2)
              << x << ", " << y << " rolled by " << roll;
        }
    }
}

TEST(Roll, TurnsTheHorizonAboutThePicturesCentre) {
  const Terrain flat(HeightMap{Image<float>(1, 1), {}});
  const TerrainLook options({.width = 120, .height = 80, .distance = 1e5, .step = 0.25});
  for (const double roll : {0.0, 0.5, -1.1, 2.0}) {
    const Picture picture(flat, {.altitude = 8, .horizon_px = 52, .roll_rad = roll}, options);
    for (int y = 0; y < 80; ++y)
      for (int x = 0; x < 120; ++x) {
        const double row = 40 + std::sin(roll) * (x + 0.5 - 60) + std::cos(roll) * (y + 0.5 - 40);
        if (std::abs(row - 52) < 0.6) continue;  // the horizon crosses this pixel
        EXPECT_EQ(picture.is_sky(x, y), row < 52) << x << ", " << y << " rolled by " << roll;
      }
  }
}

TEST(Scale, DrawsASquareAsHighAsWide) {
  const Terrain board = Terrain::of(
      [](double x, double y) { return y < -49.5 && std::abs(x) < 10 ? 20.0F : -9999.0F; },
      [](double, double) {
        return Rgba8{1, 2, 3, 255};
      });
  TerrainLook options({.width = 300, .height = 200, .distance = 50.5, .dz = 0});
  for (const double fov : {0.9, 2.0}) {
    options.fov_rad = fov;
    // Its foot is at the horizon.
    const Picture picture(board, {.x = 0, .y = 0, .altitude = 0, .horizon_px = 199}, options);
    int wide = 0, high = 0;
    for (int x = 0; x < 300; ++x) wide += !picture.is_sky(x, 198);
    for (int y = 0; y < 199; ++y) high += !picture.is_sky(150, y);
    EXPECT_NEAR(wide, 20 * 150 / (50 * std::tan(fov / 2)), 1.5);
    EXPECT_NEAR(high, wide, 2);
  }
}

TEST(Clearance, LiftsTheCameraAboveTheGroundUnderItAlone) {
  HeightMap map{Image<float>(4, 4), {}};
  map.heights(1, 2) = 30;
  const Terrain terrain(map);
  TerrainLook options = size(4, 4);
  options.ground_clearance = 5;
  const auto altitude = [&](double x, double y, double given) {
    return Picture(terrain, {.x = x, .y = y, .altitude = given}, options).stats.camera.altitude;
  };
  EXPECT_EQ(altitude(1.5, 2.5, 10), 35);
  EXPECT_EQ(altitude(5.5, -1.5, 10), 35) << "tiled";
  EXPECT_EQ(altitude(1.5, 2.5, 40), 40);
  EXPECT_EQ(altitude(0.5, 2.5, 10), 10);
  options.tiling = Tiling::clamp;
  EXPECT_EQ(altitude(5.5, -1.5, 10), 10);
  options.ground_clearance = {};
  EXPECT_EQ(altitude(1.5, 2.5, 10), 10);
}

/// The upper ends of the picture's spans, where a sample is first drawn.
template <class Each>
void for_each_top(const Picture& picture, Each&& each) {
  for (int y = 1; y < picture.depth.height(); ++y)
    for (int x = 0; x < picture.depth.width(); ++x)
      if (picture.depth(x, y) != picture.depth(x, y - 1) && !picture.is_sky(x, y)) each(x, y);
}

/// Each visible sample, transformed back into the world by hand, falls on its pixel.
void expect_matrix(const TerrainLook& options, const TerrainCamera& given) {
  std::mt19937 random(8);
  const Terrain terrain(test::random_map(128, 128, random, 0.1));
  const Picture picture(terrain, given, options);
  const TerrainCamera camera = picture.stats.camera;
  const Mat4d clip = world_to_clip(options, camera, 0.5);
  const double sin = std::sin(camera.angle_rad), cos = std::cos(camera.angle_rad);
  const double half = options.classic ? 1 : std::tan(options.fov_rad / 2);
  std::size_t tested = 0, wrong = 0;
  for_each_top(picture, [&](int x, int y) {
    const double z = static_cast<double>(picture.depth(x, y));
    const double right = z * half * ((x + (options.classic ? 0 : 0.5)) * 2 / options.width - 1);
    const double wx = camera.x + cos * right - sin * z, wy = camera.y - sin * right - cos * z;
    // A sample on a cell's edge may round either way.
    if (std::abs(wx - std::round(wx)) < 1e-3 || std::abs(wy - std::round(wy)) < 1e-3) return;
    const auto c = test::product(clip, wx, static_cast<double>(terrain.height_at(wx, wy)), wy);
    const double px = (c[0] / c[3] + 1) / 2 * options.width;
    const double py = (1 - c[1] / c[3]) / 2 * options.height;
    ++tested;
    wrong += std::abs(px - (x + 0.5)) > 0.01 ||
             (std::ceil(py - 0.5 - 0.01) > y || std::ceil(py - 0.5 + 0.01) < y) ||
             std::abs(c[2] / c[3] - 0.5 / z) > 1e-6;
  });
  EXPECT_GT(tested, 500U);
  EXPECT_EQ(wrong, 0U);
}

TEST(Matrix, PutsWhatIsSeenOnItsPixel) {
  TerrainLook options({.width = 200, .height = 150, .distance = 300});
  const TerrainCamera camera{
      .x = 40.3, .y = -17.6, .altitude = 290, .angle_rad = 0.7, .horizon_px = 40};
  expect_matrix(options, camera);
  options.fov_rad = 2;
  options.scale_px = 77;
  expect_matrix(options, camera);
  expect_matrix(TerrainLook({.width = 200, .height = 150, .distance = 300, .classic = true}),
                camera);
}

TEST(Matrix, FollowsTheRollAndRefusesCylinders) {
  TerrainLook options = size(120, 80);
  TerrainCamera camera{.altitude = 50, .horizon_px = 10, .roll_rad = kPi / 2};
  TerrainCamera level = camera;
  level.roll_rad = 0;
  // A point in both pictures, turned counter-clockwise about the centre: right becomes up.
  const auto pixel = [&](const TerrainCamera& c) {
    const auto q = test::product(world_to_clip(options, c), c.x + 20, 60, c.y - 100);
    return std::pair{q[0] / q[3] * 60, -q[1] / q[3] * 40};  // px from the centre
  };
  const auto [ax, ay] = pixel(level);
  const auto [bx, by] = pixel(camera);
  EXPECT_NEAR(bx, ay, 1e-9);
  EXPECT_NEAR(by, -ax, 1e-9);
  options.projection = Projection::cylindrical;
  EXPECT_THROW((void)world_to_clip(options, camera), Error);
}

TEST(Cylinder, StretchesNothing) {
  // A ring of posts of one height at equal angles must be the same number of columns apart.
  const Terrain posts = Terrain::of(
      [](double x, double y) {
        const double turn = std::atan2(x, -y) / (2 * kPi) * 36, r = std::hypot(x, y);
        return r > 50 && r < 60 && std::abs(turn - std::round(turn)) < 0.1 ? 40.0F : -1000.0F;
      },
      [](double x, double) {
        return Rgba8{static_cast<std::uint8_t>(x > 0 ? 200 : 100), 2, 3, 255};
      });
  const TerrainLook options({.width = 720,
                             .height = 200,
                             .distance = 70,
                             .fov_rad = 2 * kPi,
                             .projection = Projection::cylindrical});
  const Picture picture(posts, {.x = 0, .y = 0, .altitude = 0, .horizon_px = 199}, options);
  int edges = 0, top = -1;
  for (int x = 0; x < 720; ++x) {
    const int next = (x + 20) % 720;
    EXPECT_EQ(picture.is_sky(x, 150), picture.is_sky(next, 150)) << x;
    edges += picture.is_sky(x, 150) != picture.is_sky((x + 1) % 720, 150);
    if (picture.is_sky(x, 150)) continue;
    if (std::abs(x - 360) > 4 && x > 4 && x < 716) {
      EXPECT_EQ(picture.colors(x, 150).r, x > 360 ? 200 : 100) << "east is on the right: " << x;
    }
    int first = 0;
    while (picture.is_sky(x, first)) ++first;
    EXPECT_TRUE(top == -1 || std::abs(first - top) <= 1) << x;
    top = first;
  }
  EXPECT_EQ(edges, 72);
}

TEST(Fog, EndsInItsColour) {
  const Terrain flat(HeightMap{Image<float>(1, 1), {}});
  TerrainLook options = size(4, 300);
  options.distance = 3000;
  options.fog = {0.01, 0, Rgba8{9, 99, 199, 255}};
  options.scale_px = 240;
  const Picture picture(flat, {.altitude = 50, .horizon_px = 50}, options);
  int first = 0;  // the first row of ground
  while (picture.is_sky(0, first)) ++first;
  EXPECT_EQ(first, 54);
  EXPECT_EQ(picture.colors(0, first - 1), kSky);
  EXPECT_EQ(picture.colors(0, first), (Rgba8{9, 99, 199, 255}));
  EXPECT_LT(picture.colors(0, 299).b, picture.colors(0, 100).b);
}

TEST(Fog, IsTheShareOfTheRulesBeyondItsStart) {
  HeightMap map{Image<float>(1, 1), Image<Rgba8>(1, 1)};
  map.colors(0, 0) = {255, 100, 0, 255};
  const Terrain flat(map);
  for (const double start : {0.0, 60.0}) {
    TerrainLook options = size(3, 200);
    options.fog = {0.01, start, Rgba8{0, 200, 255, 255}};
    options.scale_px = 100;
    const Picture picture(flat, {.altitude = 30, .horizon_px = 20}, options);
    int fogged = 0;
    for (int y = 30; y < 200; ++y) {
      const auto z = static_cast<double>(picture.depth(1, y));
      const double clear = std::exp(-0.01 * std::max(0.0, z - start));
      fogged += clear < 0.9;
      EXPECT_NEAR(picture.colors(1, y).r, 255 * clear, 1.1) << z;
      EXPECT_NEAR(picture.colors(1, y).g, 200 - 100 * clear, 1.1) << z;
      EXPECT_NEAR(picture.colors(1, y).b, 255 - 255 * clear, 1.1) << z;
    }
    EXPECT_GT(fogged, 20);
  }
}

TEST(OddInput, FlatGroundFillsTheRowsBelowTheHorizon) {
  for (const float height : {0.0F, -500.0F, 1e6F}) {
    HeightMap map{Image<float>(5, 3), {}};
    for (float& h : map.heights.pixels()) h = height;
    const TerrainLook options({.width = 40, .height = 60, .distance = 1e5, .step = 0.25});
    const Picture picture(Terrain(std::move(map)),
                          {.altitude = static_cast<double>(height) + 8, .horizon_px = 20}, options);
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 40; ++x) EXPECT_EQ(picture.is_sky(x, y), y < 20) << height << ": " << y;
  }
}

/// Near slopes have no stripes: each row below the horizon has its own ground, within a pixel of
/// where its ray meets the plane. Steps of a cell would repeat one ground over dozens of rows.
TEST(Steps, ArePixelsHighWithTheBilinearFilter) {
  const Terrain flat(HeightMap{Image<float>(4, 4), {}});
  for (const double fov : {0.4, kPi / 2, 2.2})
    for (const double altitude : {2.0, 20.0, 300.0}) {
      const TerrainLook options({.width = 64,
                                 .height = 240,
                                 .distance = 1e5,
                                 .fov_rad = fov,
                                 .step = 0,
                                 .filter = MapFilter::bilinear});
      const Picture picture(flat, {.altitude = altitude, .horizon_px = 40}, options);
      const double scale = terrain::scale_px(options);
      int distinct = 0, seen = 0;
      for (int y = 60; y < 240; ++y) {
        const double z = altitude * scale / (y + 0.5 - 40);
        if (z < 2) break;  // the first sample lies at 1
        EXPECT_NEAR(altitude * scale / picture.depth(7, y) + 40, y + 0.5, 1.01)
            << fov << " " << altitude << " row " << y;
        ++seen;
        distinct += picture.depth(7, y) != picture.depth(7, y - 1);
      }
      EXPECT_EQ(distinct, seen) << fov << " " << altitude;
    }
}

TEST(Steps, OfOtherFiltersAreCellsWhereTheyAreLeftOpen) {
  const Terrain flat(HeightMap{Image<float>(4, 4), {}});
  for (const MapFilter filter : {MapFilter::none, MapFilter::mip}) {
    TerrainLook options = size(64, 40);
    options.filter = filter;
    const auto own = set_up(options, {}, flat).slices;
    options.step = 0;
    const auto open = set_up(options, {}, flat).slices;
    ASSERT_EQ(open.size(), own.size());
    for (std::size_t k = 0; k < own.size(); ++k) {
      EXPECT_EQ(open[k].z, own[k].z);
      EXPECT_EQ(open[k].level, own[k].level);
    }
  }
  const TerrainLook narrow({.width = 32768,
                            .height = 40,
                            .distance = 8e6,
                            .fov_rad = 1e-4,
                            .step = 0,
                            .filter = MapFilter::bilinear});
  EXPECT_LT(slice_count(narrow), 270e3) << "the narrowest view has an end";
  EXPECT_NEAR(slice_count(narrow), std::log(8e6) * 0x1p14, 50);
}

TEST(OddInput, HolesLetThroughWhatLiesBehind) {
  HeightMap map{Image<float>(64, 64), {}};
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      map.heights(x, y) = y == 20 ? 100.0F : y < 60 && y > 30 ? kNaN : 0.0F;
  const TerrainLook options({.width = 32, .height = 100, .tiling = Tiling::clamp});
  const TerrainCamera camera{.x = 32, .y = 62, .altitude = 10, .horizon_px = 50};
  const Picture picture(Terrain(map), camera, options);
  // The hole has no sample, so the wall behind is drawn down to the ground in front.
  for (const float depth : picture.depth.pixels()) EXPECT_FALSE(depth > 3 && depth < 31) << depth;
  for (float& h : map.heights.pixels()) h = kNaN;
  const Picture nothing(Terrain(map), camera, options);
  EXPECT_TRUE(nothing.is_sky(16, 99));
}

TEST(OddInput, UnderTheGroundOneSeesOnlyGround) {
  const Terrain flat(HeightMap{Image<float>(8, 8), {}});
  TerrainLook options = size(16, 16);
  const Picture under(flat, {.altitude = -20, .horizon_px = 8}, options);
  for (const float depth : under.depth.pixels()) EXPECT_EQ(depth, 1);
  options.ground_clearance = 10;
  const Picture lifted(flat, {.altitude = -20, .horizon_px = 8}, options);
  EXPECT_EQ(lifted.stats.camera.altitude, 10);
  EXPECT_TRUE(lifted.is_sky(3, 0));
}

TEST(OddInput, HighAndFarCamerasAndLongViews) {
  std::mt19937 random(9);
  const Terrain terrain(test::random_map(48, 80, random));
  TerrainLook options({.width = 64, .height = 64, .distance = 1e6, .dz = 0.01});
  const Picture high(terrain, {.altitude = 1e6, .horizon_px = 0}, options);
  EXPECT_FALSE(high.is_sky(32, 63));
  // Whole periods away, everything looks the same.
  options.distance = 300;
  const Picture near(terrain, {.x = 5.5, .y = 7.25, .altitude = 300, .horizon_px = 8}, options);
  const Picture far(terrain,
                    {.x = 5.5 - 48 * 1e8, .y = 7.25 + 80 * 1e8, .altitude = 300, .horizon_px = 8},
                    options);
  EXPECT_TRUE(same_picture(near, far));
}

TEST(OddInput, IsRefusedWithTheOptionsName) {
  TerrainPainter(size(8, 8)).render(Terrain(HeightMap{Image<float>(4, 4), {}}), {}, {});
  refused("size 0x8", size(0, 8));
  refused("distance", {{.width = 8, .height = 8, .distance = kNaN}});
  TerrainPainter({{.width = 8, .height = 8, .distance = 100, .fov_rad = 3.14}})
      .render(Terrain(HeightMap{Image<float>(4, 4), {}}), {}, {});
  refused("wider than 0", {{.width = 8, .height = 8, .fov_rad = 0}});
  refused("less than 180 degrees", {{.width = 8, .height = 8, .fov_rad = kPi}});
  refused("at most 360 degrees", {{.width = 8,
                                   .height = 8,
                                   .fov_rad = std::nextafter(2 * kPi, 7.0),
                                   .projection = Projection::cylindrical}});
  refused("larger steps", {{.width = 8, .height = 8, .distance = 1e6, .step = 1e-3, .dz = 0}});
  refused("classic", {{.width = 8, .height = 8, .classic = true, .filter = MapFilter::bilinear}});
  refused("roll", {{.width = 8, .height = 8, .classic = true}}, {.roll_rad = 1});
  refused("camera", size(8, 8), {.x = 1e300});
  refused("camera", size(8, 8), {.altitude = std::nan("")});
  refused("CUDA", {{.width = 8, .height = 8}, {.device = Device::cuda}}, {}, Errc::no_device);
  for (const Device device : {Device::serial, Device::threads})
    refused("--isa", {{.width = 8, .height = 8}, {.device = device, .isa = test::missing_isa()}},
            {}, Errc::no_device);
  EXPECT_THROW(Terrain(HeightMap{}), Error);
}

TEST(OddInput, EnumsWithoutAValueAreRefused) {
  refused("filter is 200", {{.filter = static_cast<MapFilter>(200)}});
  refused("tiling is 200", {{.tiling = static_cast<Tiling>(200)}});
  refused("projection is 200", {{.projection = static_cast<Projection>(200)}});
  refused("device is 200", {{}, {.device = static_cast<Device>(200)}});
  refused("isa is 200", {{}, {.isa = static_cast<Isa>(200)}});
}

TEST(Targets, AreOfTheFramesSizeAndMayLieUpsideDown) {
  std::mt19937 random(11);
  const Terrain terrain(test::random_map(40, 40, random));
  const TerrainCamera camera{.altitude = 300, .horizon_px = 5};
  for (const Device device : {Device::serial, Device::threads}) {
    for (const double roll : {0.0, 0.3}) {
      TerrainLook options = size(61, 40);
      options.device = device;
      TerrainCamera rolled = camera;
      rolled.roll_rad = roll;
      const Picture upright(terrain, rolled, options);
      Image<Rgba8> colors(61, 40);
      Image<float> depth(61, 40);
      TerrainPainter renderer(options);
      renderer.render(terrain, rolled,
                      {{&colors(0, 39), 61, 40, -61}, {&depth(0, 39), 61, 40, -61}});
      EXPECT_TRUE(
          test::pixels_are(colors, [&](int x, int y) { return upright.colors(x, 39 - y); }));
      EXPECT_TRUE(test::pixels_are(depth, [&](int x, int y) { return upright.depth(x, 39 - y); }));
      const auto target_refused = [&](const std::string& part, const TerrainTargets& targets) {
        test::expect_refused(part, [&] { renderer.render(terrain, rolled, targets); });
      };
      Image<float> small(8, 8);
      target_refused("terrain: the depth target is 8x8 and must be 61x40, as the frame is",
                     {{}, small});
      target_refused("terrain: the color8 target: rows of 61 pixels overlap",
                     {{&colors(0, 0), 61, 40, 0}, {}});
    }
  }
}

TEST(OddInput, LargeMaps) {
  // 16,384²: 1 GiB of heights, touched once, with one colour.
  HeightMap map{Image<float>(16384, 16384), Image<Rgba8>(1, 1)};
  map.heights(16383, 16380) = 1000;
  map.colors(0, 0) = {1, 2, 3, 255};
  const Terrain terrain(std::move(map));
  const TerrainLook options({.width = 64, .height = 48, .distance = 100});
  const Picture picture(terrain, {.x = 16383.5, .y = 16400.5, .altitude = 20, .horizon_px = 24},
                        options);
  EXPECT_FALSE(picture.is_sky(31, 0)) << "the peak";
  EXPECT_TRUE(picture.is_sky(10, 0));
  EXPECT_EQ(picture.colors(10, 47), (Rgba8{1, 2, 3, 255}));
}

}  // namespace
}  // namespace rastrum::terrain::terrain_test
