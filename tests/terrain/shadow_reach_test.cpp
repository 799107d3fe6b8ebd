// SPDX-License-Identifier: BSD-3-Clause
// How far beyond a map the shadow sweep looks, which depends on the height ranges of tiles.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/terrain/shadow_kernels.hpp>
#include <rastrum/terrain/shadow_ray.hpp>
#include <rastrum/terrain/shadow_reach.hpp>
#include <rastrum/terrain/shadow_sweep.hpp>

#include "tests/support/random.hpp"

namespace rastrum::terrain::shadow_reach_test {
namespace {

using test::Random;

constexpr Tiling kTilings[] = {Tiling::repeat, Tiling::mirror, Tiling::clamp};

HeightTiles tiles_of(const Image<float>& map) {
  HeightTiles tiles;
  tiles.resize(map.width(), map.height());
  std::ranges::fill(tiles.lowest, std::numeric_limits<float>::infinity());
  std::ranges::fill(tiles.highest, -std::numeric_limits<float>::infinity());
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const std::size_t tile = tiles.at(x / HeightTiles::kEdge, y / HeightTiles::kEdge);
      tiles.lowest[tile] = std::min(tiles.lowest[tile], map(x, y));
      tiles.highest[tile] = std::max(tiles.highest[tile], map(x, y));
    }
  return tiles;
}

Sweep plan(const Image<float>& map, const Sun& sun, Tiling tiling) {
  const auto [low, high] = std::ranges::minmax_element(map.pixels());
  const ShadowCaster caster{map.view(), tiling, *low, *high};
  const SunRay ray = sun_ray(sun, caster.relief());
  return plan_sweep(caster, tiles_of(map), ray, ray_steps(ray, caster.relief()));
}

/// Smooth and rough, so that some blocks hide others.
Image<float> hills(int width, int height, double relief, Random& random) {
  Image<float> map(width, height);
  const double u = random.real(-0.1, 0.1), v = random.real(-0.1, 0.1), rough = random.real(0, 0.4);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      map(x, y) = static_cast<float>(
          relief * (1 + (1 - rough) * std::sin(u * x + v * y) + random.real(-rough, rough)) / 2);
  return map;
}

TEST(ShadowReach, WhatIsLeftOutDecidesNoCell) {
  Random random(20);
  std::size_t asked = 0, left_out = 0;
  for (int scene = 0; scene < 120; ++scene) {
    const Tiling tiling = kTilings[scene % 3];
    const int width = random.integer(1, 90), height = random.integer(1, 90);
    const double relief = random.real(5, 40);
    const Image<float> map = hills(width, height, relief, random);
    const Sun sun{random.chance(0.3) ? 45.0 * random.integer(-8, 8) : random.real(-400, 400),
                  random.real(1, 20)};
    const auto [low, high] = std::ranges::minmax_element(map.pixels());
    if (!(*low < *high)) continue;
    const Sweep sweep = plan(map, sun, tiling);
    for (int x = 0; x < sweep.columns; ++x)
      for (int row = 0; row < sweep.rows; ++row) {
        std::int64_t band = row - sweep.column[static_cast<std::size_t>(x)].begin_row;
        band = sweep.cyclic ? tiled(band, sweep.rows, Tiling::repeat) : band - sweep.first_band;
        ASSERT_LT(band, sweep.bands);
        const int reach = sweep.reach[static_cast<std::size_t>(band / kReachBands)];
        const std::size_t end = sweep.step_at(reach * kSweepBlock - x);
        std::vector<RayStep> near(sweep.ray.begin(),
                                  sweep.ray.begin() + static_cast<std::ptrdiff_t>(end));
        asked += sweep.ray.size();
        left_out += sweep.ray.size() - end;
        const int along = sweep.flipped ? sweep.columns - 1 - x : x;
        const auto [cx, cy] = sweep.along_x ? std::pair(along, row) : std::pair(row, along);
        ASSERT_EQ(in_shadow(sweep.map, near, cx, cy), in_shadow(sweep.map, sweep.ray, cx, cy))
            << "scene " << scene << " cell " << cx << ", " << cy << " azimuth " << sun.azimuth_deg
            << " elevation " << sun.elevation_deg << " tiling " << static_cast<int>(tiling);
      }
  }
  EXPECT_GT(left_out, asked / 20) << "too little to test it";
}

/// A wall in each copy of the map hides the copies behind it, except at a gap.
TEST(ShadowReach, EndsBehindAWallThatHidesAllOthers) {
  Image<float> map(256, 256);
  for (int y = 0; y < 256; ++y)
    for (int x = 32; x < 64; ++x) map(x, y) = y >= 100 && y < 110 ? 0.0F : 10.0F;
  const Sun sun{90, std::atan(10.0 / 1100) * 45 / std::atan(1.0)};
  const Sweep sweep = plan(map, sun, Tiling::repeat);
  ASSERT_EQ(sweep.reach.size(), 8U);
  for (std::size_t i = 0; i < 8; ++i) {
    // The wall is in blocks 18 and 19 of columns. At the gap, shadows of 1,100 cells need the
    // wall's last copy in columns 1,312 to 1,343. Rays of bands 64 to 95 touch row 96, whose tile
    // has the gap.
    EXPECT_EQ(sweep.reach[i], i == 2 || i == 3 ? 84 : 20) << i;
  }
}

TEST(ShadowTiles, KernelsGiveTheRanges) {
  Random random(21);
  for (const Isa isa : available_isas()) {
    const auto ranges = shadow_kernels(isa).tile_ranges;
    if (ranges == nullptr) continue;
    for (const int width : {1, 7, 16, 33, 150, 1023, 1040, 2100}) {
      const int rows = random.integer(1, HeightTiles::kEdge);
      Image<float> map(width, rows);
      for (float& h : map.pixels()) h = static_cast<float>(random.real(-50, 90));
      HeightTiles expected = tiles_of(map), got = expected;
      std::ranges::fill(got.lowest, -7.0F);
      std::ranges::fill(got.highest, 7.0F);
      const auto find = [&] {
        return ranges(map.view().data, width, rows, static_cast<std::size_t>(width),
                      got.lowest.data(), got.highest.data());
      };
      EXPECT_TRUE(find());
      EXPECT_EQ(got.lowest, expected.lowest) << name(isa) << " " << width << "x" << rows;
      EXPECT_EQ(got.highest, expected.highest) << name(isa) << " " << width << "x" << rows;
      for (const float odd :
           {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
            -std::numeric_limits<float>::infinity()}) {
        float& cell = map(random.integer(0, width - 1), random.integer(0, rows - 1));
        const float kept = std::exchange(cell, odd);
        EXPECT_FALSE(find()) << name(isa) << " " << odd << " " << width << "x" << rows;
        cell = kept;
      }
    }
  }
}

}  // namespace
}  // namespace rastrum::terrain::shadow_reach_test
