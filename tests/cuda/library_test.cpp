// SPDX-License-Identifier: BSD-3-Clause
// The library of device code as programs use it: a file that is opened by name
// (parallel/cuda/library.hpp). Only its device is the CPU instead of a GPU.
#include <dlfcn.h>

#include <algorithm>
#include <stop_token>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/parallel/cuda/library.hpp>
#include <rastrum/program.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/stop.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain_light.hpp>

#include "tests/support/device_frames.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test {
namespace {

using parallel::kCudaLibraryFile;

constexpr int kSize = 96;

TEST(CudaLibrary, IsFoundByItsNameAndShowsOneFunction) {
  const parallel::CudaStatus status = parallel::cuda_status();
  ASSERT_TRUE(status.usable) << status.why_not;
  EXPECT_EQ(status.name, "CPU in a library of its own");
  EXPECT_EQ(parallel::cuda_library().status().name, status.name);
  void* const file = ::dlopen(kCudaLibraryFile, RTLD_NOW | RTLD_NOLOAD);
  ASSERT_NE(file, nullptr);
  EXPECT_NE(::dlsym(file, parallel::kCudaLibrarySymbol), nullptr);
  // rastrum::parallel::cuda_status(); the library has its own copy.
  EXPECT_EQ(::dlsym(file, "_ZN7rastrum8parallel11cuda_statusEv"), nullptr);
  ::dlclose(file);
}

TEST(CudaLibrary, OfAnotherBuildIsRefused) {
  const parallel::OpenedCudaLibrary other = parallel::open_cuda_library(RASTRUM_OTHER_LIBRARY);
  EXPECT_EQ(other.library, nullptr);
  EXPECT_TRUE(holds(other.why_not, "belongs to Rastrum 0.0.1-of-another, but this program to "));
}

TEST(CudaLibrary, DrawsByItsRasterizersAndTheRows) {
  const GeneratedScene g = generate(3, kSize, kSize);
  Painter threads(device_options(kSize, kSize, Device::threads));
  const Frame expected = draw(threads, g.view(), g.camera);
  for (const char* rasterizer : {"auto", "by-size", "tiled", "binned"}) {
    RenderOptions o = device_options(kSize, kSize, Device::cuda);
    o.rasterizer = rasterizer;
    Painter cuda(o);
    const Frame frame = draw(cuda, g.view(), g.camera);
    expect_by_device(frame, expected);
    EXPECT_TRUE(holds(frame.stats.why, "shaded on the device"));
    EXPECT_GT(frame.stats.peak_bytes, 0U);  // counted in the program's account
  }
}

TEST(CudaLibrary, BlendsLayers) {
  const GeneratedScene g = generate(5, kSize, kSize);
  RenderOptions o = device_options(kSize, kSize, Device::threads);
  o.opacity = 0.4F;
  Painter threads(o), cuda(by(o, Device::cuda));
  expect_by_device(take(cuda, g.view(), g.camera), take(threads, g.view(), g.camera));
}

TEST(CudaLibrary, ItsErrorsAreTheProgramsErrors) {
  Scene scene = single(shapes::sphere(16, 32));
  scene.meshes[0].indices[7] = 1U << 30;
  Painter cuda(device_options(kSize, kSize, Device::cuda));
  expect_refused("",
                 [&] { (void)draw(cuda, SceneBinding(scene).view(), pixel_camera(kSize, kSize)); });
}

// A token is in force for a thread, and the library has its own thread-local variables.
TEST(CudaLibrary, AStopReachesIt) {
  std::stop_source source;
  const Program program(
      [&](std::uint32_t v) {
        source.request_stop();
        const auto x = static_cast<float>(v % 3) - 1, y = static_cast<float>(v % 2);
        return VertexOutput<Vec4>{{x, y, 0.5F, 1}, {x, y, 0, 1}};
      },
      [](const Vec4& v, const Fragment&) { return v; });
  std::vector<raster::Draw> draws{program.draw(3)};
  Image<Rgba8> image(kSize, kSize);
  Targets targets{.color8 = image.view()};
  Painter cuda(device_options(kSize, kSize, Device::cuda));
  EXPECT_THROW(cuda.draw(draws, program, nullptr, targets, {}, source.get_token()), Stopped);
  EXPECT_EQ(cuda.draw(draws, program, nullptr, targets).device, Device::cuda);  // still works
}

TEST(CudaLibrary, DrawsTerrainAndItsShadows) {
  Image<float> heights(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) heights(x, y) = static_cast<float>((x * 7 + y * 13) % 29);
  terrain::ShadowOptions shadows;
  const terrain::Sun sun{.azimuth_deg = 40, .elevation_deg = 20};
  const auto of = [&](Device device) {
    shadows.device = device;
    return terrain::sharp_shadows(heights.view(), sun, shadows);
  };
  const auto here = of(Device::threads), there = of(Device::cuda);
  EXPECT_TRUE(std::ranges::equal(here.pixels(), there.pixels()));

  const terrain::Terrain hills(terrain::HeightMap{std::move(heights), {}});
  TerrainLook options({.width = kSize, .height = kSize});
  const terrain::TerrainCamera camera{.x = 10, .y = 10, .altitude = 60};
  const auto picture = [&](Device device) {
    options.device = device;
    Image<Rgba8> image(kSize, kSize);
    terrain::TerrainTargets targets{.color8 = image.view()};
    TerrainPainter renderer(options);
    EXPECT_EQ(renderer.render(hills, camera, targets).device, device);
    return image;
  };
  const Image<Rgba8> threads = picture(Device::threads), cuda = picture(Device::cuda);
  EXPECT_TRUE(std::ranges::equal(threads.pixels(), cuda.pixels()));
}

}  // namespace
}  // namespace rastrum::test
