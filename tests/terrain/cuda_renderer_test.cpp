// SPDX-License-Identifier: BSD-3-Clause
// The terrain renderer with Device::cuda. Here Thrust's C++ system makes the CPU the device
// (parallel/cuda/system.cuh), so all that kernels compute is compared with the serial reference,
// bit for bit, without a GPU. As cuda_terrain_test the same tests run on one.
#include <algorithm>
#include <limits>
#include <random>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <rastrum/family.hpp>
#include <rastrum/parallel/cuda/status.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain_light.hpp>

#include "tests/support/refused.hpp"
#include "tests/terrain/cuda_device.hpp"
#include "tests/terrain/picture.hpp"

namespace rastrum::terrain::cuda_renderer_test {
namespace {

using test::TerrainLook;
using test::TerrainPainter;
using Picture = test::TerrainPicture;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// The device's methods against the serial reference.
void expect_same_on_device(const Terrain& terrain, const TerrainCamera& camera, TerrainLook options,
                           const std::string& what) {
  options.device = Device::serial;
  options.added = nullptr;
  const Picture expected(terrain, camera, options);
  options.device = Device::cuda;
  for (const AddedMethod* added :
       {static_cast<const AddedMethod*>(nullptr), &family::terrain_words()}) {
    options.added = added;
    const Picture got(terrain, camera, options);
    EXPECT_EQ(got.stats.device, Device::cuda);
    EXPECT_TRUE(same_picture(expected, got)) << what << (added == nullptr ? ", fast" : ", words");
    if (options.classic) break;
  }
}

class CudaTerrain : public test::TerrainOnDevice {};

TEST_F(CudaTerrain, RandomMapsAreTheReferencesBits) {
  std::mt19937 random(71);
  const int sizes[][2] = {{64, 64}, {100, 60}, {1, 1}, {1, 37}, {53, 1}, {129, 65}, {300, 200}};
  for (int i = 0; i < 180; ++i) {
    auto [map, options, camera] = test::random_case(random, i, sizes, 9000);
    expect_same_on_device(Terrain(std::move(map)), camera, options, "case " + std::to_string(i));
    if (HasFailure()) return;
  }
}

TEST_F(CudaTerrain, ARealMapIsTheReferencesBits) {
  auto heights = test::saint_helens();
  if (!heights) GTEST_SKIP() << test::kNoRealMap;
  const Terrain terrain(HeightMap{std::move(*heights), {}});
  TerrainLook options({.width = 333, .height = 190, .distance = 1500, .tiling = Tiling::clamp});
  for (const MapFilter filter : {MapFilter::none, MapFilter::bilinear, MapFilter::mip}) {
    options.filter = filter;
    expect_same_on_device(terrain, {.x = 200, .y = 420, .altitude = 130, .horizon_px = 40}, options,
                          "filter " + std::to_string(static_cast<int>(filter)));
  }
}

TEST_F(CudaTerrain, TheClassicPictureIsTheOriginals) {
  std::mt19937 random(72);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const int sizes[][2] = {{64, 64}, {100, 60}, {1, 1}, {1, 37}, {256, 256}};
  for (int i = 0; i < 80; ++i) {
    const auto& size = sizes[random() % 5];
    HeightMap map = test::random_map(size[0], size[1], random, between(0, 0.5));
    if (i % 5 == 1) map.colors = test::random_map(37, 91, random).colors;
    if (i % 6 == 1) map.heights.pixels()[random() % map.heights.pixels().size()] = kNaN;
    TerrainLook options({.classic = true});
    options.width = 1 + static_cast<int>(random() % 150);
    options.height = 1 + static_cast<int>(random() % 90);
    options.distance = between(1, i % 13 == 0 ? 9000 : 800);
    options.tiling = static_cast<Tiling>(i % 3);
    TerrainCamera camera;
    const double far = i % 7 == 0 ? 1e9 : 500;
    camera.x = between(-far, far);
    camera.y = between(-far, far);
    camera.altitude = between(-50, 400);
    camera.angle_rad = between(-7, 7);
    camera.horizon_px = between(-50, 100);
    expect_same_on_device(Terrain(std::move(map)), camera, options, "case " + std::to_string(i));
    if (HasFailure()) return;
  }
}

// The walk skips what maxima hide, or the device would be slower than the CPU.
TEST_F(CudaTerrain, LeavesOutWhatIsHidden) {
  std::mt19937 random(3);
  const Terrain hills(test::random_map(1024, 1024, random, 0.1));
  TerrainLook options({.width = 160, .height = 100, .distance = 2000}, {.device = Device::cuda});
  const TerrainCamera low{.x = 300, .y = 500, .altitude = 200, .horizon_px = 40};
  const Picture picture(hills, low, options);
  EXPECT_GT(picture.stats.samples, picture.stats.visible);
  EXPECT_LT(picture.stats.samples, 160 * picture.stats.slices / 2);
}

TEST_F(CudaTerrain, TargetsMayHaveGapsOrBeLeftOut) {
  std::mt19937 random(4);
  const Terrain terrain(test::random_map(50, 70, random));
  TerrainLook options({.width = 61, .height = 40}, {.device = Device::serial});
  const TerrainCamera camera{.altitude = 300, .horizon_px = 5};
  const Picture expected(terrain, camera, options);
  options.device = Device::cuda;
  TerrainPainter renderer(options);
  Image<Rgba8> wide(80, 41);
  for (Rgba8& p : wide.pixels()) p = {1, 2, 3, 4};
  const ImageView<Rgba8> part{wide.view().data + 5, 61, 40, 80};
  renderer.render(terrain, camera, {part, {}});
  Image<float> depth(61, 40);
  renderer.render(terrain, camera, {.depth = depth.view()});
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 80; ++x) {
      const bool inside = x >= 5 && x < 66 && y < 40;
      EXPECT_EQ(wide(x, y), inside ? expected.colors(x - 5, y) : (Rgba8{1, 2, 3, 4}));
      if (inside) {
        EXPECT_EQ(depth(x - 5, y), expected.depth(x - 5, y));
      }
    }
  EXPECT_EQ(renderer.render(terrain, camera, {}).visible, expected.stats.visible);
}

TEST_F(CudaTerrain, AFrameLikeTheOneBeforeAllocatesNothingAndCopiesNoMap) {
  std::mt19937 random(5);
  const Terrain a(test::random_map(256, 200, random)), b(test::random_map(256, 200, random));
  TerrainLook options({.width = 200, .height = 100}, {.device = Device::cuda});
  TerrainPainter renderer(options);
  Image<Rgba8> colors(200, 100);
  const TerrainCamera camera{.altitude = 300, .horizon_px = 10};
  const std::uint64_t bytes = renderer.render(a, camera, {.color8 = colors.view()}).device_bytes;
  EXPECT_GT(bytes, 8U * 256 * 200);
  EXPECT_LT(bytes, 12U * 256 * 200 + (1U << 18));
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(renderer.render(a, camera, {.color8 = colors.view()}).device_bytes, bytes);
  // Another map of that size replaces it, and other colours appear.
  const auto first = colors;
  EXPECT_LE(renderer.render(b, camera, {.color8 = colors.view()}).device_bytes, bytes + 256 * 200);
  options.device = Device::serial;
  EXPECT_TRUE(std::ranges::equal(colors.pixels(), Picture(b, camera, options).colors.pixels()));
  renderer.render(a.with_colors(*b.colors()), camera, {.color8 = colors.view()});
  EXPECT_TRUE(std::ranges::equal(
      colors.pixels(), Picture(a.with_colors(*b.colors()), camera, options).colors.pixels()));
  EXPECT_FALSE(std::ranges::equal(colors.pixels(), first.pixels()));
}

TEST_F(CudaTerrain, NamedFunctionsAreTheReferencesBits) {
  int i = 0;
  for (const FunctionInfo& info : named_functions())
    for (const Shadows shadows :
         {Shadows::none, Shadows::accumulated, Shadows::sharp, Shadows::soft}) {
      Light light{.sun = {70.0 + 40 * i, 12},
                  .shadows = shadows,
                  .hill_shading = i % 3 != 0,
                  .march = {60, 70 + i}};
      TerrainLook options({.width = 57 + i,
                           .height = 40,
                           .distance = 300,
                           .dz = 0.02,
                           .projection = static_cast<Projection>(i % 2)});
      if (i % 4 == 1) options.fog = {0.004, 20, {}};
      const TerrainCamera camera{.x = 1e6 * (i % 5) + 470,
                                 .y = 380.0 - 97 * i,
                                 .altitude = 160,
                                 .angle_rad = i * 0.7,
                                 .horizon_px = 12,
                                 .roll_rad = i % 5 == 4 ? 0.4 : 0};
      expect_same_on_device(
          function_terrain(named_function(info.name), info.low, info.high, light), camera, options,
          std::string(info.name).append(" ").append(std::to_string(static_cast<int>(shadows))));
      if (HasFailure()) return;
      ++i;
    }
}

TEST_F(CudaTerrain, OtherFunctionsGoToTheCpuAndTheStatisticsSayWhy) {
  const auto why = [](const Terrain& terrain, bool classic) {
    TerrainLook options({.width = 80, .height = 60, .classic = classic}, {.device = Device::cuda});
    const Picture picture(terrain, {.altitude = 100}, options);
    EXPECT_EQ(picture.stats.device, Device::threads);
    options.device = Device::serial;
    EXPECT_TRUE(same_picture(Picture(terrain, {.altitude = 100}, options), picture)) << "functions";
    return picture.stats.device_why;
  };
  const HeightFunction own = [](const double* x, const double*, std::size_t n, float* out) {
    for (std::size_t i = 0; i < n; ++i) out[i] = x[i] > 20 ? 40.0F : 0.0F;
  };
  EXPECT_TRUE(test::holds(why(function_terrain(own, 0, 80, {}), false), "caller's"));
  const auto flat = [](double, double) { return 3.0F; };
  const auto grey = [](double, double) { return Rgba8{9, 9, 9, 255}; };
  EXPECT_TRUE(test::holds(why(Terrain::of(flat, grey), false), "caller's"));
  const Terrain waves = function_terrain(named_function("wavy"), 0, 80, {});
  EXPECT_TRUE(test::holds(why(waves, true), "classic"));
}

TEST_F(CudaTerrain, RolledPicturesOfOneKindAreTheReferences) {
  std::mt19937 random(9);
  const Terrain terrain(test::random_map(50, 70, random));
  TerrainLook options({.width = 80, .height = 60});
  const TerrainCamera camera{.altitude = 90, .horizon_px = 20, .roll_rad = 1};
  options.device = Device::serial;
  const Picture expected(terrain, camera, options);
  options.device = Device::cuda;
  TerrainPainter renderer(options);
  Image<Rgba8> colors(80, 60);
  Image<float> depth(80, 60);
  const TerrainStats stats = renderer.render(terrain, camera, {.color8 = colors});
  EXPECT_EQ(stats.device, Device::cuda);
  EXPECT_EQ(stats.device_why, "");
  static_cast<void>(renderer.render(terrain, camera, {.depth = depth.view()}));
  EXPECT_TRUE(std::ranges::equal(colors.pixels(), expected.colors.pixels()));
  EXPECT_TRUE(std::ranges::equal(depth.pixels(), expected.depth.pixels()));
}

TEST_F(CudaTerrain, AutoLeavesToTheThreadsWhatTheyDrawSooner) {
  std::mt19937 random(10);
  const Terrain terrain(test::random_map(50, 70, random));
  TerrainLook options({.width = 80, .height = 60}, {.device = Device::automatic, .threads = 1});
  const Picture small(terrain, {}, options);
  EXPECT_EQ(small.stats.device, Device::threads);
  EXPECT_EQ(small.stats.device_bytes, 0U);
  EXPECT_EQ(small.stats.device_why.find("there is a "), 0U) << small.stats.device_why;
  EXPECT_TRUE(test::holds(small.stats.device_why, ", but 80x60 pixels"));
  options.added = &family::terrain_words();
  options.width = 640;
  options.height = 200;
  const Picture large(terrain, {}, options);
  EXPECT_EQ(large.stats.device, Device::cuda);
  EXPECT_TRUE(test::holds(large.stats.device_why, "; 640x200 pixels"));
  options.device = Device::serial;
  EXPECT_TRUE(same_picture(Picture(terrain, {}, options), large)) << "large";
}

TEST_F(CudaTerrain, AMapThatIsTooLargeIsRefusedByNameAndAutoGoesToTheCpu) {
  std::mt19937 random(6);
  const Terrain terrain(test::random_map(1024, 512, random));
  TerrainLook options({.width = 80, .height = 60});
  if (!set_free_bytes(std::uint64_t{3} << 20)) GTEST_SKIP() << "a GPU has what it has";
  options.device = Device::cuda;
  const std::string said =
      test::refusal_of([&] { const Picture picture(terrain, {}, options); }, Errc::out_of_memory);
  for (const char* part : {"1024x512", "80x60", "3 MiB are free", "--device threads"})
    EXPECT_TRUE(test::holds(said, part));
  options.device = Device::automatic;
  const Picture picture(terrain, {}, options);
  EXPECT_EQ(picture.stats.device, Device::threads);
  EXPECT_TRUE(test::holds(picture.stats.device_why, "1024x512"));
  options.device = Device::serial;
  EXPECT_TRUE(same_picture(Picture(terrain, {}, options), picture)) << "on threads";
}

}  // namespace
}  // namespace rastrum::terrain::cuda_renderer_test
