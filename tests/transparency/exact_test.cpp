// SPDX-License-Identifier: BSD-3-Clause
// Exact transparency equals, in every pixel of every scene, a sort of all fragments by visibility
// key blended in float64. It has the same bits for all threads, rasterizers, tile sizes and, up to
// ties, orders of triangles.
#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/random.hpp"
#include "tests/support/test_share.hpp"
#include "tests/transparency/exactness.hpp"

namespace rastrum::test::exact_test {
namespace {

/// Renderers that must draw the same bits: rasterizers that own tiles, with all tile sizes and 1, 2
/// and 8 threads; on each instruction set.
std::vector<RenderOptions> relatives(const RenderOptions& base, Isa isa) {
  struct Way {
    const char* rasterizer;
    int bin_px, tile_px;
  };
  std::vector<RenderOptions> all;
  const auto add = [&](const Way& way, int threads) {
    RenderOptions o = base;
    o.isa = isa;
    o.rasterizer = way.rasterizer;
    o.tuning.bin_px = way.bin_px;
    o.tuning.tile_px = way.tile_px;
    o.threads = threads;
    all.push_back(o);
  };
  for (const int threads : {1, 2, 8}) {
    add({"grouped", 0, 0}, threads);
    add({"tiled", 0, 0}, threads);
  }
  for (const Way& way : {Way{"tiled", 16, 4}, {"tiled", 64, 16}, {"tiled", 128, 8}}) add(way, 2);
  return all;
}

struct Size {
  int width, height;
  Vec4 background;
};
void PrintTo(const Size& size, std::ostream* out) {
  *out << size.width << " x " << size.height;
}

RenderOptions options(const Size& size) {
  return RenderOptions({.width = size.width, .height = size.height, .background = size.background});
}

// Around the block (8) and the bin (64); the deepest scenes use the smallest.
constexpr Size kSizes[] = {
    {1, 1, {0, 0, 0, 0}},         {8, 8, {1, 1, 1, 1}},     {17, 5, {0.2F, 0.3F, 0.4F, 0.5F}},
    {37, 53, {0, 0, 0, 0}},       {64, 64, {0, 0, 0, 1}},   {100, 20, {0.9F, 0.1F, 0.5F, 0.25F}},
    {65, 33, {0.5F, 0, 0.5F, 1}}, {160, 120, {0, 0, 0, 0}},
};

LayerImage oracle_of(const LayerScene& scene, const Size& size) {
  return test::oracle_of(scene, size.width, size.height, 1, size.background);
}

/// Scenes per size: ten of each kind. With a small test share, the sizes share the kinds.
int scene_count() {
  if (test_share() < 100) return 2 + kLayerKinds / static_cast<int>(std::size(kSizes));
  return share_of(10 * kLayerKinds);
}

class Exact : public testing::TestWithParam<Size> {};

/// Each size has scenes of its own.
std::uint64_t seed_of(const Size& size, int i) {
  return static_cast<std::uint64_t>(i) + static_cast<std::uint64_t>(size.width) * 1000000;
}

TEST_P(Exact, EqualsTheOracleEverywhere) {
  const Size size = GetParam();
  std::vector<std::vector<Painter>> by_isa;
  for (const Isa isa : available_isas()) {
    auto& family = by_isa.emplace_back();
    for (const RenderOptions& o : relatives(options(size), isa)) family.emplace_back(o);
  }
  int failures = 0;
  std::uint32_t most_layers = 0;
  std::map<std::string, std::uint64_t> fragments_of_kind;
  for (int i = 0; i < scene_count(); ++i) {
    const std::uint64_t seed = seed_of(size, i);
    const LayerScene scene = generate_layers(seed, size.width, size.height);
    SCOPED_TRACE(title_of(seed, scene));
    const LayerQuestion question(scene, size.width, size.height, 1, size.background);
    const LayerImage oracle = blend_layers(question.input(), LayerOrder::depth);
    const OracleImage surfaces = brute_force(size.width, size.height, question.pieces.triangles);
    const std::uint64_t fragments =
        std::accumulate(oracle.layers.begin(), oracle.layers.end(), std::uint64_t{0});
    most_layers = std::max(most_layers, oracle.most_layers());
    fragments_of_kind[scene.kind.substr(0, scene.kind.find('/'))] += fragments;
    LayerProgram program(scene, size.width, size.height);
    bool good = true;
    const auto expect = [&good](const testing::AssertionResult& r, const std::string& what) {
      EXPECT_TRUE(r) << what;
      good = good && r;
    };
    // Each instruction set against the oracle; the whole family on one of them in turn.
    for (std::size_t isa = 0; isa < by_isa.size(); ++isa) {
      auto& family = by_isa[isa];
      const bool whole = static_cast<std::size_t>(i) % by_isa.size() == isa;
      std::optional<LayerPicture> first;
      for (Painter& renderer : std::span(family).first(whole ? family.size() : 1)) {
        const std::string name = title_of(renderer);
        const bool counts = first && &renderer == &family.back();
        LayerPicture picture = take(renderer, program, counts);
        if (counts)
          expect(std::ranges::equal(picture.overdraw.pixels(), surfaces.overdraw)
                     ? testing::AssertionSuccess()
                     : testing::AssertionFailure() << "overdraw",
                 name);
        if (!first) {
          expect(equals_oracle(picture, oracle), name);
          EXPECT_EQ(picture.error_pixels(), picture.counter("repaired pixels")) << name;
          if (picture.counter("translucent fragments") != fragments ||
              picture.counter("deepest") != oracle.most_layers())
            expect(testing::AssertionFailure()
                       << "fragments " << picture.counter("translucent fragments") << " and "
                       << fragments << ", deepest " << picture.counter("deepest") << " and "
                       << oracle.most_layers(),
                   name);
          first = std::move(picture);
          continue;
        }
        expect(same_bits(picture, *first), name + " and " + title_of(family[0]));
      }
    }
    if (!good && ++failures == 3) FAIL() << "three scenes failed; the rest was not drawn";
  }
  // Each kind of scene must have visible fragments.
  if (size.width < 8 || scene_count() < 10 * kLayerKinds) return;
  EXPECT_EQ(fragments_of_kind.size(), static_cast<std::size_t>(kLayerKinds));
  for (const auto& [kind, fragments] : fragments_of_kind) EXPECT_GT(fragments, 0U) << kind;
  EXPECT_GT(most_layers, size.width <= 17 ? 1000U : 10U);
}

// A translucent picture's ids and depths are those of opaque surfaces.
TEST_P(Exact, IdsAndDepthAreThoseOfOpaqueSurfaces) {
  const Size size = GetParam();
  Painter renderer(options(size));
  for (int i = 0; i < 4 * kLayerKinds; ++i) {
    LayerScene scene = generate_layers(seed_of(size, i), size.width, size.height);
    SCOPED_TRACE(scene.kind);
    LayerProgram program(scene, size.width, size.height);
    const LayerPicture translucent = take(renderer, program);
    for (raster::Draw& draw : program.draws()) draw.flags &= ~kTranslucent;
    const LayerPicture opaque = take(renderer, program);
    EXPECT_TRUE(same_images(translucent, opaque, kVisible));
    EXPECT_EQ(translucent.stats.pixels_covered, opaque.stats.pixels_covered);
  }
}

/// The triangles of `scene` in another order; element i of the result was order[i].
LayerScene reordered(const LayerScene& scene, const std::vector<std::size_t>& order) {
  LayerScene out = scene;
  out.mesh.indices.clear();
  out.colors.clear();
  out.opaque.clear();
  out.corner_colors.clear();
  for (const std::size_t t : order) {
    out.add(scene.mesh.indices[3 * t], scene.mesh.indices[3 * t + 1], scene.mesh.indices[3 * t + 2],
            scene.colors[t], scene.opaque[t] != 0);
    for (std::size_t c = 3 * t; c < 3 * t + 3 && !scene.corner_colors.empty(); ++c)
      out.corner_colors.push_back(scene.corner_colors[c]);
  }
  return out;
}

TEST_P(Exact, OrderOfSubmissionDecidesOnlyTies) {
  const Size size = GetParam();
  Painter renderer(options(size));
  std::uint64_t compared = 0, tied = 0, seen = 0;
  for (int i = 0; i < 4 * kLayerKinds; ++i) {
    LayerScene scene = generate_layers(seed_of(size, i), size.width, size.height);
    SCOPED_TRACE(scene.kind);
    scene.holes = false;  // holes and Paint::pixel depend on ids
    if (scene.paint == Paint::pixel) scene.paint = Paint::triangle;
    const LayerImage oracle = oracle_of(scene, size);
    std::vector<std::size_t> order(scene.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    Random r(static_cast<std::uint64_t>(i));
    for (std::size_t k = order.size(); k > 1; --k)
      std::swap(order[k - 1], order[static_cast<std::size_t>(r.integer(0, int(k) - 1))]);
    // Opaque triangles first or last, so that there are few draws.
    const bool first = r.chance(0.5);
    std::stable_partition(order.begin(), order.end(),
                          [&](std::size_t t) { return (scene.opaque[t] != 0) == first; });
    const LayerScene shuffled = reordered(scene, order);
    LayerProgram before(scene, size.width, size.height);
    LayerProgram after(shuffled, size.width, size.height);
    const LayerPicture a = take(renderer, before), b = take(renderer, after);
    for (std::size_t p = 0; p < oracle.ids.size(); ++p) {
      ASSERT_EQ(a.depth.pixels()[p], b.depth.pixels()[p]);
      if (oracle.tied[p] != 0) {
        ++tied;
        continue;
      }
      ++compared;
      seen += oracle.layers[p] > 1;
      ASSERT_TRUE(same_color_bits(a, b, p)) << "pixel " << p;
      const std::int64_t id = b.ids.pixels()[p];
      ASSERT_EQ(a.ids.pixels()[p],
                id < 0 ? -1 : static_cast<std::int64_t>(order[static_cast<std::size_t>(id)]));
    }
  }
  EXPECT_GT(tied, 0U);
  EXPECT_GT(compared, tied);
  EXPECT_GT(seen, 0U);
}

// The same renderer twice, after other scenes.
TEST_P(Exact, NothingOfAnEarlierFrameIsLeft) {
  const Size size = GetParam();
  Painter used(options(size));
  for (int i = 0; i < 2 * kLayerKinds; ++i) {
    const LayerScene scene = generate_layers(seed_of(size, i), size.width, size.height);
    SCOPED_TRACE(scene.kind);
    LayerProgram program(scene, size.width, size.height);
    Painter fresh(options(size));
    const LayerPicture expected = take(fresh, program);
    const LayerPicture first = take(used, program), again = take(used, program);
    EXPECT_TRUE(same_bits(first, expected));
    EXPECT_TRUE(same_bits(again, expected));
    for (const auto& [counter, value] : again.stats.counters)
      EXPECT_EQ(value, expected.counter(counter)) << counter;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Exact, testing::ValuesIn(kSizes), [](const auto& p) {
  return std::to_string(p.param.width) + "x" + std::to_string(p.param.height);
});

// Bins with thousands of triangles are drawn in parts, also if those cover few samples.
TEST(ExactBins, DenseOnesEqualTheOracle) {
  const Size size{100, 70, {0.5F, 0.5F, 0.5F, 1}};
  LayerScene scene;
  scene.mesh = shapes::soup(20000, 0.01F, 0.3F);
  scene.camera.eye = {0, 0, 3};
  Random r(6);
  for (std::uint32_t t = 0; t < 20000; ++t) {
    const auto channel = [&] { return 0.1F * static_cast<float>(r.real(0, 1)); };
    const Vec4 color{channel(), channel(), channel(), 0.1F};
    scene.add(3 * t, 3 * t + 1, 3 * t + 2, color);
  }
  const LayerImage oracle = oracle_of(scene, size);
  EXPECT_GT(oracle.most_layers(), 50U);
  LayerProgram program(scene, size.width, size.height);
  for (const Isa isa : available_isas())
    for (const RenderOptions& o : relatives(options(size), isa)) {
      Painter renderer(o);
      ASSERT_TRUE(equals_oracle(take(renderer, program), oracle)) << title_of(renderer);
    }
}

LayerPicture picture_of(const LayerScene& scene, const Size& size) {
  LayerProgram program(scene, size.width, size.height);
  Painter renderer(options(size));
  return take(renderer, program);
}

// Light without alpha adds up and hides nothing behind it.
TEST(ExactColours, ColourWithoutAlphaIsAdded) {
  const Size size{16, 16, {0, 0, 0, 1}};
  LayerScene scene = layer_stack(3, 3, 0.5, size.width, size.height);
  for (std::size_t i = 0; i < scene.size(); ++i) scene.colors[i] = {0.25F, 0, 0.125F, 0};
  EXPECT_EQ(picture_of(scene, size).color(5, 5), (Vec4{0.75F, 0, 0.375F, 1}));
}

// A colour over nothing keeps its hue, however faint.
TEST(ExactColours, FaintLayersKeepTheirHue) {
  const Size size{16, 16, {0, 0, 0, 0}};
  for (const float alpha : {1e-3F, 1e-6F, 1e-9F}) {
    LayerScene scene = layer_stack(4, 5, 0.5, size.width, size.height);
    for (Vec4& color : scene.colors) color = {0.8F * alpha, 0.4F * alpha, 0.2F * alpha, alpha};
    const LayerPicture picture = picture_of(scene, size);
    const Rgba8 c = picture.color8(5, 5);
    EXPECT_EQ((Rgba8{204, 102, 51, c.a}), c) << alpha;
    EXPECT_NEAR(picture.color(5, 5).w / (5 * alpha), 1, 0.01) << alpha;
  }
}

}  // namespace
}  // namespace rastrum::test::exact_test
