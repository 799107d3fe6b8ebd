// SPDX-License-Identifier: BSD-3-Clause
// Thousands of layers, also with a memory limit far below what their fragments need.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/random.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/test_share.hpp"
#include "tests/transparency/exactness.hpp"

namespace rastrum::test::limits_test {
namespace {

constexpr std::uint64_t kMebi = std::uint64_t{1} << 20;

RenderOptions options(int size, std::uint64_t limit, int threads, const char* rasterizer) {
  return RenderOptions({.width = size, .height = size, .background = {1, 1, 1, 1}},
                       {.memory_limit = limit, .threads = threads}, {.rasterizer = rasterizer});
}

/// The frame, within the limit; empty if it was refused because no part fits.
std::optional<LayerPicture> take_within(Painter& renderer, LayerProgram& program) {
  const std::uint64_t limit = renderer.options().memory_limit;
  try {
    LayerPicture picture = take(renderer, program);
    EXPECT_LE(picture.stats.peak_bytes, limit) << renderer.options().rasterizer;
    return picture;
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::out_of_memory);
    EXPECT_TRUE(holds(e.what(), "memory limit"));
    return std::nullopt;
  }
}

TEST(Limits, TenThousandLayers) {
  constexpr int kSize = 32;  // 10 million fragments; 64² would only take four times as long
  const int layers = std::min(share_of(10000, 100), 10000);
  const LayerScene scene = layer_stack(11, layers, 4.0 / layers, kSize, kSize);
  const LayerImage oracle = oracle_of(scene, kSize, kSize, 1, {1, 1, 1, 1});
  ASSERT_EQ(oracle.most_layers(), static_cast<std::uint32_t>(layers));
  LayerProgram program(scene, kSize, kSize);
  Painter free(options(kSize, 0, 2, "auto"));
  const LayerPicture expected = take(free, program);
  EXPECT_TRUE(equals_oracle(expected, oracle));
  EXPECT_EQ(expected.counter("deepest"), static_cast<std::uint64_t>(layers));
  for (const char* const rasterizer : {"grouped", "tiled"})
    for (const std::uint64_t limit : {4 * kMebi, 16 * kMebi, 192 * kMebi}) {
      SCOPED_TRACE(std::string(rasterizer).append(", ").append(std::to_string(limit)));
      Painter limited(options(kSize, limit, 2, rasterizer));
      const auto picture = take_within(limited, program);
      if (picture) {
        EXPECT_TRUE(same_bits(*picture, expected));
      } else {
        // `tiled` keeps all triangles at once, so any limit may be too small for it.
        EXPECT_TRUE(limit < 192 * kMebi || std::string_view(rasterizer) == "tiled");
      }
    }
}

/// Triangles of all sizes everywhere, many more than fit into the limits below.
LayerScene many_triangles(int count, float least, float most) {
  LayerScene scene;
  scene.kind = "many triangles";
  scene.mesh = shapes::soup(count, least, most);
  scene.camera.eye = {0, 0, 3};
  const std::vector<Vec3> positions = scene.mesh.positions;
  Random r(8);
  for (std::uint32_t t = 0; t < positions.size() / 3; ++t) {
    const auto channel = [&] { return 0.4F * static_cast<float>(r.real(0, 1)); };
    const Vec4 color{channel(), channel(), channel(), 0.4F};
    scene.add(3 * t, 3 * t + 1, 3 * t + 2, color);
  }
  return scene;
}

// Less memory than the frame needs, and generated scenes in little memory.
TEST(Limits, LittleMemoryChangesNoPixel) {
  constexpr int kSize = 160;
  constexpr std::uint64_t kLimit = 5 * kMebi;
  Painter free(options(kSize, 0, 2, "auto"));
  std::vector<Painter> limited;
  for (const char* const rasterizer : {"grouped", "tiled"})
    for (const int threads : {2, 8})
      limited.emplace_back(options(kSize, kLimit, threads, rasterizer));
  std::uint64_t windows = 0;
  // Draws with every `step`-th of `limited`, from `first` on.
  const auto expect_same = [&](const LayerScene& scene, std::uint64_t least, std::size_t first,
                               std::size_t step) {
    SCOPED_TRACE(scene.kind);
    LayerProgram program(scene, kSize, kSize);
    const LayerPicture expected = take(free, program);
    EXPECT_GE(expected.stats.peak_bytes, least);
    for (std::size_t r = first; r < limited.size(); r += step) {
      Painter& renderer = limited[r];
      const auto picture = take_within(renderer, program);
      if (picture) {
        ASSERT_TRUE(same_bits(*picture, expected)) << renderer.options().rasterizer;
        ASSERT_EQ(picture->counter("deepest"), expected.counter("deepest"));
        windows += picture->counter("windows");
      } else {
        ASSERT_NE(renderer.options().rasterizer, "grouped");  // grouped draws part by part
      }
    }
  };
  const int scenes = share_of(100, kLayerKinds);
  for (int i = 0; i < scenes; ++i)  // with 2 and 8 threads in turn
    expect_same(generate_layers(static_cast<std::uint64_t>(i) + 99, kSize, kSize), 0,
                static_cast<std::size_t>(i % 2), 2);
  expect_same(many_triangles(std::min(share_of(100000, 50000), 100000), 0.01F, 0.05F), kLimit, 0,
              1);
  expect_same(many_triangles(2000, 0.5F, 1.5F), kLimit, 0, 1);  // hundreds of layers, not alike
  expect_same(layer_stack(13, 1000, 0.004, kSize, kSize), kLimit, 0, 1);
  EXPECT_GT(windows, 0U);
}

// 2.6 · 10⁹ fragments in half a GiB. All layers are level, so one pixel's blend is every pixel's.
TEST(Limits, TenThousandLayersAt512) {
  if (!is_full()) GTEST_SKIP() << kOnlyFull;
  constexpr int kSize = 512, kLayers = 10000;
  constexpr std::uint64_t kLimit = 512 * kMebi;
  const LayerScene scene = layer_stack(12, kLayers, 4.0 / kLayers, kSize, kSize);
  const LayerQuestion question(scene, kSize, kSize, 1, {1, 1, 1, 1});
  LayerInput one_pixel = question.input();
  one_pixel.width = one_pixel.height = 1;
  const LayerImage oracle = blend_layers(one_pixel, LayerOrder::depth);
  ASSERT_EQ(oracle.most_layers(), static_cast<std::uint32_t>(kLayers));
  LayerProgram program(scene, kSize, kSize);
  Painter renderer(options(kSize, kLimit, 2, "auto"));
  const LayerPicture picture = take(renderer, program);
  EXPECT_LE(picture.stats.peak_bytes, kLimit);
  // The bound on colours alone would allow a few missing layers.
  EXPECT_EQ(picture.counter("translucent fragments"), std::uint64_t{kLayers} * kSize * kSize);
  LayerImage everywhere;
  everywhere.width = everywhere.height = kSize;
  everywhere.color.assign(std::size_t{kSize} * kSize, oracle.color[0]);
  everywhere.depth.assign(std::size_t{kSize} * kSize, oracle.depth[0]);
  everywhere.layers.assign(std::size_t{kSize} * kSize, oracle.layers[0]);
  // Either half of a quad may cover a pixel; both have its colour.
  everywhere.ids.assign(picture.ids.pixels().begin(), picture.ids.pixels().end());
  for (const std::int64_t id : everywhere.ids) ASSERT_EQ(id / 2, oracle.ids[0] / 2);
  EXPECT_TRUE(equals_oracle(picture, everywhere));
}

}  // namespace
}  // namespace rastrum::test::limits_test
