// SPDX-License-Identifier: BSD-3-Clause
// Checks by hand the estimated costs of a terrain frame, and which frames are worth a GPU.
#include <rastrum/terrain/device_work.hpp>

#include <gtest/gtest.h>

#include <rastrum/family.hpp>
#include <rastrum/terrain/added_method.hpp>
#include <rastrum/terrain/setup.hpp>

#include "tests/support/painter.hpp"

namespace rastrum::terrain::device_work_test {
namespace {

using test::TerrainLook;

Terrain flat(int edge) {
  return Terrain(HeightMap{Image<float>(edge, edge), Image<Rgba8>(edge, edge)});
}

FrameWork work(const Terrain& map, const TerrainLook& options) {
  Image<Rgba8> picture(options.width, options.height);
  return device_work(map, options, {.color8 = picture.view()});
}

TEST(TerrainDeviceWork, CountsImagesAndAShareOfTheMap) {
  const Terrain map = flat(64);
  TerrainLook options({.width = 100, .height = 50, .distance = 200});
  const std::uint64_t share = 64 * 64 * (4 + 4) / 16;
  EXPECT_EQ(work(map, options).bytes, share + 100 * 50 * 4);
  Image<float> depth(100, 50);
  EXPECT_EQ(device_work(map, options, {.depth = depth.view()}).bytes, share + 100 * 50 * 4);
  const auto slices = static_cast<std::uint64_t>(100 * slice_count(options));
  EXPECT_NE(work(map, options).what.find(std::to_string(slices)), std::string::npos);
}

TEST(TerrainDeviceWork, PicturesThatComeBackAreTheThreadsAndWordsTheDevices) {
  const Terrain map = flat(256);
  TerrainLook options({.width = 320, .height = 200});
  const auto worth = [&](int threads) {
    return estimate(work(map, options), threads).is_worth_it();
  };
  EXPECT_FALSE(worth(4));
  options.width = 3840;
  options.height = 2160;
  options.distance = 2000;
  EXPECT_TRUE(worth(1));
  EXPECT_FALSE(worth(16));
  FrameWork by_words = work(map, options);
  family::terrain_words().weigh(by_words);
  EXPECT_TRUE(estimate(by_words, 16).is_worth_it());
  // A map that takes longer to copy than to draw.
  options = {};
  options.width = 640;
  options.height = 360;
  EXPECT_TRUE(estimate(work(flat(64), options), 1).is_worth_it());
  EXPECT_FALSE(estimate(work(flat(2048), options), 1).is_worth_it());
}

}  // namespace
}  // namespace rastrum::terrain::device_work_test
