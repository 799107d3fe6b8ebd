// SPDX-License-Identifier: BSD-3-Clause
// The classic picture against a transcription of the original program that shares no code with the
// library: integer maps, its own tiling, one pixel at a time.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <random>
#include <stop_token>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/io.hpp>
#include <rastrum/stop.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain/blocks.hpp>
#include <rastrum/terrain/ceiling.hpp>

#include "tests/support/directories.hpp"
#include "tests/support/painter.hpp"
#include "tests/terrain/maps.hpp"

namespace rastrum::terrain::classic_test {
namespace {

using test::TerrainLook;
using test::TerrainPainter;

struct Original {
  int map_width, map_height;
  std::vector<std::uint8_t> altitude;
  std::vector<std::uint32_t> color;  ///< 0xAABBGGRR, as Rgba8 lies in memory
};

Original original_of(const HeightMap& map) {
  Original o{map.heights.width(), map.heights.height(), {}, {}};
  for (const float h : map.heights.pixels()) o.altitude.push_back(static_cast<std::uint8_t>(h));
  for (const Rgba8 c : map.colors.pixels())
    o.color.push_back(std::bit_cast<std::uint32_t>(Rgba8{c.r, c.g, c.b, 255}));
  return o;
}

/// The original's rules. The map repeats with its own size.
std::vector<std::uint32_t> original_frame(const Original& map, TerrainCamera camera, int W, int H,
                                          double distance) {
  const auto offset = [&](double x, double y) {
    double row = std::fmod(std::floor(y), map.map_height);
    double col = std::fmod(std::floor(x), map.map_width);
    if (row < 0) row += map.map_height;
    if (col < 0) col += map.map_width;
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(map.map_width) +
           static_cast<std::size_t>(col);
  };
  const double ground = map.altitude[offset(camera.x, camera.y)];
  if (ground + 10 > camera.altitude) camera.altitude = ground + 10;

  std::vector<std::uint32_t> screen(static_cast<std::size_t>(W) * static_cast<std::size_t>(H),
                                    0xFFE09090);
  std::vector<double> hiddeny(static_cast<std::size_t>(W), H);
  const double sinang = std::sin(camera.angle_rad), cosang = std::cos(camera.angle_rad);
  double deltaz = 1;
  double z = 1;
  while (z < distance) {
    double plx = -cosang * z - sinang * z;
    double ply = sinang * z - cosang * z;
    const double prx = cosang * z - sinang * z;
    const double pry = -sinang * z - cosang * z;
    const double dx = (prx - plx) / W;
    const double dy = (pry - ply) / W;
    plx += camera.x;
    ply += camera.y;
    const double invz = 1 / z * 240;
    for (int i = 0; i < W; ++i) {
      const std::size_t at = offset(plx, ply);
      const double h = std::trunc((camera.altitude - map.altitude[at]) * invz + camera.horizon_px);
      double& hidden = hiddeny[static_cast<std::size_t>(i)];
      for (double y = h < 0 ? 0 : h; y < hidden; ++y)
        screen[static_cast<std::size_t>(y) * static_cast<std::size_t>(W) +
               static_cast<std::size_t>(i)] = map.color[at];
      if (h < hidden) hidden = h;
      plx += dx;
      ply += dy;
    }
    deltaz += 0.005;
    z += deltaz;
  }
  return screen;
}

std::size_t differences(const Image<Rgba8>& picture, const std::vector<std::uint32_t>& screen) {
  std::size_t different = 0;
  for (std::size_t i = 0; i < screen.size(); ++i) {
    const Rgba8 c = picture.pixels()[i];
    different += std::bit_cast<std::uint32_t>(c) != screen[i];
  }
  return different;
}

TerrainLook classic(int width, int height, double distance) {
  return TerrainLook({.width = width, .height = height, .distance = distance, .classic = true});
}

/// Compares every way to draw with the transcription.
void expect_original(const HeightMap& map, const TerrainCamera& camera, TerrainLook options,
                     bool all) {
  const std::vector<std::uint32_t> screen =
      original_frame(original_of(map), camera, options.width, options.height, options.distance);
  const Terrain terrain(map);
  const auto compare = [&](const char* name) {
    Image<Rgba8> picture(options.width, options.height);
    TerrainPainter(options).render(terrain, camera, {.color8 = picture.view()});
    EXPECT_EQ(differences(picture, screen), 0U)
        << name << " threads " << options.threads << " camera " << camera.x << ", " << camera.y
        << ", " << camera.altitude << ", " << camera.angle_rad << ", horizon " << camera.horizon_px
        << ", " << options.width << "x" << options.height << ", distance " << options.distance
        << ", map " << map.heights.width() << "x" << map.heights.height();
  };
  if (all) {
    options.device = Device::serial;
    compare("serial");
  }
  options.device = Device::threads;
  for (const int threads : {1, 2, 8}) {
    options.threads = threads;
    for (const Isa isa : available_isas()) {
      if (!all && isa != available_isas().back()) continue;
      options.isa = isa;
      compare(std::string(name(isa)).c_str());
    }
  }
}

TEST(Classic, EqualsTheOriginalOnRandomCamerasAndMaps) {
  std::mt19937 random(3);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const int sizes[][2] = {{1024, 1024}, {64, 64},  {1, 1},    {1, 37},  {53, 1},
                          {100, 60},    {256, 64}, {333, 77}, {31, 512}};
  for (int i = 0; i < 1000; ++i) {
    const auto& size = sizes[i % 100 == 0 ? 0 : 1 + i % 8];
    const HeightMap map = test::random_map(size[0], size[1], random, between(0, 1));
    const double far = i % 7 == 0 ? 1e9 : i % 3 == 0 ? 5000 : 500;
    const TerrainCamera camera{.x = between(-far, far),
                               .y = between(-far, far),
                               .altitude = i % 11 == 0 ? between(-1e6, 1e6) : between(-50, 400),
                               .angle_rad = between(-7, 7),
                               .horizon_px = between(-150, 300)};
    const int width = 1 + static_cast<int>(random() % 200);
    const int height = 1 + static_cast<int>(random() % 120);
    expect_original(map, camera, classic(width, height, between(0, i % 5 == 0 ? 2000 : 300)),
                    i % 4 == 0);
    if (HasFailure()) return;
  }
}

/// The real map, scaled to the classic range, with colours that distinguish neighbours.
TEST(Classic, EqualsTheOriginalOnTheRealMap) {
  const auto file = test::shared_data("terrain/jotunheimen512.bin");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  HeightMap map{io::read_heights(file).heights, Image<Rgba8>(512, 512)};
  ASSERT_EQ(map.heights.width(), 512);
  std::mt19937 random(5);
  for (float& h : map.heights.pixels()) h = std::floor(h / 257);
  for (Rgba8& c : map.colors.pixels()) {
    const auto bits = static_cast<std::uint32_t>(random());
    c = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8),
         static_cast<std::uint8_t>(bits >> 16), 255};
  }
  expect_original(map, {}, classic(800, 450, 800), true);
  expect_original(map, {.x = -77.5, .y = 3000, .angle_rad = 4, .horizon_px = 200},
                  classic(1920, 1080, 2000), false);
}

TEST(Classic, EqualsTheOriginalOnLargePictures) {
  std::mt19937 random(4);
  for (const double rough : {0.02, 0.4}) {
    const HeightMap map = test::random_map(1024, 1024, random, rough);
    for (const double distance : {800.0, 2000.0}) {
      expect_original(map, {}, classic(800, 450, distance), true);
      expect_original(map, {.angle_rad = 2.1}, classic(1920, 1080, distance), false);
    }
  }
}

// The stop comes after a block has its memory and before it samples a slice: only sky is drawn.
TEST(Classic, ABlockEndsSoonWhenStopped) {
  std::mt19937 random(6);
  const Terrain terrain(test::random_map(64, 64, random));
  const TerrainLook options = classic(200, 100, 300);
  const TerrainCamera camera{.altitude = 150, .horizon_px = 20};
  MemoryAccount memory;
  parallel::Threads exec(2, &memory);
  const Ceiling ceiling(terrain.heights());
  const auto draw = [&](const std::function<void()>& begun) {
    BlockPool pool(memory);
    pool.marks = parallel::ScratchPool<BlockMarks>([&] {
      begun();
      return BlockMarks(memory);
    });
    Image<Rgba8> colors(options.width, options.height);
    std::ranges::fill(colors.pixels(), options.sky);
    try {
      draw_classic(exec, available_isas().back(), pool, terrain, ceiling, options, camera,
                   {.color8 = colors.view()});
    } catch (const Stopped&) {
    }
    return std::ranges::count(colors.pixels(), options.sky);
  };
  const std::ptrdiff_t all = options.width * options.height;
  EXPECT_LT(draw([] {}), all / 2);
  std::stop_source source;
  const std::stop_token token = source.get_token();
  const StopScope scope(token);
  EXPECT_EQ(draw([&] { source.request_stop(); }), all);
  EXPECT_TRUE(source.stop_requested()) << "else no block has begun";
}

}  // namespace
}  // namespace rastrum::terrain::classic_test
