// SPDX-License-Identifier: BSD-3-Clause
// A terrain's picture, differences between two, and random cases.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <random>
#include <span>

#include <gtest/gtest.h>

#include "tests/support/painter.hpp"
#include "tests/terrain/maps.hpp"

namespace rastrum::test {

struct TerrainPicture {
  Image<Rgba8> colors;
  Image<float> depth;
  terrain::TerrainStats stats;

  TerrainPicture(TerrainPainter& painter, const terrain::Terrain& terrain,
                 const terrain::TerrainCamera& camera, bool has_depth = true)
      : colors(painter.options().width, painter.options().height),
        depth(colors.width(), colors.height()) {
    stats = painter.render(terrain, camera,
                           {colors.view(), has_depth ? depth.view() : ImageView<float>{}});
  }
  TerrainPicture(const terrain::Terrain& terrain, const terrain::TerrainCamera& camera,
                 const TerrainLook& look)
      : TerrainPicture(*std::make_unique<TerrainPainter>(look), terrain, camera) {}
  [[nodiscard]] bool is_sky(int x, int y) const {
    return depth(x, y) == std::numeric_limits<float>::infinity();
  }
};

[[nodiscard]] inline testing::AssertionResult same_picture(const TerrainPicture& a,
                                                           const TerrainPicture& b) {
  const auto differs = [](const char* what) { return testing::AssertionFailure() << what; };
  if (!std::ranges::equal(a.colors.pixels(), b.colors.pixels())) return differs("colours");
  if (!std::ranges::equal(a.depth.pixels(), b.depth.pixels())) return differs("depth");
  if (a.stats.visible != b.stats.visible) return differs("visible");
  if (a.stats.slices != b.stats.slices) return differs("slices");
  return testing::AssertionSuccess();
}

struct TerrainCase {
  terrain::HeightMap map;
  TerrainLook look;
  terrain::TerrainCamera camera;
};

/// The i-th case of a test: a map of one of `sizes`, with or without holes, with any filter, tiling
/// and projection, some from far away, rolled, or in fog.
[[nodiscard]] inline TerrainCase random_case(std::mt19937& random, int i,
                                             std::span<const int[2]> sizes, double farthest) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto& size = sizes[random() % sizes.size()];
  TerrainCase c{random_map(size[0], size[1], random, between(0, 0.5)), {}, {}};
  const auto heights = c.map.heights.pixels();
  if (i % 5 == 1) c.map.colors = random_map(37, 91, random).colors;
  if (i % 5 == 2)
    for (float& h : heights) h -= 200;
  if (i % 6 == 1)
    for (int k = 0; k < 20; ++k)
      heights[random() % heights.size()] = std::numeric_limits<float>::quiet_NaN();
  c.look = TerrainLook({.width = 1 + static_cast<int>(random() % 150),
                        .height = 1 + static_cast<int>(random() % 90),
                        .distance = between(1, i % 13 == 0 ? farthest : 400),
                        .filter = static_cast<terrain::MapFilter>(i % 3),
                        .tiling = static_cast<terrain::Tiling>(i / 3 % 4),
                        .projection = static_cast<terrain::Projection>(i / 9 % 2)});
  const bool planar = c.look.projection == terrain::Projection::planar;
  c.look.fov_rad = between(0.3, planar ? 2.5 : 6.28);
  c.look.dz = i % 4 == 0 ? 0.1 : 0.005;
  if (i % 2 == 1) c.look.step = 0;
  c.look.scale_px = i % 3 == 0 ? 240 : 0;
  if (i % 4 == 1) c.look.fog = {between(0, 0.02), between(0, 50), {}};
  const double far = i % 7 == 0 ? 1e9 : 500;
  c.camera.x = between(-far, far);
  c.camera.y = between(-far, far);
  c.camera.altitude = i % 11 == 0 ? between(-1e6, 1e6) : between(-250, 400);
  c.camera.angle_rad = between(-7, 7);
  c.camera.horizon_px = between(-50, 100);
  c.camera.roll_rad = i % 10 == 9 ? between(-7, 7) : 0;
  return c;
}

}  // namespace rastrum::test
