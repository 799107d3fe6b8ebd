// A picture drawn in several passes (Targets::load) is the picture drawn at once, and a fragment
// test is applied in every pass that a method makes over the fragments: for every point of the
// coverage × visibility table.
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/raster/coverage.hpp>
#include <rastrum/render/render.hpp>
#include <rastrum/scene/shapes/shapes.hpp>

#include "tests/support/family.hpp"
#include "tests/support/frame.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test {
namespace {

constexpr int kWidth = 150, kHeight = 100;

RenderOptions options(const TablePoint& point, int threads) {
  RenderOptions o;
  o.width = kWidth;
  o.height = kHeight;
  o.rasterizer = point.rasterizer;
  o.visibility = point.visibility;
  o.threads = threads;
  o.background = {0.1F, 0.2F, 0.3F, 0.4F};
  return o;
}

/// With an index for each corner, whatever the mesh has.
Mesh indexed(Mesh mesh) {
  if (mesh.indices.empty())
    for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) mesh.indices.push_back(i);
  return mesh;
}

class Passes : public testing::TestWithParam<TablePoint> {};

/// Draws the mesh in `passes` parts of unequal size, each onto the ones before.
Frame draw_in_passes(Renderer& renderer, const Scene& scene, const Camera& camera,
                     std::size_t passes) {
  const SceneBinding binding(scene);
  const InstanceView whole = binding.view().instances[0];
  Frame f;
  f.color8 = Image<Rgba8>(kWidth, kHeight);
  f.color = Image<Vec4>(kWidth, kHeight);
  f.depth = Image<float>(kWidth, kHeight);
  f.ids = Image<std::int64_t>(kWidth, kHeight);
  f.overdraw = Image<std::uint32_t>(kWidth, kHeight);
  Image<std::uint64_t> words(kWidth, kHeight);
  Targets targets{f.color8.view(), f.color.view(), f.depth.view(), f.ids.view(), f.overdraw.view()};
  targets.words = words.view();
  const std::size_t triangles = whole.mesh.triangle_count();
  std::size_t first = 0;
  for (std::size_t pass = 0; pass < passes; ++pass) {
    const std::size_t last = triangles * (pass + 1) * (pass + 1) / (passes * passes);
    InstanceView part = whole;
    part.mesh.indices = whole.mesh.indices.subspan(first * 3, (last - first) * 3);
    if (std::span<const std::uint32_t>& normals = part.mesh.normals.indices; !normals.empty())
      normals = normals.subspan(first * 3, (last - first) * 3);
    targets.load = pass != 0;
    targets.first_id = first;
    renderer.render({{&part, 1}, binding.view().materials, binding.view().textures}, camera,
                    targets);
    first = last;
  }
  return f;
}

TEST_P(Passes, EqualOneDraw) {
  for (const char* spec : {"soup?count=3000", "boxes"}) {
    const Scene scene = single(indexed(shapes::from_spec(spec)));
    const SceneBinding binding(scene);
    const Camera camera = fit_camera(binding.view(), 1.0472F, false);
    for (const int threads : {1, 8})
      for (const std::uint64_t limit : {std::uint64_t{0}, std::uint64_t{6} << 20}) {
        RenderOptions o = options(GetParam(), threads);
        o.memory_limit = limit;
        Renderer renderer(o);
        const Frame once = draw(renderer, binding.view(), camera);
        ASSERT_GT(once.stats.pixels_covered, 1000U);
        for (const std::size_t passes : {std::size_t{2}, std::size_t{5}}) {
          const Frame frame = draw_in_passes(renderer, scene, camera, passes);
          ASSERT_TRUE(same_surfaces(frame, once)) << spec << " in " << passes;
          ASSERT_TRUE(same_picture(frame, once, 0)) << spec << " in " << passes;
        }
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
  const Mesh mesh = indexed(shapes::soup(2000, 0.01F, 0.5F));
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
        colors.set(i, {static_cast<float>(block.words[i] & 255) / 255, 1, 0, 1});
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
  Renderer reference(serial);
  const Sieve sieve;
  const White white;
  const Frame expected = draw(reference, draws, white, &sieve);
  const Frame untested = draw(reference, draws, white, nullptr);
  ASSERT_FALSE(same_surfaces(expected, untested));
  for (const int threads : {1, 2, 8}) {
    Renderer renderer(options(GetParam(), threads));
    const Frame frame = draw(renderer, draws, white, &sieve);
    ASSERT_TRUE(same_surfaces(frame, expected)) << threads;
    ASSERT_TRUE(same_picture(frame, expected, 0)) << threads;
  }
}

INSTANTIATE_TEST_SUITE_P(Points, Passes, testing::ValuesIn(table_points()),
                         [](const auto& p) { return test_name(p.param); });

}  // namespace
}  // namespace rastrum::test
