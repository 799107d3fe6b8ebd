// SPDX-License-Identifier: BSD-3-Clause
// Shadows on a device against the serial definitions, bit for bit. Without a GPU the device is the
// CPU (cuda_device.hpp).
#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/terrain_light.hpp>

#include "tests/terrain/cuda_device.hpp"
#include "tests/terrain/maps.hpp"

namespace rastrum::terrain::cuda_shadow_test {
namespace {

class CudaShadows : public test::TerrainOnDevice {};

std::size_t expect_same(ImageView<const float> heights, const Sun& sun, Tiling tiling,
                        const std::string& what) {
  const auto expected = sharp_shadows(heights, sun, {tiling, Device::serial});
  const auto got = sharp_shadows(heights, sun, {tiling, Device::cuda});
  EXPECT_TRUE(std::ranges::equal(expected.pixels(), got.pixels())) << what;
  return static_cast<std::size_t>(std::ranges::count(expected.pixels(), 1));
}

TEST_F(CudaShadows, SharpOnesOfRandomMapsAreTheDefinitionsBits) {
  std::mt19937 random(31);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const int sizes[][2] = {{64, 64}, {100, 60}, {1, 1}, {1, 37}, {53, 1}, {129, 65}};
  std::size_t dark = 0;
  for (int i = 0; i < 150; ++i) {
    const auto& size = sizes[random() % 6];
    HeightMap map = test::random_map(size[0], size[1], random, between(0, 0.6));
    for (float& h : map.heights.pixels()) h = h / 8 - 20;
    if (i % 4 == 1)
      for (int k = 0; k < 9; ++k)
        map.heights.pixels()[random() % map.heights.pixels().size()] = k % 2 == 0 ? NAN : INFINITY;
    const double azimuth = i % 3 == 0 ? 45.0 * static_cast<double>(random() % 9) : between(-9, 400);
    const Sun sun{azimuth, i % 10 == 0 ? between(0.001, 2) : between(1, 60)};
    dark += expect_same(map.heights.view(), sun, static_cast<Tiling>(i % 3),
                        "case " + std::to_string(i));
    if (HasFailure()) return;
  }
  EXPECT_GT(dark, 10000U);
}

TEST_F(CudaShadows, SharpOnesOfARealMapAreTheDefinitionsBits) {
  const auto heights = test::saint_helens();
  if (!heights) GTEST_SKIP() << test::kNoRealMap;
  for (const auto& [azimuth, elevation] :
       {std::pair(90.0, 10.0), std::pair(225.0, 10.0), std::pair(101.5, 3.0)})
    EXPECT_GT(expect_same(heights->view(), {azimuth, elevation}, Tiling::clamp, "real"), 10U);
}

TEST_F(CudaShadows, FlatMapsHolesAndNightAreAsDefined) {
  Image<float> flat(30, 30), holes(20, 20), rough(40, 40);
  std::ranges::fill(holes.pixels(), NAN);
  for (std::size_t i = 0; i < rough.pixels().size(); ++i)
    rough.pixels()[i] = static_cast<float>(i * 7919 % 13);
  rough(3, 3) = NAN;
  for (const Image<float>* map : {&flat, &holes, &rough})
    for (const double elevation : {-30.0, 0.0, 1e-9, 10.0, 90.0})
      expect_same(map->view(), {10, elevation}, Tiling::repeat, std::to_string(elevation));
  EXPECT_THROW((void)sharp_shadows(flat.view(), {NAN, 40}, {Tiling::repeat, Device::cuda}), Error);
}

TEST_F(CudaShadows, SoftOnesAreTheMeansOfTheDefinitions) {
  std::mt19937 random(33);
  std::size_t partial = 0;
  for (int i = 0; i < 12; ++i) {
    HeightMap map = test::random_map(40 + 9 * i, 57, random, 0.4);
    for (float& h : map.heights.pixels()) h = h / 6 - 20;
    if (i % 3 == 1) map.heights.pixels()[static_cast<std::size_t>(70 * i)] = NAN;
    // From a sun that the horizon cuts to one around the zenith.
    const Sun sun{31.0 * i, 0.1 + i * 8.1};
    const Tiling tiling = static_cast<Tiling>(i % 3);
    const auto expected = soft_light(map.heights.view(), sun, 3, {tiling, Device::serial});
    const auto got = soft_light(map.heights.view(), sun, 3, {tiling, Device::cuda});
    EXPECT_TRUE(std::ranges::equal(expected.pixels(), got.pixels())) << "case " << i;
    for (const std::uint8_t v : got.pixels()) partial += v > 0 && v < 255 ? 1 : 0;
  }
  EXPECT_GT(partial, 3000U);
}

TEST_F(CudaShadows, CountsOfHiddenSamplesAreTheDefinitions) {
  std::mt19937 random(32);
  std::uint64_t hidden = 0;
  for (int i = 0; i < 30; ++i) {
    HeightMap map = test::random_map(1 + static_cast<int>(random() % 90),
                                     1 + static_cast<int>(random() % 90), random, 0.2);
    if (i % 3 == 0) map.heights.pixels()[random() % map.heights.pixels().size()] = NAN;
    const Sun sun{static_cast<double>(random() % 360), static_cast<double>(random() % 70) - 5};
    const March march{10.0 + static_cast<double>(random() % 500),
                      2 + static_cast<int>(random() % 99)};
    const auto tiling = static_cast<Tiling>(i % 3);
    // A view with gaps between its rows.
    const ImageView<const float> part{map.heights.view().data, (map.heights.width() + 1) / 2,
                                      map.heights.height(), map.heights.width()};
    const auto expected = hidden_samples(part, sun, march, {tiling, Device::serial});
    const auto got = hidden_samples(part, sun, march, {tiling, Device::cuda});
    EXPECT_TRUE(std::ranges::equal(expected.pixels(), got.pixels())) << i;
    for (const std::uint16_t n : expected.pixels()) hidden += n;
  }
  EXPECT_GT(hidden, 10000U);
  Image<float> flat(3, 3);
  EXPECT_THROW((void)hidden_samples(flat.view(), {}, {0, 5}, {Tiling::repeat, Device::cuda}),
               Error);
}

TEST_F(CudaShadows, LightIsTheSameOnTheDevice) {
  std::mt19937 random(33);
  const HeightMap map = test::random_map(70, 50, random, 0.1);
  for (const Shadows shadows : {Shadows::accumulated, Shadows::sharp, Shadows::soft}) {
    const Light light{{300, 20}, shadows, true};
    const auto expected = lit_colors(map, light, {Tiling::mirror, Device::serial});
    for (const Device device : {Device::cuda, Device::automatic})
      EXPECT_TRUE(std::ranges::equal(expected.pixels(),
                                     lit_colors(map, light, {Tiling::mirror, device}).pixels()));
  }
}

}  // namespace
}  // namespace rastrum::terrain::cuda_shadow_test
