// Several samples a pixel: each equals a sort of its own fragments, a triangle has one colour in a
// pixel, and the pixel is the mean. For translucent, opaque and mixed surfaces.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/core/error.hpp>
#include <rastrum/render/render.hpp>

#include "tests/support/environment.hpp"
#include "tests/support/layer_picture.hpp"
#include "tests/support/layer_program.hpp"
#include "tests/support/layer_scenes.hpp"

namespace rastrum::test {
namespace {

struct Size {
  int width, height;
};
constexpr Size kSizes[] = {{1, 1}, {8, 8}, {37, 53}, {65, 33}, {130, 70}};

RenderOptions options(Size size, int samples) {
  RenderOptions o;
  o.width = size.width;
  o.height = size.height;
  o.samples = samples;
  o.background = {0.2F, 0.6F, 0.4F, 0.5F};
  return o;
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
  void SetUp() override {
    try {
      Renderer probe(options({8, 8}, GetParam()));
    } catch (const Error& e) {
      GTEST_SKIP() << "no " << GetParam() << " samples here: " << e.what();
    }
  }

  void expect_exact(Surfaces surfaces) {
    const int samples = GetParam();
    const int scenes =
        std::max(count_from_environment("RASTRUM_FAMILY_SCENES", 10000) / 250, kLayerKinds);
    int failures = 0;
    std::uint64_t partly = 0;
    for (const Size size : kSizes) {
      std::vector<std::vector<std::pair<std::string, Renderer>>> by_isa;
      for (const Isa isa : available_isas()) {
        auto& family = by_isa.emplace_back();
        for (const auto& [rasterizer, threads] :
             {std::pair{"grouped", 1}, {"grouped", 8}, {"tiled", 2}}) {
          if (threads > 1 && isa != available_isas().back()) continue;
          RenderOptions o = options(size, samples);
          o.isa = isa;
          o.rasterizer = rasterizer;
          o.threads = threads;
          std::string title = rasterizer;
          title.append(", ").append(std::to_string(threads)).append(", ").append(name(isa));
          family.emplace_back(std::move(title), Renderer(o));
        }
      }
      for (int i = 0; i < scenes; ++i) {
        const LayerScene scene = scene_of(i, size, samples, surfaces);
        SCOPED_TRACE("scene " + std::to_string(i) + " (" + scene.kind + "), " +
                     std::to_string(size.width));
        const LayerQuestion question(scene, size.width, size.height, samples,
                                     options(size, samples).background);
        const LayerImage oracle = blend_layers(question.input(), LayerOrder::depth);
        for (const Rgba64& c : oracle.color) partly += c.a > 0.51 && c.a < 0.99;
        LayerProgram program(scene, size.width, size.height);
        bool good = true;
        for (auto& family : by_isa) {
          std::optional<LayerPicture> first;
          for (auto& [title, renderer] : family) {
            LayerPicture picture = take(renderer, program);
            const testing::AssertionResult r =
                first ? same_bits(picture, *first) : equals_oracle(picture, oracle);
            EXPECT_TRUE(r) << title;
            good = good && r;
            if (!first) first = std::move(picture);
          }
        }
        if (!good && ++failures == 3) FAIL() << "three scenes failed; the rest was not drawn";
      }
    }
    // Edges are smooth: over half of a background some pixels are covered in part.
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

// The serial device, which is written for plainness, draws the same; also without sorting.
class Serial : public Samples {};

TEST_P(Serial, EqualsTheOracleAndThreads) {
  const int samples = GetParam();
  const Size size{37, 53};
  const int scenes =
      std::max(count_from_environment("RASTRUM_FAMILY_SCENES", 10000) / 250, kLayerKinds);
  for (const Transparency method : {Transparency::exact, Transparency::unsorted}) {
    RenderOptions o = options(size, samples);
    o.transparency.method = method;
    o.isa = Isa::scalar;
    o.threads = 2;
    Renderer threads(o);
    o.device = Device::serial;
    Renderer serial(o);
    const LayerOrder order =
        method == Transparency::exact ? LayerOrder::depth : LayerOrder::submission;
    for (int i = 0; i < scenes; ++i) {
      const LayerScene scene = generate_layers(static_cast<std::uint64_t>(i) + 83000, size.width,
                                               size.height, 100000 / samples);
      SCOPED_TRACE("scene " + std::to_string(i) + " (" + scene.kind + ")");
      const LayerQuestion question(scene, size.width, size.height, samples, o.background);
      LayerProgram program(scene, size.width, size.height);
      const LayerPicture picture = take(serial, program);
      ASSERT_TRUE(equals_oracle(picture, blend_layers(question.input(), order)));
      ASSERT_TRUE(same_bits(picture, take(threads, program)));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Standard, Serial, testing::Values(1, 4, 8, 16),
                         [](const auto& p) { return std::to_string(p.param); });

}  // namespace
}  // namespace rastrum::test
