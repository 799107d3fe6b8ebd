// SPDX-License-Identifier: BSD-3-Clause
// Methods that are not exact. Unsorted blending equals an oracle that does the same. Paper 4's
// filter is right except at marked pixels, and the marks are counted. An alpha threshold costs no
// more than it allows.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/family.hpp>
#include <rastrum/render.hpp>

#include "tests/support/test_share.hpp"
#include "tests/transparency/exactness.hpp"

namespace rastrum::test::filter_test {
namespace {

constexpr int kWidth = 48, kHeight = 40;
/// Slightly more than the least memory for a picture.
constexpr std::uint64_t kLittleMemory = std::uint64_t{5} << 19;

RenderOptions options(const TransparencyOptions& method) {
  RenderOptions o({.width = kWidth, .height = kHeight, .background = {0.2F, 0.6F, 0.4F, 0.5F}});
  o.transparency = method;
  o.threads = 2;
  return o;
}

int scene_count() {
  return share_of(200, 2 * kLayerKinds);
}

/// Calls f(i, scene, program) for the first `count` scenes.
template <class F>
void for_each_scene(int count, const F& f, int first = 0, int step = 1) {
  for (int i = first; i < count; i += step) {
    const LayerScene scene =
        generate_layers(static_cast<std::uint64_t>(i) + 7000000, kWidth, kHeight);
    SCOPED_TRACE(title_of(static_cast<std::uint64_t>(i), scene));
    LayerProgram program(scene, kWidth, kHeight);
    f(i, scene, program);
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(Unsorted, EqualsTheOracleThatBlendsAsSubmitted) {
  RenderOptions o = options({.method = Transparency::unsorted});
  // Each instruction set draws a scene in one way, and one of them draws it in all; both take
  // turns.
  constexpr std::size_t kWays = 4;
  std::vector<std::vector<Painter>> by_isa;
  for (const Isa isa : available_isas()) {
    auto& ways = by_isa.emplace_back();
    for (const char* const rasterizer : {"grouped", "tiled"})
      for (const int threads : {1, 8}) {
        o.isa = isa;
        o.rasterizer = rasterizer;
        o.threads = threads;
        ways.emplace_back(o);
      }
    ASSERT_EQ(ways.size(), kWays);
  }
  std::uint64_t unlike_exact = 0;
  for_each_scene(scene_count(), [&](int i, const LayerScene& scene, LayerProgram& program) {
    const LayerImage oracle =
        oracle_of(scene, kWidth, kHeight, 1, o.background, LayerOrder::submission);
    const LayerImage exact = oracle_of(scene, kWidth, kHeight, 1, o.background);
    for (std::size_t p = 0; p < oracle.color.size(); ++p)
      unlike_exact += std::abs(oracle.color[p].r - exact.color[p].r) > 0.01;
    const auto turn = static_cast<std::size_t>(i);
    for (std::size_t isa = 0; isa < by_isa.size(); ++isa)
      for (std::size_t way = 0; way < kWays; ++way) {
        if (isa != turn % by_isa.size() && way != turn / by_isa.size() % kWays) continue;
        Painter& renderer = by_isa[isa][way];
        ASSERT_TRUE(equals_oracle(take(renderer, program), oracle)) << title_of(renderer);
      }
  });
  EXPECT_GT(unlike_exact, 1000U);
}

TEST(DepthFilter, IsRightWhereItMarksNothing) {
  Painter exact(options({.method = Transparency::exact}));
  // Blocks with more fragments than fit go by planes, which are filtered and then repaired.
  RenderOptions with_little_memory = options({.method = Transparency::exact});
  with_little_memory.memory_limit = kLittleMemory;
  Painter repairing(with_little_memory);
  const int sizes[] = {1, 3, 8, 64};
  std::vector<Painter> filters;
  for (const int k : sizes) filters.emplace_back(options(family::filtered(k)));
  std::uint64_t wrong[4] = {}, differing = 0, repaired = 0;
  for_each_scene(scene_count(), [&](int, const LayerScene&, LayerProgram& program) {
    const LayerPicture right = take(exact, program);
    EXPECT_EQ(right.counter("repaired pixels"), 0U);
    EXPECT_EQ(right.error_pixels(), 0U);
    EXPECT_EQ(right.counter("wrong pixels"), 0U);
    const LayerPicture mended = take(repairing, program);
    repaired += mended.counter("repaired pixels");
    EXPECT_EQ(mended.counter("repaired pixels"), mended.error_pixels());
    EXPECT_TRUE(std::ranges::equal(mended.color8.pixels(), right.color8.pixels()));
    const std::uint64_t deepest = right.counter("deepest");
    for (std::size_t f = 0; f < filters.size(); ++f) {
      const LayerPicture picture = take(filters[f], program);
      const std::uint64_t marked = picture.counter("wrong pixels");
      EXPECT_EQ(marked, picture.error_pixels());
      EXPECT_EQ(picture.counter("repaired pixels"), 0U);
      wrong[f] += marked;
      // An insertion that looks back over K fragments sorts K + 1.
      if (static_cast<std::uint64_t>(sizes[f]) >= deepest) {
        EXPECT_EQ(marked, 0U);
      }
      for (std::size_t p = 0; p < picture.ids.pixels().size(); ++p) {
        const bool same = same_color_bits(picture, right, p);
        if (picture.errors.pixels()[p] == 0) {
          ASSERT_TRUE(same) << "filter " << sizes[f] << ", pixel " << p;
        } else {
          ASSERT_EQ(picture.errors.pixels()[p], 255);
          differing += !same;
        }
      }
      EXPECT_TRUE(same_images(picture, right, kVisible));
    }
  });
  // Marks find real errors, and a longer filter makes fewer.
  EXPECT_GT(differing, 1000U);
  EXPECT_GT(repaired, 1000U);
  EXPECT_GT(wrong[0], wrong[1]);
  EXPECT_GT(wrong[1], wrong[2]);
  EXPECT_GE(wrong[2], wrong[3]);
}

// Fragments of a region, of a block, or planes of a block: the same order, right or wrong.
TEST(DepthFilter, IsTheSameHoweverManyFragmentsGoTogether) {
  std::uint64_t marked = 0, by_planes = 0;
  for (const int k : {1, 3, 8}) {
    RenderOptions o = options(family::filtered(k));
    Painter whole(o);
    o.memory_limit = kLittleMemory;
    Painter parts(o);
    o.transparency = {};
    Painter repairing(o);
    SCOPED_TRACE(k);
    for_each_scene(scene_count(), [&](int, const LayerScene&, LayerProgram& program) {
      const LayerPicture a = take(whole, program), b = take(parts, program);
      // Later walks begin with what memory holds.
      if (b.counter("windows") != 0) return;
      EXPECT_TRUE(same_images(a, b));
      marked += a.error_pixels();
      by_planes += take(repairing, program).counter("repaired pixels");
    });
  }
  EXPECT_GT(marked, 1000U);
  EXPECT_GT(by_planes, 100U);
}

// The marks do not depend on the threads. The picture has several bins, else one thread would draw
// it.
TEST(DepthFilter, MarksDoNotDependOnThreads) {
  constexpr int kWide = 200, kHigh = 150;
  for (const char* const rasterizer : {"grouped", "tiled"}) {
    RenderOptions o = options(family::filtered(1));
    o.width = kWide;
    o.height = kHigh;
    o.rasterizer = rasterizer;
    o.threads = 1;
    Painter one(o);
    o.threads = 8;
    Painter eight_threads(o);
    std::uint64_t marked = 0;
    for (int i = 0; i < 2 * kLayerKinds; ++i) {
      const LayerScene scene =
          generate_layers(static_cast<std::uint64_t>(i) + 7100000, kWide, kHigh);
      SCOPED_TRACE(scene.kind + " " + rasterizer);
      LayerProgram program(scene, kWide, kHigh);
      const LayerPicture a = take(one, program), b = take(eight_threads, program);
      EXPECT_TRUE(same_images(a, b));
      marked += a.error_pixels();
    }
    EXPECT_GT(marked, 1000U) << rasterizer;
  }
}

// A threshold may only remove the light that a nearly opaque pixel still transmits.
TEST(AlphaThreshold, CostsNoMoreThanItLetsThrough) {
  Painter exact(options({.method = Transparency::exact}));
  std::uint64_t changed = 0;
  for (const float threshold : {1 - 1.0F / 128, 0.75F}) {
    RenderOptions o = options({.method = Transparency::exact});
    o.transparency.alpha_threshold = threshold;
    Painter early(o);
    const double through = 1 - double{threshold};
    for_each_scene(scene_count(), [&](int, const LayerScene&, LayerProgram& program) {
      const LayerPicture a = take(exact, program), b = take(early, program);
      EXPECT_TRUE(same_images(a, b, kVisible));
      for (std::size_t p = 0; p < a.ids.pixels().size(); ++p) {
        const Vec4 x = a.color.pixels()[p], y = b.color.pixels()[p];
        const double off = std::max(
            {std::abs(x.x - y.x), std::abs(x.y - y.y), std::abs(x.z - y.z), std::abs(x.w - y.w)});
        ASSERT_LE(off, through + 1e-6) << "pixel " << p;
        changed += off > 0;
        // Straight colours with a nearly opaque alpha, each rounded to 8 bits.
        const Rgba8 u = a.color8.pixels()[p], v = b.color8.pixels()[p];
        const int steps = std::max(
            {std::abs(u.r - v.r), std::abs(u.g - v.g), std::abs(u.b - v.b), std::abs(u.a - v.a)});
        ASSERT_LE(steps, 255 * 2 * through + 1) << "pixel " << p;
      }
    });
  }
  EXPECT_GT(changed, 1000U);
}

/// The colours of a program with one alpha, with or without telling so, and the number of shaded
/// fragments.
class OneAlpha final : public raster::BlockShader {
 public:
  OneAlpha(const raster::BlockShader& inner, float alpha, bool says)
      : inner_(inner), alpha_(alpha), says_(says) {}

  bool shade(const raster::FrameGeometry& frame, const raster::VisibleBlock& block, Isa isa,
             raster::BlockColors& colors) const noexcept override {
    (void)inner_.shade(frame, block, isa, colors);
    for (int i = 0; i < 64; ++i) {
      for (float* const channel : {colors.r, colors.g, colors.b}) channel[i] *= alpha_;
      colors.a[i] = alpha_;
    }
    shaded_ += static_cast<std::uint64_t>(std::popcount(block.covered));
    return false;
  }
  [[nodiscard]] std::optional<float> alpha() const noexcept override {
    return says_ ? std::optional(alpha_) : std::nullopt;
  }
  [[nodiscard]] std::size_t scratch_bytes() const noexcept override {
    return inner_.scratch_bytes();
  }
  [[nodiscard]] std::uint64_t shaded() const { return shaded_; }

 private:
  const raster::BlockShader& inner_;
  const float alpha_;
  const bool says_;
  mutable std::atomic<std::uint64_t> shaded_ = 0;
};

// The same layers are left out as on the serial device, which walks them one by one, and they are
// not shaded.
TEST(AlphaThreshold, LeavesOutTheSameLayersHoweverTheyAreShaded) {
  constexpr float kAlphas[] = {0.02F, 0.3F, 0.5F, 0.9F, 1.0F};
  std::uint64_t all = 0, said = 0, not_said = 0;
  // With a small share each kind has one of the two.
  const int step = test_share() < 100 ? 2 : 1;
  int first = 0;
  for (const float threshold : {1 - 1.0F / 128, 0.75F}) {
    RenderOptions o = options({.method = Transparency::exact});
    Painter exact(o);
    o.transparency.alpha_threshold = threshold;
    std::vector<Painter> renderers;
    for (const Isa isa : available_isas()) {
      o.isa = isa;
      renderers.emplace_back(o);
    }
    o.isa.reset();
    o.memory_limit = kLittleMemory;
    renderers.emplace_back(o);
    o.memory_limit = 0;
    o.device = Device::serial;
    Painter serial(o);
    const auto expect = [&](int i, const LayerScene& scene, LayerProgram& program) {
      const LayerPicture own = take(serial, program);
      for (Painter& renderer : renderers) EXPECT_TRUE(same_bits(take(renderer, program), own));
      const OneAlpha says(program.shader(), kAlphas[i % 5], true);
      const OneAlpha is_silent(program.shader(), kAlphas[i % 5], false);
      const OneAlpha everywhere(program.shader(), kAlphas[i % 5], true);
      const LayerPicture expected = take(serial, program, everywhere);
      const std::uint64_t before = everywhere.shaded();
      (void)take(exact, program, everywhere);
      const std::uint64_t exactly = everywhere.shaded() - before;
      all += exactly * renderers.size();
      for (Painter& renderer : renderers) {
        EXPECT_TRUE(same_bits(take(renderer, program, says), expected)) << kAlphas[i % 5];
        EXPECT_TRUE(same_bits(take(renderer, program, is_silent), expected)) << kAlphas[i % 5];
      }
      // Each pixel takes at most `most` layers. Opaque surfaces are always shaded.
      std::uint32_t most = 0;
      for (float through = 1; through > 1 - threshold; ++most) through *= 1 - kAlphas[i % 5];
      std::uint64_t left_out = 0;
      for (const std::uint32_t layers : oracle_of(scene, kWidth, kHeight, 1, o.background).layers)
        left_out += layers > most ? layers - most : 0;
      EXPECT_EQ(says.shaded(), (exactly - left_out) * renderers.size());
      said += says.shaded();
      not_said += is_silent.shaded();
    };
    for_each_scene(kLayerKinds, expect, first++ % step, step);
  }
  EXPECT_LT(said, not_said);
  EXPECT_LT(not_said, all / 2);
}

TEST(TransparencyOptions, NoneDrawsTranslucentSurfacesOpaque) {
  Painter none(options({.method = Transparency::none})),
      exact(options({.method = Transparency::exact}));
  for_each_scene(kLayerKinds, [&](int, const LayerScene&, LayerProgram& program) {
    const LayerPicture plain = take(none, program);
    for (raster::Draw& draw : program.draws()) draw.flags &= ~kTranslucent;
    EXPECT_TRUE(same_bits(plain, take(exact, program)));
  });
}

}  // namespace
}  // namespace rastrum::test::filter_test
