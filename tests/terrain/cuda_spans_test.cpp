// SPDX-License-Identifier: BSD-3-Clause
// Frames and shadows of users whose maps and pictures are already on the device, as spans that are
// not copied.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include <rastrum/terrain.hpp>
#include <rastrum/terrain/cuda/draw.cuh>
#include <rastrum/terrain/cuda/shadows.cuh>

#include "tests/terrain/cuda_device.hpp"
#include "tests/terrain/maps.hpp"

#include "tests/support/painter.hpp"

namespace rastrum::terrain::cuda_spans_test {
namespace {

using test::TerrainLook;
using test::TerrainPainter;

class CudaSpans : public test::TerrainOnDevice {};

template <class T>
ImageView<const T> view(const parallel::DeviceBuffer<T>& cells, int width, int height) {
  return {cells.data(), width, height, width};
}

TEST_F(CudaSpans, AreDrawnWhereTheyLie) {
  constexpr int kWidth = 400, kHeight = 300;
  std::mt19937 random(8);
  const HeightMap map = test::random_map(kWidth, kHeight, random, 0.1);
  TerrainLook options({.width = 90, .height = 50});
  const TerrainCamera camera{.x = 3, .y = 9, .altitude = 250, .horizon_px = 10};

  parallel::Cuda owner, exec;
  const auto heights = parallel::to_device(owner, map.heights.pixels());
  const auto colors = parallel::to_device(owner, map.colors.pixels());
  auto pixels = parallel::make_buffer<Rgba8>(owner, 90 * 50);
  owner.wait();  // memory of one stream, used by another
  const DeviceMap on_device(exec, {view(heights, kWidth, kHeight), view(colors, kWidth, kHeight)},
                            false);
  EXPECT_LT(exec.memory()->held(), map.heights.pixels().size_bytes() / 16);
  const Counts counts =
      draw_frame(exec, on_device, options, camera, {{pixels.data(), 90, 50, 90}, {}});
  options.device = Device::serial;
  Image<Rgba8> expected(90, 50);
  const TerrainStats stats =
      TerrainPainter(options).render(Terrain(map), camera, {.color8 = expected.view()});
  EXPECT_EQ(counts.visible, stats.visible);
  EXPECT_TRUE(std::ranges::equal(parallel::to_host(owner, pixels), expected.pixels()));

  const Sun sun{77, 9};
  EXPECT_TRUE(std::ranges::equal(
      parallel::to_host(exec,
                        sharp_shadows(exec, view(heights, kWidth, kHeight), sun, Tiling::mirror)),
      sharp_shadows(map.heights.view(), sun, {Tiling::mirror, Device::serial}).pixels()));
}

TEST_F(CudaSpans, WithoutCellsOrWithGapsAreRefused) {
  parallel::Cuda exec;
  const auto heights = parallel::make_buffer<float>(exec, 100);
  const auto colors = parallel::make_buffer<Rgba8>(exec, 100);
  EXPECT_THROW(DeviceMap(exec, {{}, view(colors, 10, 10)}, false), Error);
  EXPECT_THROW(DeviceMap(exec, {view(heights, 10, 10), {colors.data(), 5, 10, 10}}, false), Error);
}

}  // namespace
}  // namespace rastrum::terrain::cuda_spans_test
