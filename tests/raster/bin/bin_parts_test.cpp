// SPDX-License-Identifier: BSD-3-Clause
// With more threads than occupied bins, a bin is split and its parts are drawn at once
// (raster/bin/bin_parts.hpp). The pictures equal one thread's.
#include <algorithm>

#include <gtest/gtest.h>

#include <rastrum/fit.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::bin_parts_test {
namespace {

constexpr int kWidth = 200, kHeight = 136;

TEST(BinParts, DrawPartsOfABinAsOneThreadDoes) {
  // Most of it is in the central bins, which have enough fragments to be split (kLeastCut).
  const Scene scene = single(shapes::soup(200'000, 0.01F, 0.02F));
  const Camera camera = fit_camera(SceneBinding(scene).view(), 1.0472F, false);
  for (const bool prepared : {false, true}) {
    SceneBinding binding(scene);
    if (prepared) binding.prepare();
    for (const float opacity : {1.0F, 0.5F})
      for (const bool counts : {false, true}) {
        SCOPED_TRACE(testing::Message() << prepared << opacity << counts);
        const unsigned kinds = kColor8 | kVisible | (counts ? kOverdraw : 0U);
        const FrameOptions frame{
            .width = kWidth, .height = kHeight, .shader = Shader::phong, .opacity = opacity};
        Frame frames[2];
        for (const int threads : {1, 12}) {
          Frame& f = frames[threads == 1 ? 0 : 1];
          f = Frame(kWidth, kHeight, kinds);
          // The images begin with different values, so undrawn pixels stay different, also in a
          // part without triangles.
          if (threads == 12) std::ranges::fill(f.color8.pixels(), Rgba8{1, 1, 1, 1});
          if (threads == 12) std::ranges::fill(f.ids.pixels(), 1);
          if (threads == 12) std::ranges::fill(f.depth.pixels(), 1.0F);
          if (threads == 12) std::ranges::fill(f.overdraw.pixels(), 1U);
          Renderer renderer({.threads = threads});
          for (int again = 0; again < 2; ++again)
            EXPECT_GT(renderer.render(binding.view(), camera, frame, f.targets()).pixels_covered,
                      1000U);
        }
        EXPECT_TRUE(same_images(frames[1], frames[0]));
      }
  }
}

}  // namespace
}  // namespace rastrum::test::bin_parts_test
