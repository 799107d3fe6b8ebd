// SPDX-License-Identifier: BSD-3-Clause
// A picture in several passes equals the picture in one, and a fragment test applies in every pass
// of a method over the fragments: for the serial device and every point of the coverage ×
// visibility table. cuda_rasterizer_test has a device's passes.
#include <cstdint>

#include <gtest/gtest.h>

#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/clip_mesh.hpp"
#include "tests/support/family.hpp"
#include "tests/support/frame.hpp"
#include "tests/support/passes.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::passes_test {
namespace {

constexpr int kWidth = 150, kHeight = 100;

RenderOptions options(const TablePoint& point, int threads) {
  return RenderOptions({.width = kWidth, .height = kHeight, .background = {0.1F, 0.2F, 0.3F, 0.4F}},
                       {.threads = threads}, point);
}

class Passes : public testing::TestWithParam<TablePoint> {};

TEST_P(Passes, EqualOneDraw) {
  for (const int threads : {1, 8})
    for (const std::uint64_t limit : {std::uint64_t{0}, std::uint64_t{6} << 20}) {
      RenderOptions o = options(GetParam(), threads);
      o.memory_limit = limit;
      Painter renderer(o);
      for (const char* shape : {"soup?count=3000", "boxes"})
        ASSERT_TRUE(passes_equal_one_draw(renderer, shape));
    }
}

TEST(PassesOfSerial, EqualOneDraw) {
  RenderOptions o = options({"auto", "auto"}, 1);
  o.device = Device::serial;
  Painter renderer(o);
  for (const char* shape : {"soup?count=3000", "boxes"})
    EXPECT_TRUE(passes_equal_one_draw(renderer, shape));
}

// The greys of depth cover all passes together, with and without a kept image of depths, whatever
// earlier frames left in the renderer's own.
TEST(PassesOfDepth, AreTheGreysOfOneDraw) {
  const Mesh meshes[] = {shapes::sphere(24, 48), shapes::boxes(2)};
  KeptInstances instances{meshes[0].view(), meshes[1].view()};
  instances[0].object_to_world.m[0][3] = -0.8;
  instances[0].object_to_world.m[2][3] = 0.5;
  const SceneView scene{.instances = instances};
  const Camera camera = fit_camera(scene, 1.0472F, false);
  for (const Device device : {Device::serial, Device::threads})
    for (const bool keeps_depth : {false, true}) {
      SCOPED_TRACE(keeps_depth);
      RenderOptions o = options({"auto", "auto"}, 2);
      o.device = device;
      o.shader = Shader::depth;
      Painter renderer(o);
      const unsigned kinds = kColor8 | kColor | (keeps_depth ? kDepth : 0U);
      const Frame whole = draw(renderer, scene, camera, kinds);
      Frame passes(kWidth, kHeight, kinds);
      Image<std::uint64_t> keys(kWidth, kHeight);
      Targets targets = passes.targets();
      targets.keys = keys.view();
      for (const std::size_t pass : {std::size_t{0}, std::size_t{1}}) {
        const Pass after{.load = pass != 0, .first_id = pass == 0 ? 0 : meshes[0].triangle_count()};
        const SceneView part{.instances = {&instances[pass], 1}};
        EXPECT_GT(renderer.render(part, camera, targets, after).pixels_covered, 500U);
      }
      EXPECT_TRUE(same_images(whole, passes));
    }
}

// Layers have no keys to continue from, but ids count from the first one too.
TEST(PassesOfLayers, CountIdsFromTheFirst) {
  const Fitted scene(shapes::soup(300, 0.1F, 0.5F));
  for (const Device device : {Device::serial, Device::threads}) {
    RenderOptions o = options({"auto", "auto"}, 2);
    o.device = device;
    o.opacity = 0.5F;
    Painter renderer(o);
    const Frame first = draw(renderer, scene.view, scene.camera, kIds);
    Image<std::int64_t> ids(kWidth, kHeight);
    renderer.render(scene.view, scene.camera, {.ids = ids}, {.first_id = 1000});
    for (std::size_t i = 0; i < ids.pixels().size(); ++i) {
      const std::int64_t id = first.ids.pixels()[i];
      ASSERT_EQ(ids.pixels()[i], id < 0 ? -1 : id + 1000) << i;
    }
  }
}

/// Drops about half of the samples of each triangle.
class Sieve final : public raster::FragmentTest {
 public:
  std::uint64_t test(const raster::FrameGeometry&, const raster::Piece& piece,
                     const raster::Block& block,
                     const raster::ShadingPoints*) const noexcept override {
    std::uint64_t h = piece.low * 0x9E3779B97F4A7C15U + block.bx * 0xBF58476D1CE4E5B9U +
                      block.by * 0x94D049BB133111EBU;
    h = (h ^ (h >> 31)) * 0xBF58476D1CE4E5B9U;
    return block.mask & (h ^ (h >> 29));
  }
};

TEST_P(Passes, AllTestFragments) {
  const ClipMesh soup(shapes::soup(2000, 0.01F, 0.5F));
  class White final : public raster::BlockShader {
   public:
    bool shade(const raster::FrameGeometry&, const raster::VisibleBlock& block, Isa,
               raster::BlockColors& colors) const noexcept override {
      for (int i = 0; i < 64; ++i)
        colors.set(i, {static_cast<float>(block.keys[i] & 255) / 255, 1, 0, 1});
      return true;
    }
  };
  // The second draw is not tested, although the frame has a test.
  raster::Draw draws[] = {soup.draw(kTested), soup.draw(0)};
  draws[1].indices = draws[1].indices.subspan(0, 300);
  draws[1].primitive_count = 100;
  RenderOptions serial = options(GetParam(), 1);
  serial.rasterizer = serial.visibility = "auto";
  serial.device = Device::serial;
  Painter reference(serial);
  const Sieve sieve;
  const White white;
  const Frame expected = draw(reference, draws, white, &sieve);
  const Frame untested = draw(reference, draws, white, nullptr);
  ASSERT_FALSE(same_surfaces(expected, untested));
  for (const int threads : {1, 2, 8}) {
    Painter renderer(options(GetParam(), threads));
    const Frame frame = draw(renderer, draws, white, &sieve);
    ASSERT_TRUE(same_images(frame, expected)) << threads;
  }
}

INSTANTIATE_TEST_SUITE_P(Points, Passes, testing::ValuesIn(table_points()),
                         [](const auto& p) { return test_name(p.param); });

}  // namespace
}  // namespace rastrum::test::passes_test
