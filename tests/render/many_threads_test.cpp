// More threads than bins that hold something: a bin is cut, and its parts are drawn at the same
// time (raster/bin/bin_parts.hpp). The pictures are one thread's.
#include <algorithm>
#include <cstdint>

#include <gtest/gtest.h>

#include <rastrum/fit.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/scenes.hpp"

namespace rastrum::test::many_threads_test {
namespace {

constexpr int kWidth = 200, kHeight = 136;

struct Pictures {
  Image<Rgba8> color8{kWidth, kHeight};
  Image<std::int64_t> ids{kWidth, kHeight};
  Image<float> depth{kWidth, kHeight};
  Image<std::uint32_t> overdraw{kWidth, kHeight};
};

template <class T>
bool same(const Image<T>& a, const Image<T>& b) {
  return std::ranges::equal(a.pixels(), b.pixels());
}

TEST(ManyThreads, DrawPartsOfABinAsOneThreadDoes) {
  // Most of it in the bins in the middle, which have enough fragments to be cut (kLeastCut).
  const Scene scene = single(shapes::soup(200'000, 0.01F, 0.02F));
  const Camera camera = fit_camera(SceneBinding(scene).view(), 1.0472F, false);
  for (const bool prepared : {false, true}) {
    SceneBinding binding(scene);
    if (prepared) binding.prepare();
    for (const float opacity : {1.0F, 0.5F})
      for (const bool counts : {false, true}) {
        Pictures expected, got;
        for (const int threads : {1, 12}) {
          Pictures& p = threads == 1 ? expected : got;
          // The images begin with different values, so that pixels that nobody draws stay
          // different, were it in a part without a triangle.
          const auto what_was = static_cast<std::uint8_t>(threads);
          std::ranges::fill(p.color8.pixels(), Rgba8{what_was, what_was, what_was, what_was});
          std::ranges::fill(p.ids.pixels(), threads);
          std::ranges::fill(p.depth.pixels(), static_cast<float>(threads));
          std::ranges::fill(p.overdraw.pixels(), counts ? what_was : 0);
          FrameOptions frame{.width = kWidth, .height = kHeight, .shader = Shader::phong};
          frame.opacity = opacity;
          Targets targets{.color8 = p.color8, .depth = p.depth, .ids = p.ids};
          if (counts) targets.overdraw = p.overdraw;
          Renderer renderer({.threads = threads});
          for (int again = 0; again < 2; ++again)
            EXPECT_GT(renderer.render(binding.view(), camera, frame, targets).pixels_covered,
                      1000U);
        }
        EXPECT_TRUE(same(got.color8, expected.color8)) << prepared << opacity << counts;
        EXPECT_TRUE(same(got.ids, expected.ids)) << prepared << opacity << counts;
        EXPECT_TRUE(same(got.depth, expected.depth)) << prepared << opacity << counts;
        EXPECT_TRUE(same(got.overdraw, expected.overdraw)) << prepared << opacity << counts;
      }
  }
}

}  // namespace
}  // namespace rastrum::test::many_threads_test
