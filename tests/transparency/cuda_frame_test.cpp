// SPDX-License-Identifier: BSD-3-Clause
// Translucent frames of --device cuda equal the host's, through the façade, with pieces and shaders
// of the device. In this program the device is the CPU (tests/raster/CMakeLists.txt).
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <rastrum/family.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/device_frames.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::cuda_frame_test {
namespace {

RenderOptions options(int width, int height, Device device) {
  RenderOptions o = device_options(width, height, device);
  o.opacity = 0.4F;
  return o;
}

using CudaLayeredFrame = CudaTest;

TEST_F(CudaLayeredFrame, EqualsTheThreads) {
  struct Way {
    int width, height;
    Shader shader;
    Transparency method;
    float opacity;
  };
  std::uint64_t blended = 0;
  for (const Way& way : {Way{64, 64, Shader::phong, Transparency::exact, 0.4F},
                         {37, 53, Shader::flat, Transparency::unsorted, 0.7F},
                         {100, 150, Shader::normal, Transparency::exact, 0},
                         {17, 128, Shader::lambert, Transparency::none, 0.5F},
                         {8, 8, Shader::id, Transparency::exact, 0.99F}}) {
    RenderOptions o = options(way.width, way.height, Device::threads);
    o.shader = way.shader;
    o.transparency.method = way.method;
    o.opacity = way.opacity;
    Painter threads(o), cuda(by(o, Device::cuda));
    for (int i = 0; i < share_of(2 * kSceneKinds, 4); ++i) {
      const GeneratedScene g = generate(static_cast<std::uint64_t>(i), way.width, way.height);
      SCOPED_TRACE(std::to_string(i).append(", ").append(g.kind));
      const LayerPicture expected = take(threads, g.view(), g.camera);
      const LayerPicture frame = take(cuda, g.view(), g.camera);
      expect_by_device(frame, expected);
      if (HasFailure()) return;
      EXPECT_EQ(frame.stats.visibility == "layers", expected.stats.visibility == "layers");
      blended += frame.counter("translucent fragments");
    }
  }
  EXPECT_GT(blended, 1000U);
}

// With little memory the picture is drawn in bands, and bands in parts whose pieces fit.
TEST_F(CudaLayeredFrame, AMemoryLimitChangesNothing) {
  const Viewed seen(single(shapes::soup(20000, 0.01F, 0.3F)));
  RenderOptions o = options(128, 200, Device::cuda);
  o.shader = Shader::flat;
  Painter free(o), threads(by(o, Device::threads));
  const LayerPicture expected = take(free, seen);
  EXPECT_EQ(expected.counter("turns"), 1U);
  EXPECT_EQ(expected.counter("bands listed"), 0U);
  o.memory_limit = std::uint64_t{3} << 20;
  Painter limited(o);
  const LayerPicture frame = take(limited, seen);
  expect_by_device(frame, expected);
  EXPECT_GT(frame.counter("turns"), frame.counter("bands"));
  EXPECT_GT(frame.counter("bands listed"), 0U);
  // The limit does not count the mesh or its copy.
  EXPECT_LE(frame.stats.peak_bytes, o.memory_limit + 60000 * sizeof(Vec3));
  EXPECT_GT(expected.stats.peak_bytes, o.memory_limit + 60000 * sizeof(Vec3));
  EXPECT_TRUE(same_bits(take(threads, seen), expected));
}

// With deep blocks, the images are finished once, after the host has resolved these. Layers over a
// picture would otherwise show twice.
TEST_F(CudaLayeredFrame, DeepBlocksOverAPictureEqualTheThreads) {
  constexpr int kSize = 40;
  Scene many = single(shapes::soup(7000, 0.6F, 1.2F));
  for (Vec3& p : many.meshes[0].positions) p = {p.x * 0.4F, p.y * 0.4F, p.z};
  const Scene few = single(shapes::soup(40, 0.4F, 0.9F));
  many.meshes.push_back(few.meshes[0]);
  many.instances.push_back(few.instances[0]);
  many.instances.back().mesh = 1;
  const Viewed first(single(shapes::soup(3, 0.4F, 0.9F))), second(std::move(many));
  const auto drawn = [&](Device device) {
    RenderOptions o = device_options(kSize, kSize, device);
    o.shader = Shader::flat;
    Painter opaque(o);
    o.opacity = 0.05F;
    Painter painter(o);
    LayerPicture p = take(opaque, first);
    p.stats = painter.render(second.view(), second.camera,
                             {.color8 = p.color8, .depth = p.depth, .ids = p.ids}, {.over = true});
    return p;
  };
  const LayerPicture expected = drawn(Device::threads), frame = drawn(Device::cuda);
  expect_by_device(frame, expected);
  EXPECT_GT(frame.counter("deep blocks"), 0U);
  EXPECT_GT(frame.counter("low blocks"), 0U);
  EXPECT_EQ(frame.counter("bands listed"), 0U);
}

// Frames that the device cannot draw go to the CPU, with a reason.
TEST_F(CudaLayeredFrame, TheRestIsTheCPUs) {
  const Viewed seen(single(shapes::soup(20, 0.3F, 0.5F)));
  const auto expect = [&](const char* why, const RenderOptions& o) {
    Painter cuda(o), threads(by(o, Device::threads));
    const LayerPicture frame = take(cuda, seen);
    EXPECT_TRUE(same_bits(frame, take(threads, seen)));
    EXPECT_EQ(frame.stats.device, Device::threads);
    EXPECT_TRUE(holds(frame.stats.device_why, why));
  };
  RenderOptions o = options(40, 40, Device::cuda);
  o.shader = Shader::wireframe;
  expect("no form of this shader", o);
  o.opacity = 1;
  o.samples = 4;
  expect("several samples", o);
  o.shader = Shader::flat;
  o.rasterizer = "tiled";
  expect("by-size has several samples", o);
  o = options(40, 40, Device::cuda);
  o.shader = Shader::flat;
  o.transparency = family::mlab4();
  expect("approximations", o);
}

}  // namespace
}  // namespace rastrum::test::cuda_frame_test
