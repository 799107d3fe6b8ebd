// A picture drawn in several passes is the picture drawn at once, and a fragment test is applied in
// every pass that a method makes over the fragments: for the serial device and every point of the
// coverage × visibility table. cuda_rasterizer_test has the passes of a device.
#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/family.hpp"
#include "tests/support/frame.hpp"
#include "tests/support/painter.hpp"
#include "tests/support/passes.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::passes_test {
namespace {

constexpr int kWidth = 150, kHeight = 100;

RenderOptions options(const TablePoint& point, int threads) {
  return RenderOptions({.width = kWidth, .height = kHeight, .background = {0.1F, 0.2F, 0.3F, 0.4F}},
                       {.threads = threads},
                       {.rasterizer = point.rasterizer, .visibility = point.visibility});
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

// The greys of depth are those of all passes together, with and without an image of depths that is
// kept, and whatever the frames before have left in the renderer's own.
TEST(PassesOfDepth, AreTheGreysOfOneDraw) {
  const Mesh meshes[] = {shapes::sphere(24, 48), shapes::boxes(2)};
  InstanceView instances[] = {{.geometry = meshes[0].view()}, {.geometry = meshes[1].view()}};
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
      Image<Rgba8> color8[2] = {{kWidth, kHeight}, {kWidth, kHeight}};
      Image<Vec4> color[2] = {{kWidth, kHeight}, {kWidth, kHeight}};
      Image<float> depth[2] = {{kWidth, kHeight}, {kWidth, kHeight}};
      Image<std::uint64_t> keys(kWidth, kHeight);
      Targets targets{.color8 = color8[0], .color = color[0]};
      if (keeps_depth) targets.depth = depth[0];
      (void)renderer.render(scene, camera, targets);
      targets.color8 = color8[1];
      targets.color = color[1];
      if (keeps_depth) targets.depth = depth[1];
      targets.keys = keys.view();
      for (const std::size_t pass : {std::size_t{0}, std::size_t{1}}) {
        targets.load = pass != 0;
        targets.first_id = pass == 0 ? 0 : meshes[0].triangle_count();
        const SceneView part{.instances = {&instances[pass], 1}};
        EXPECT_GT(renderer.render(part, camera, targets).pixels_covered, 500U);
      }
      EXPECT_TRUE(std::ranges::equal(color8[0].pixels(), color8[1].pixels()));
      EXPECT_TRUE(std::ranges::equal(color[0].pixels(), color[1].pixels()));
      if (keeps_depth) {
        EXPECT_TRUE(std::ranges::equal(depth[0].pixels(), depth[1].pixels()));
      }
    }
}

// With layers there are no keys to go on from, but ids count from the first one, too.
TEST(PassesOfLayers, CountIdsFromTheFirst) {
  const Scene scene = single(shapes::soup(300, 0.1F, 0.5F));
  const SceneBinding binding(scene);
  const Camera camera = fit_camera(binding.view(), 1.0472F, false);
  for (const Device device : {Device::serial, Device::threads}) {
    RenderOptions o = options({"auto", "auto"}, 2);
    o.device = device;
    o.opacity = 0.5F;
    Painter renderer(o);
    Image<std::int64_t> ids[2];
    for (int i = 0; i < 2; ++i) {
      ids[i] = Image<std::int64_t>(kWidth, kHeight);
      Targets targets;
      targets.ids = ids[i].view();
      targets.first_id = i == 0 ? 0 : 1000;
      static_cast<void>(renderer.render(binding.view(), camera, targets));
    }
    for (std::size_t i = 0; i < ids[0].pixels().size(); ++i) {
      const std::int64_t id = ids[0].pixels()[i];
      ASSERT_EQ(ids[1].pixels()[i], id < 0 ? -1 : id + 1000) << i;
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
  Mesh mesh = shapes::soup(2000, 0.01F, 0.5F);
  for (std::uint32_t i = 0;
       i < mesh.positions.size() && mesh.indices.size() < mesh.positions.size(); ++i)
    mesh.indices.push_back(i);
  class Corners final : public raster::VertexSource {
   public:
    explicit Corners(const Mesh& m) : mesh_(m) {}
    void project(std::size_t begin, std::size_t end, raster::Viewport viewport, Isa,
                 raster::ProjectedVertex* out) const noexcept override {
      for (std::size_t i = begin; i < end; ++i) out[i - begin] = raster::project(at(i), viewport);
    }
    [[nodiscard]] raster::Vec4d clip_position(std::size_t i) const noexcept override {
      const Vec4 p = at(i);
      return {p.x, p.y, p.z, p.w};
    }

   private:
    [[nodiscard]] Vec4 at(std::size_t i) const {
      const Vec3 p = mesh_.positions[i];
      return {p.x, p.y, p.z * 0.25F + 0.5F, 1};
    }
    const Mesh& mesh_;
  };
  const Corners corners(mesh);
  class White final : public raster::BlockShader {
   public:
    bool shade(const raster::FrameGeometry&, const raster::VisibleBlock& block, Isa,
               raster::BlockColors& colors) const noexcept override {
      for (int i = 0; i < 64; ++i)
        colors.set(i, {static_cast<float>(block.keys[i] & 255) / 255, 1, 0, 1});
      return true;
    }
  };
  raster::Draw tested;
  tested.source = &corners;
  tested.vertex_count = mesh.positions.size();
  tested.indices = mesh.indices;
  tested.primitive_count = mesh.indices.size() / 3;
  tested.flags = raster::kTested;
  // The second draw is not tested, though the frame has a test.
  raster::Draw plain = tested;
  plain.indices = plain.indices.subspan(0, 300);
  plain.primitive_count = 100;
  plain.flags = 0;
  std::vector<raster::Draw> draws{tested, plain};
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
    ASSERT_TRUE(same_surfaces(frame, expected)) << threads;
    ASSERT_TRUE(same_picture(frame, expected, 0)) << threads;
  }
}

INSTANTIATE_TEST_SUITE_P(Points, Passes, testing::ValuesIn(table_points()),
                         [](const auto& p) { return test_name(p.param); });

}  // namespace
}  // namespace rastrum::test::passes_test
