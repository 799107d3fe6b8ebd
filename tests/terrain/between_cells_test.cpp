// SPDX-License-Identifier: BSD-3-Clause
// Near ground under a sharp shadow: blocky with MapFilter::none, smooth with `bilinear`. Both have
// the same bits by plain code and on every instruction set.
#include <rastrum/terrain.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include <gtest/gtest.h>

#include <rastrum/digest.hpp>
#include <rastrum/parallel/device.hpp>
#include <rastrum/terrain_light.hpp>

#include "tests/support/every_way.hpp"

namespace rastrum::terrain::between_cells_test {
namespace {

constexpr int kWidth = 200, kHeight = 120;

/// A plane with a wall in the east, whose shadow ends at cell 40.
Terrain shaded_plane() {
  HeightMap map{Image<float>(64, 64), Image<Rgba8>(64, 64)};
  for (Rgba8& c : map.colors.pixels()) c = {200, 200, 200, 255};
  for (int y = 0; y < 64; ++y) map.heights(50, y) = 10;
  map.colors = lit_colors(map, {.sun = {90, 45}, .shadows = Shadows::sharp, .ambient = 0.5F},
                          {.tiling = Tiling::clamp});
  return Terrain(std::move(map));
}

Image<Rgba8> picture(const Terrain& terrain, MapFilter filter, TerrainRendererOptions by) {
  TerrainOptions options{.width = kWidth,
                         .height = kHeight,
                         .step = filter == MapFilter::bilinear ? 0.0 : 1.0,
                         .filter = filter,
                         .tiling = Tiling::clamp};
  Image<Rgba8> color(kWidth, kHeight);
  // 3 cells above the plane, with the end of the shadow ahead.
  const TerrainCamera camera{.x = 40, .y = 32, .altitude = 3, .horizon_px = 20};
  TerrainRenderer(by).render(terrain, camera, options, {.color8 = color});
  return color;
}

TEST(BetweenCells, AreShadowsOnNearGround) {
  const Terrain terrain = shaded_plane();
  const Image<Rgba8> cells = picture(terrain, MapFilter::none, {}),
                     between = picture(terrain, MapFilter::bilinear, {});
  // Rows of near ground, where a cell is tens of pixels wide.
  for (int y = kHeight - 20; y < kHeight; ++y) {
    int jump = 0, steps = 0, jump_of_cells = 0;
    for (int x = 1; x < kWidth; ++x) {
      jump = std::max(jump, std::abs(between(x, y).r - between(x - 1, y).r));
      steps += between(x, y).r != between(x - 1, y).r;
      jump_of_cells = std::max(jump_of_cells, std::abs(cells(x, y).r - cells(x - 1, y).r));
      EXPECT_LE(between(x, y).r, between(x - 1, y).r) << "lit in the west, " << x << ", " << y;
    }
    EXPECT_EQ(jump_of_cells, 100) << y;
    EXPECT_LE(jump, 10) << y;
    EXPECT_GE(steps, 15) << y;
    EXPECT_EQ(between(0, y).r, 200) << y;
    EXPECT_EQ(between(kWidth - 1, y).r, 100) << y;
  }
}

TEST(BetweenCells, ArePicturesTheSameBitsWhoeverDraws) {
  const Terrain terrain = shaded_plane();
  for (const MapFilter filter : {MapFilter::none, MapFilter::bilinear}) {
    test::EveryWay().same([&](const RendererOptions& by) {
      return digest(
          picture(terrain, filter, {.device = by.device, .threads = by.threads, .isa = by.isa}));
    });
  }
}

TEST(BetweenCells, AreColoursOfAnySizeTheSameBitsWhoeverDraws) {
  std::uint32_t state = 1;
  const auto random = [&] { return (state = state * 1664525 + 1013904223) >> 8; };
  struct Sizes {
    int width, height, color_width, color_height;
  };
  for (const Sizes& s : {Sizes{64, 64, 64, 64}, Sizes{64, 32, 128, 64}, Sizes{50, 37, 50, 37},
                         Sizes{50, 37, 111, 90}, Sizes{64, 64, 20, 70}})
    for (const Tiling tiling : {Tiling::repeat, Tiling::mirror, Tiling::clamp, Tiling::none})
      for (const double fog : {0.0, 0.01}) {
        HeightMap map{Image<float>(s.width, s.height), Image<Rgba8>(s.color_width, s.color_height)};
        for (float& h : map.heights.pixels()) h = static_cast<float>(random() % 1000) / 100;
        const auto byte = [&] { return static_cast<std::uint8_t>(random()); };
        for (Rgba8& c : map.colors.pixels()) c = {byte(), byte(), byte(), 255};
        const Terrain terrain(std::move(map));
        TerrainOptions o{
            .width = 101, .height = 70, .step = 0, .filter = MapFilter::bilinear, .tiling = tiling};
        o.fog.density = fog;
        o.distance = 200;
        const TerrainCamera camera{
            .x = -30.3, .y = 77.7, .altitude = 14, .angle_rad = 0.7, .horizon_px = 12};
        SCOPED_TRACE(testing::Message() << "colours " << s.color_width << " x " << s.color_height
                                        << ", tiling " << static_cast<int>(tiling));
        test::EveryWay({{.threads = 2}}).same([&](const RendererOptions& by) {
          Image<Rgba8> drawn(o.width, o.height);
          TerrainRenderer({.device = by.device, .threads = by.threads, .isa = by.isa})
              .render(terrain, camera, o, {.color8 = drawn});
          return digest(drawn);
        });
      }
}

}  // namespace
}  // namespace rastrum::terrain::between_cells_test
