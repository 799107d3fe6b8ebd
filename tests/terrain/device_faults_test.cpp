// SPDX-License-Identifier: BSD-3-Clause
// Refuses each device call of a terrain's frame and shadows once, and expects the next result to be
// right (support/device_faults.hpp).
#include <algorithm>
#include <cstdint>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/family.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain_light.hpp>

#include "tests/support/device_faults.hpp"
#include "tests/terrain/cuda_device.hpp"
#include "tests/terrain/picture.hpp"

namespace rastrum::terrain::device_faults_test {
namespace {

using test::refuse_each_call;
using test::TerrainLook;
using test::TerrainPainter;
using Picture = test::TerrainPicture;

struct Look {
  const char* name;
  const AddedMethod* added;
  MapFilter filter;
  bool classic;
  double roll_rad;
  bool is_function;
};
class TerrainFaults : public test::TerrainOnDevice, public testing::WithParamInterface<Look> {};

constexpr int kWidth = 60, kHeight = 40;

TEST_P(TerrainFaults, EndAFrameAndNoMore) {
  const Look& look = GetParam();
  std::mt19937 random(12);
  const Terrain terrain = look.is_function
                              ? function_terrain(named_function("wavy"), 0, 80,
                                                 {.sun = {70, 12}, .shadows = Shadows::sharp})
                              : Terrain(test::random_map(70, 50, random));
  const TerrainCamera camera{.altitude = 150, .horizon_px = 10, .roll_rad = look.roll_rad};
  TerrainLook options({.width = kWidth,
                       .height = kHeight,
                       .distance = 120,
                       .classic = look.classic,
                       .filter = look.filter},
                      {.device = Device::serial});
  TerrainPainter serial(options);
  const Picture expected(serial, terrain, camera, !look.classic);
  options.device = Device::cuda;
  options.added = look.added;
  const std::uint64_t refused = refuse_each_call(
      [&] { return TerrainPainter(options); },
      [&](TerrainPainter& painter) {
        const Picture picture(painter, terrain, camera, !look.classic);
        EXPECT_EQ(picture.stats.device, Device::cuda) << picture.stats.device_why;
      },
      [&](TerrainPainter& painter) {
        EXPECT_TRUE(same_picture({painter, terrain, camera, !look.classic}, expected));
      });
  EXPECT_GT(refused, 10U);
}
INSTANTIATE_TEST_SUITE_P(
    Looks, TerrainFaults,
    testing::Values(Look{"fast", nullptr, MapFilter::none, false, 0, false},
                    Look{"rolled", nullptr, MapFilter::mip, false, 0.4, false},
                    Look{"words", &family::terrain_words(), MapFilter::bilinear, false, 0, false},
                    Look{"classic", nullptr, MapFilter::none, true, 0, false},
                    Look{"function", nullptr, MapFilter::none, false, 0, true}),
    [](const auto& tested) { return std::string(tested.param.name); });

class ShadowFaults : public test::TerrainOnDevice {};

/// Compares compute(device), of a map on the device, with the serial definition.
template <class F>
void expect_refused_and_right(const F& compute) {
  const auto expected = compute(Device::serial);
  const std::uint64_t refused = refuse_each_call(
      [] { return 0; }, [&](int) { static_cast<void>(compute(Device::cuda)); },
      [&](int) {
        EXPECT_TRUE(std::ranges::equal(compute(Device::cuda).pixels(), expected.pixels()));
      });
  EXPECT_GT(refused, 10U);
}

TEST_F(ShadowFaults, EndAMapAndNoMore) {
  std::mt19937 random(13);
  HeightMap map = test::random_map(24, 10, random, 0.4);
  for (float& h : map.heights.pixels()) h /= 8;
  const auto heights = map.heights.view();
  const Sun sun{40, 20};
  expect_refused_and_right([&](Device device) {
    return sharp_shadows(heights, sun, {Tiling::mirror, device});
  });
  expect_refused_and_right([&](Device device) {
    return soft_light(heights, sun, 2, {Tiling::clamp, device});
  });
  expect_refused_and_right([&](Device device) {
    return hidden_samples(heights, sun, {50, 9}, {Tiling::repeat, device});
  });
}

}  // namespace
}  // namespace rastrum::terrain::device_faults_test
