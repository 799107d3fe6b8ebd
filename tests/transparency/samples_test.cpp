// SPDX-License-Identifier: BSD-3-Clause
// Several samples a pixel: each sample equals a sort of its own fragments, a triangle has one
// colour in a pixel, and the pixel is the mean. For translucent, opaque and mixed surfaces.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/program.hpp>
#include <rastrum/raster/rules/samples.hpp>
#include <rastrum/render.hpp>

#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"
#include "tests/transparency/exactness.hpp"

namespace rastrum::test::samples_test {
namespace {

struct Size {
  int width, height;
};
constexpr Size kSizes[] = {{1, 1}, {8, 8}, {37, 53}, {65, 33}, {130, 70}};

RenderOptions options(Size size, int samples) {
  return RenderOptions({.width = size.width,
                        .height = size.height,
                        .background = {0.2F, 0.6F, 0.4F, 0.5F},
                        .samples = samples});
}

enum class Surfaces { as_generated, all_opaque };

LayerScene scene_of(int i, Size size, int samples, Surfaces surfaces) {
  LayerScene scene = generate_layers(
      static_cast<std::uint64_t>(i) + static_cast<std::uint64_t>(size.width) * 2000000, size.width,
      size.height, 500000 / samples);
  if (surfaces == Surfaces::all_opaque) {
    std::ranges::fill(scene.opaque, std::uint8_t{1});
    for (Vec4& color : scene.colors) color.w = 1;
    for (Vec4& color : scene.corner_colors) color.w = 1;
  }
  return scene;
}

class Samples : public testing::TestWithParam<int> {
 protected:
  void expect_exact(Surfaces surfaces) {
    const int samples = GetParam();
    const int scenes = share_of(40, kLayerKinds);
    int failures = 0;
    std::uint64_t partly = 0;
    for (const Size size : kSizes) {
      std::vector<std::vector<Painter>> by_isa;
      for (const Isa isa : available_isas()) {
        auto& family = by_isa.emplace_back();
        for (const auto& [rasterizer, threads] :
             {std::pair{"grouped", 1}, {"grouped", 8}, {"tiled", 2}}) {
          if (threads > 1 && isa != available_isas().back()) continue;
          RenderOptions o = options(size, samples);
          o.isa = isa;
          o.rasterizer = rasterizer;
          o.threads = threads;
          family.emplace_back(o);
        }
      }
      for (int i = 0; i < scenes; ++i) {
        const LayerScene scene = scene_of(i, size, samples, surfaces);
        SCOPED_TRACE(title_of(static_cast<std::uint64_t>(i), scene) + ", " +
                     std::to_string(size.width));
        const LayerImage oracle =
            oracle_of(scene, size.width, size.height, samples, options(size, samples).background);
        for (const Rgba64& c : oracle.color) partly += c.a > 0.51 && c.a < 0.99;
        LayerProgram program(scene, size.width, size.height);
        bool good = true;
        for (auto& family : by_isa) {
          std::optional<LayerPicture> first;
          for (Painter& renderer : family) {
            LayerPicture picture = take(renderer, program);
            const testing::AssertionResult r =
                first ? same_bits(picture, *first) : equals_oracle(picture, oracle);
            EXPECT_TRUE(r) << title_of(renderer);
            good = good && r;
            if (!first) first = std::move(picture);
          }
        }
        if (!good && ++failures == 3) FAIL() << "three scenes failed; the rest was not drawn";
      }
    }
    // Edges are smooth: some pixels are partly covered, over a half-transparent background.
    EXPECT_GT(partly, 1000U);
  }
};

TEST_P(Samples, LayersEqualTheOracle) {
  expect_exact(Surfaces::as_generated);
}

TEST_P(Samples, OpaqueSurfacesEqualTheOracle) {
  expect_exact(Surfaces::all_opaque);
}

INSTANTIATE_TEST_SUITE_P(Standard, Samples, testing::Values(4, 8, 16),
                         [](const auto& p) { return std::to_string(p.param); });

// The serial device, which is deliberately plain, draws the same; also without sorting.
class Serial : public Samples {};

TEST_P(Serial, EqualsTheOracleAndThreads) {
  const int samples = GetParam();
  const Size size{37, 53};
  const int scenes = share_of(40, kLayerKinds);
  for (const Transparency method : {Transparency::exact, Transparency::unsorted}) {
    RenderOptions o = options(size, samples);
    o.transparency.method = method;
    o.isa = Isa::scalar;
    o.threads = 2;
    Painter threads(o);
    o.device = Device::serial;
    Painter serial(o);
    const LayerOrder order =
        method == Transparency::exact ? LayerOrder::depth : LayerOrder::submission;
    for (int i = 0; i < scenes; ++i) {
      const LayerScene scene = generate_layers(static_cast<std::uint64_t>(i) + 83000, size.width,
                                               size.height, 100000 / samples);
      SCOPED_TRACE(title_of(static_cast<std::uint64_t>(i), scene));
      LayerProgram program(scene, size.width, size.height);
      const LayerPicture picture = take(serial, program);
      ASSERT_TRUE(equals_oracle(
          picture, oracle_of(scene, size.width, size.height, samples, o.background, order)));
      ASSERT_TRUE(same_bits(picture, take(threads, program)));
    }
  }
}

// Overlapping pieces of a clipped triangle are one layer.
TEST_P(Serial, OverlappingPiecesAreOneLayerEverywhere) {
  const Size size{64, 64};
  const LayerScene scene = overlapping_pieces();
  LayerProgram program(scene, size.width, size.height);
  for (const Transparency method : {Transparency::exact, Transparency::unsorted}) {
    RenderOptions o = options(size, GetParam());
    o.transparency.method = method;
    o.device = Device::serial;
    Painter serial(o);
    const LayerPicture expected = take(serial, program);
    o.device = Device::threads;
    for (const Isa isa : available_isas()) {
      o.isa = isa;
      Painter threads(o);
      const LayerPicture picture = take(threads, program);
      ASSERT_TRUE(same_bits(expected, picture));
      // No pixel has a triangle twice.
      EXPECT_LE(picture.counter("deepest"), scene.size());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Standard, Serial, testing::Values(1, 4, 8, 16),
                         [](const auto& p) { return std::to_string(p.param); });

/// The other targets (frame.hpp) have the values of the sample with the largest key: that of a
/// frame with one sample, whose scene is moved so that this sample is at the pixels' centres.
TEST_P(Samples, TheOtherTargetsAreOfTheNearestSample) {
  constexpr int kSide = 64;
  const Camera camera = pixel_camera(kSide, kSide);
  const Mat4 to_clip(world_to_clip(camera, kSide, kSide));
  // Two tilted triangles through each other, and slivers between the pixels' centres.
  std::vector<Vec3> corners{
      at_pixel(3, 5, 0.2, kSide, kSide),   at_pixel(60, 9, 0.9, kSide, kSide),
      at_pixel(20, 61, 0.5, kSide, kSide), at_pixel(5, 50, 0.9, kSide, kSide),
      at_pixel(62, 55, 0.3, kSide, kSide), at_pixel(30, 2, 0.4, kSide, kSide)};
  // On the snapping grid, so that only the sample moves them.
  for (int i = 0; i < 5; ++i)
    for (const Vec2 p : {Vec2{40.5625F, 8}, {40.9375F, 8}, {40.75F, 60}})
      corners.push_back(at_pixel(double{p.x} + 5 * i, double{p.y}, 0.95, kSide, kSide));
  const auto moved = [&](raster::SampleOffset by) {
    std::vector<Vec3> all = corners;
    const Vec3 from = at_pixel(0, 0, 0, kSide, kSide);
    const Vec3 to = at_pixel(-by.x / 256.0, -by.y / 256.0, 0, kSide, kSide);
    for (Vec3& p : all) p = p + (to - from);
    return all;
  };
  struct Place {
    float x = 0;
    Place operator+(const Place& o) const { return {x + o.x}; }
    Place operator*(float s) const { return {x * s}; }
  };
  struct Pictures : Frame {
    Pictures() : Frame(kSide, kSide, kVisible | kOverdraw) {}
    Image<std::uint64_t> keys{kSide, kSide};
    Image<Vec4> extra{kSide, kSide};
  };
  const auto draw = [&](Device device, int samples, const std::vector<Vec3>& positions) {
    const Program program(
        [&](std::uint32_t i) {
          return VertexOutput<Place>{transform_point(to_clip, positions[i]),
                                     {positions[i].x + kSide / 2.0F}};
        },
        [](const Place& p, const Fragment& f) {
          return std::array{Vec4{1, 1, 1, 1}, Vec4{p.x, f.depth, static_cast<float>(f.id), 1}};
        });
    RenderOptions o = options({kSide, kSide}, samples);
    o.device = device;
    raster::Draw d = program.draw(positions.size());
    Pictures p;
    const std::array extra{p.extra.view()};
    Targets targets = p.targets();
    targets.keys = p.keys;
    targets.extra = extra;
    Painter(o).draw({&d, 1}, targets);
    return p;
  };
  for (const Device device : {Device::serial, Device::threads}) {
    const Pictures got = draw(device, GetParam(), corners);
    Image<std::uint64_t> nearest(kSide, kSide);
    Image<std::uint32_t> overdraw(kSide, kSide);
    for (const raster::SampleOffset offset : raster::sample_offsets(GetParam())) {
      const Pictures one = draw(Device::serial, 1, moved(offset));
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
          nearest(x, y) = std::max(nearest(x, y), one.keys(x, y));
          overdraw(x, y) += one.overdraw(x, y);
        }
    }
    const Pictures at_centres = draw(Device::serial, 1, corners);
    int beyond = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        SCOPED_TRACE(std::to_string(x) + ", " + std::to_string(y));
        const std::uint64_t key = got.keys(x, y);
        ASSERT_EQ(key, nearest(x, y));
        ASSERT_EQ(got.overdraw(x, y), overdraw(x, y));
        ASSERT_EQ(got.ids(x, y), key == 0 ? -1 : static_cast<std::int64_t>(raster::id_of_key(key)));
        const float depth =
            std::bit_cast<float>(static_cast<std::uint32_t>(key >> raster::kIdBits));
        ASSERT_EQ(got.depth(x, y), depth);
        const Vec4 extra = got.extra(x, y);
        if (key == 0) {
          ASSERT_EQ(extra.w, 0);
          continue;
        }
        // Values are the pixel centre's. A surface that misses the centre has values within its
        // corners.
        const bool at_centre = at_centres.ids(x, y) == got.ids(x, y);
        const std::size_t corner = static_cast<std::size_t>(got.ids(x, y)) * 3;
        const auto [low, high] =
            std::minmax({corners[corner].x, corners[corner + 1].x, corners[corner + 2].x});
        ASSERT_NEAR(extra.x, static_cast<float>(x) + 0.5F, at_centre ? 1e-3F : 1.0F);
        ASSERT_GE(extra.x, low + kSide / 2.0F - 1e-3F);
        ASSERT_LE(extra.x, high + kSide / 2.0F + 1e-3F);
        ASSERT_EQ(extra.y, depth);
        ASSERT_EQ(extra.z, static_cast<float>(got.ids(x, y)));
        beyond += !at_centre;
      }
    EXPECT_GT(beyond, 50);  // pixels with another surface, or none, at the centre
  }
}

}  // namespace
}  // namespace rastrum::test::samples_test
