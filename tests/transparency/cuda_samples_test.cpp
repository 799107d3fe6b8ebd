// SPDX-License-Identifier: BSD-3-Clause
// Several samples a pixel with --device cuda equal the serial device's, through the façade: opaque,
// blended, and in little memory. In this program the device is the CPU
// (tests/raster/CMakeLists.txt).
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/device_frames.hpp"
#include "tests/support/layer_scenes.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::cuda_samples_test {
namespace {

RenderOptions options(int width, int height, int samples, Device device) {
  RenderOptions o = device_options(width, height, device);
  o.samples = samples;
  return o;
}

int scene_count() {
  return share_of(20, kSceneKinds);
}

using CudaSamples = CudaTest;

class CudaSampled : public CudaSamples, public testing::WithParamInterface<int> {};

struct Way {
  int width, height;
  Shader shader;
  Cull cull = Cull::none;
  Transparency method = Transparency::exact;
  float opacity = 1;
  float alpha_threshold = 1;

  [[nodiscard]] RenderOptions options(int samples, Device device) const {
    RenderOptions o = cuda_samples_test::options(width, height, samples, device);
    o.shader = shader;
    o.cull = cull;
    o.opacity = opacity;
    o.transparency.method = method;
    o.transparency.alpha_threshold = alpha_threshold;
    return o;
  }
};

TEST_P(CudaSampled, OpaqueSurfacesEqualSerial) {
  std::uint64_t partly = 0;
  for (const Way& way : {Way{37, 53, Shader::phong}, Way{64, 24, Shader::flat, Cull::back},
                         Way{1, 1, Shader::normal}, Way{17, 40, Shader::id}}) {
    Painter serial(way.options(GetParam(), Device::serial)),
        cuda(way.options(GetParam(), Device::cuda));
    for (int i = 0; i < scene_count(); ++i) {
      const GeneratedScene g = generate(static_cast<std::uint64_t>(i), way.width, way.height);
      SCOPED_TRACE(std::to_string(i).append(", ").append(g.kind));
      const Frame expected = draw(serial, g.view(), g.camera);
      const Frame frame = draw(cuda, g.view(), g.camera);
      expect_by_device(frame, expected);
      if (HasFailure()) return;
      for (const Vec4& c : frame.color.pixels()) partly += c.w > 0.51F && c.w < 0.99F;
    }
  }
  // Edges are smooth.
  EXPECT_GT(partly, 1000U);
}

TEST_P(CudaSampled, LayersEqualSerial) {
  std::uint64_t repaired = 0, blended = 0;
  for (const Way& way : {Way{37, 29, Shader::phong, Cull::none, Transparency::exact, 0.4F},
                         Way{33, 20, Shader::flat, Cull::none, Transparency::unsorted, 0.7F},
                         Way{40, 16, Shader::normal, Cull::back, Transparency::exact, 0.3F, 0.5F},
                         Way{16, 16, Shader::lambert, Cull::none, Transparency::none, 0.5F}}) {
    Painter serial(way.options(GetParam(), Device::serial)),
        threads(way.options(GetParam(), Device::threads)),
        cuda(way.options(GetParam(), Device::cuda));
    for (int i = 0; i < scene_count(); ++i) {
      const GeneratedScene g = generate(static_cast<std::uint64_t>(i), way.width, way.height);
      SCOPED_TRACE(std::to_string(i).append(", ").append(g.kind));
      const LayerPicture frame = take(cuda, g.view(), g.camera);
      const LayerPicture expected = take(serial, g.view(), g.camera);
      const LayerPicture host = take(threads, g.view(), g.camera);
      expect_by_device(frame, expected);
      expect_by_device(frame, host);
      if (HasFailure()) return;
      EXPECT_EQ(frame.stats.triangles.culled, expected.stats.triangles.culled);
      EXPECT_EQ(frame.stats.triangles.clipped, expected.stats.triangles.clipped);
      EXPECT_EQ(frame.stats.triangles.clipped, host.stats.triangles.clipped);
      EXPECT_EQ(frame.stats.triangles.dropped, expected.stats.triangles.dropped);
      repaired += frame.counter("repaired pixels");
      blended += frame.counter("translucent fragments");
    }
  }
  EXPECT_GT(blended, 10000U);
  EXPECT_GT(repaired, 0U);
}

// Overlapping pieces of a clipped triangle are one layer at every sample.
TEST_P(CudaSampled, OverlappingPiecesEqualSerial) {
  const LayerScene layers = overlapping_pieces();
  const Viewed seen(single(layers.mesh), layers.camera);
  RenderOptions o = options(64, 64, GetParam(), Device::serial);
  o.shader = Shader::flat;
  o.opacity = 0.5F;
  Painter serial(o), cuda(by(o, Device::cuda));
  expect_by_device(take(cuda, seen), take(serial, seen));
}

// Triangles of all sizes, by a thread, by a team and by tiles; bands in little memory.
TEST_P(CudaSampled, SizesAndMemoryChangeNothing) {
  constexpr int kWidth = 100, kHeight = 150;
  const Viewed seen(single(shapes::soup(250, 0.01F, 1.2F)));
  for (const float opacity : {1.0F, 0.4F}) {
    RenderOptions o = options(kWidth, kHeight, GetParam(), Device::threads);
    o.shader = Shader::flat;
    o.opacity = opacity;
    Painter threads(o);
    const LayerPicture expected = take(threads, seen);
    o.device = Device::cuda;
    struct Cut {
      int small_px, large_px;
      std::uint64_t limit;
    };
    for (const Cut cut : {Cut{0, 0, 0}, Cut{1, 400, 0}, Cut{1 << 20, 0, 0}, Cut{0, 0, 7000000}}) {
      o.tuning.small_px = cut.small_px;
      o.tuning.large_px = cut.large_px;
      o.memory_limit = cut.limit;
      Painter cuda(o);
      SCOPED_TRACE(testing::Message() << cut.small_px << ", " << cut.limit);
      const LayerPicture frame = take(cuda, seen);
      expect_by_device(frame, expected);
      EXPECT_EQ(frame.counter("tile pairs") > 0, cut.large_px == 400 && opacity == 1);
      // The limit does not count the mesh or its copy.
      if (cut.limit == 0) continue;
      EXPECT_LE(frame.stats.peak_bytes, cut.limit + 750 * sizeof(Vec3));
      if (GetParam() == 16) {
        EXPECT_GT(frame.counter("bands"), 1U);
      }
    }
  }
}

// Bands whose pieces do not fit are drawn in parts, in which planes are apart.
TEST_F(CudaSamples, PartsOfABandEqualTheWhole) {
  const Viewed seen(single(shapes::soup(40000, 0.01F, 0.04F)));
  RenderOptions o = options(100, 100, 4, Device::cuda);
  o.shader = Shader::flat;
  o.opacity = 0.4F;
  Painter free(o), threads(by(o, Device::threads));
  o.memory_limit = 3000000;
  Painter limited(o);
  const LayerPicture expected = take(threads, seen), whole = take(free, seen),
                     frame = take(limited, seen);
  expect_by_device(whole, expected);
  expect_by_device(frame, expected);
  EXPECT_EQ(whole.counter("turns"), 1U);
  EXPECT_EQ(frame.counter("bands"), 2U);
  EXPECT_GT(frame.counter("turns"), 4U);
}

// Blocks with more records than the largest team takes, and some with fewer.
TEST_F(CudaSamples, DeepBlocksEqualTheThreads) {
  const Viewed seen(single(shapes::soup(9000, 0.2F, 0.6F)));
  RenderOptions o = options(28, 20, 4, Device::cuda);
  o.shader = Shader::flat;
  o.opacity = 0.1F;
  Painter cuda(o), threads(by(o, Device::threads));
  const LayerPicture frame = take(cuda, seen);
  expect_by_device(frame, take(threads, seen));
  EXPECT_GT(frame.counter("deep blocks"), 0U);
  EXPECT_GT(frame.counter("high blocks"), 0U);
}

INSTANTIATE_TEST_SUITE_P(Standard, CudaSampled, testing::Values(4, 8, 16),
                         [](const auto& p) { return std::to_string(p.param); });

}  // namespace
}  // namespace rastrum::test::cuda_samples_test
