// Several samples a pixel of --device cuda are the serial device's, through the façade: opaque,
// blended, and in little memory. In this program the device is the CPU
// (tests/raster/CMakeLists.txt).
#include <cstdint>
#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/cuda_test.hpp"
#include "tests/support/frame.hpp"
#include "tests/support/layer_picture.hpp"
#include "tests/support/layer_scenes.hpp"
#include "tests/support/painter.hpp"
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
};

TEST_P(CudaSampled, OpaqueSurfacesEqualSerial) {
  std::uint64_t partly = 0;
  for (const Way& way : {Way{37, 53, Shader::phong}, Way{64, 24, Shader::flat, Cull::back},
                         Way{1, 1, Shader::normal}, Way{17, 40, Shader::id}}) {
    RenderOptions o = options(way.width, way.height, GetParam(), Device::serial);
    o.shader = way.shader;
    o.cull = way.cull;
    Painter serial(o);
    o.device = Device::cuda;
    Painter cuda(o);
    for (int i = 0; i < scene_count(); ++i) {
      const GeneratedScene g = generate(static_cast<std::uint64_t>(i), way.width, way.height);
      SCOPED_TRACE(std::to_string(i).append(", ").append(g.kind));
      const Frame expected = draw(serial, g.view(), g.camera);
      const Frame frame = draw(cuda, g.view(), g.camera);
      ASSERT_EQ(frame.stats.device, Device::cuda) << frame.stats.device_why;
      ASSERT_TRUE(same_surfaces(frame, expected));
      ASSERT_TRUE(same_counts(frame.stats, expected.stats));
      ASSERT_TRUE(same_picture(frame, expected, 0));
      const auto x = frame.color.pixels(), y = expected.color.pixels();
      ASSERT_EQ(std::memcmp(x.data(), y.data(), x.size_bytes()), 0) << "float colours differ";
      for (const Vec4& c : x) partly += c.w > 0.51F && c.w < 0.99F;
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
    RenderOptions o = options(way.width, way.height, GetParam(), Device::serial);
    o.shader = way.shader;
    o.cull = way.cull;
    o.opacity = way.opacity;
    o.transparency.method = way.method;
    o.transparency.alpha_threshold = way.alpha_threshold;
    Painter serial(o);
    o.device = Device::threads;
    Painter threads(o);
    o.device = Device::cuda;
    Painter cuda(o);
    for (int i = 0; i < scene_count(); ++i) {
      const GeneratedScene g = generate(static_cast<std::uint64_t>(i), way.width, way.height);
      SCOPED_TRACE(std::to_string(i).append(", ").append(g.kind));
      const LayerPicture frame = take(cuda, g.view(), g.camera);
      ASSERT_EQ(frame.stats.device, Device::cuda) << frame.stats.device_why;
      const LayerPicture expected = take(serial, g.view(), g.camera);
      ASSERT_TRUE(same_bits(frame, expected));
      const LayerPicture host = take(threads, g.view(), g.camera);
      EXPECT_EQ(frame.counter("translucent fragments"), host.counter("translucent fragments"));
      EXPECT_EQ(frame.counter("deepest"), host.counter("deepest"));
      EXPECT_EQ(frame.stats.triangles.clipped, host.stats.triangles.clipped);
      EXPECT_EQ(frame.stats.pixels_covered, expected.stats.pixels_covered);
      EXPECT_EQ(frame.stats.triangles.culled, expected.stats.triangles.culled);
      EXPECT_EQ(frame.stats.triangles.clipped, expected.stats.triangles.clipped);
      EXPECT_EQ(frame.stats.triangles.dropped, expected.stats.triangles.dropped);
      repaired += frame.counter("repaired pixels");
      blended += frame.counter("translucent fragments");
    }
  }
  EXPECT_GT(blended, 10000U);
  EXPECT_GT(repaired, 0U);
}

// Pieces of one clipped triangle that overlap are one layer at every sample.
TEST_P(CudaSampled, OverlappingPiecesEqualSerial) {
  const LayerScene layers = overlapping_pieces();
  const Scene scene = single(layers.mesh);
  const SceneBinding binding(scene);
  RenderOptions o = options(64, 64, GetParam(), Device::serial);
  o.shader = Shader::flat;
  o.opacity = 0.5F;
  Painter serial(o);
  o.device = Device::cuda;
  Painter cuda(o);
  const LayerPicture frame = take(cuda, binding.view(), layers.camera);
  ASSERT_EQ(frame.stats.device, Device::cuda) << frame.stats.device_why;
  ASSERT_TRUE(same_bits(frame, take(serial, binding.view(), layers.camera)));
}

// Triangles of all sizes, by a thread, a team and by tiles; bands in little memory.
TEST_P(CudaSampled, SizesAndMemoryChangeNothing) {
  constexpr int kWidth = 100, kHeight = 150;
  const Scene scene = single(shapes::soup(250, 0.01F, 1.2F));
  const SceneBinding binding(scene);
  Camera camera{.eye = {0, 0, 3}};
  for (const float opacity : {1.0F, 0.4F}) {
    RenderOptions o = options(kWidth, kHeight, GetParam(), Device::threads);
    o.shader = Shader::flat;
    o.opacity = opacity;
    Painter threads(o);
    const LayerPicture expected = take(threads, binding.view(), camera);
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
      const LayerPicture frame = take(cuda, binding.view(), camera);
      ASSERT_EQ(frame.stats.device, Device::cuda) << frame.stats.device_why;
      EXPECT_TRUE(same_bits(frame, expected)) << cut.small_px << ", " << cut.limit;
      EXPECT_EQ(frame.counter("tile pairs") > 0, cut.large_px == 400 && opacity == 1);
      // The mesh's copy is not counted, as the mesh is not.
      if (cut.limit == 0) continue;
      EXPECT_LE(frame.stats.peak_bytes, cut.limit + 750 * sizeof(Vec3));
      if (GetParam() == 16) {
        EXPECT_GT(frame.counter("bands"), 1U);
      }
    }
  }
}

// Bands whose pieces do not fit go in parts, in which planes lie apart.
TEST_F(CudaSamples, PartsOfABandEqualTheWhole) {
  const Scene scene = single(shapes::soup(40000, 0.01F, 0.04F));
  const SceneBinding binding(scene);
  Camera camera{.eye = {0, 0, 3}};
  RenderOptions o = options(100, 100, 4, Device::cuda);
  o.shader = Shader::flat;
  o.opacity = 0.4F;
  Painter free(o);
  o.memory_limit = 3000000;
  Painter limited(o);
  o.memory_limit = 0;
  o.device = Device::threads;
  Painter threads(o);
  const LayerPicture expected = take(threads, binding.view(), camera);
  const LayerPicture whole = take(free, binding.view(), camera);
  const LayerPicture frame = take(limited, binding.view(), camera);
  EXPECT_TRUE(same_bits(whole, expected));
  EXPECT_TRUE(same_bits(frame, expected));
  EXPECT_EQ(whole.counter("turns"), 1U);
  EXPECT_EQ(frame.counter("bands"), 2U);
  EXPECT_GT(frame.counter("turns"), 4U);
  EXPECT_EQ(frame.counter("translucent fragments"), expected.counter("translucent fragments"));
}

// Blocks with more records than a team of high density takes, and some with fewer.
TEST_F(CudaSamples, DeepBlocksEqualTheThreads) {
  const Scene scene = single(shapes::soup(9000, 0.2F, 0.6F));
  const SceneBinding binding(scene);
  Camera camera{.eye = {0, 0, 3}};
  RenderOptions o = options(28, 20, 4, Device::cuda);
  o.shader = Shader::flat;
  o.opacity = 0.1F;
  Painter cuda(o);
  o.device = Device::threads;
  Painter threads(o);
  const LayerPicture frame = take(cuda, binding.view(), camera);
  const LayerPicture expected = take(threads, binding.view(), camera);
  EXPECT_TRUE(same_bits(frame, expected));
  EXPECT_GT(frame.counter("deep blocks"), 0U);
  EXPECT_GT(frame.counter("high blocks"), 0U);
  EXPECT_EQ(frame.counter("translucent fragments"), expected.counter("translucent fragments"));
  EXPECT_EQ(frame.counter("deepest"), expected.counter("deepest"));
}

INSTANTIATE_TEST_SUITE_P(Standard, CudaSampled, testing::Values(4, 8, 16),
                         [](const auto& p) { return std::to_string(p.param); });

}  // namespace
}  // namespace rastrum::test::cuda_samples_test
