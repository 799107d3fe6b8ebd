// SPDX-License-Identifier: BSD-3-Clause
// A picture in bands of rows, one at a time at the root, has the bits of the whole.
#include <cstdint>
#include <cstring>

#include <gtest/gtest.h>

#include "tests/ranks/deals.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::ranks_rows_test {
namespace {

/// Draws the picture in bands and joins them.
void draw_in_bands(const Whole& whole, LocalRanks& ranks, const Deal& deal, const Targets& picture,
                   RanksOptions options, const RendererOptions& of_rank) {
  const FrameOptions& frame = whole.frame;
  const int held = std::min(options.rows, frame.height);
  const AllTargets band(frame.width, held, whole.is_linear());
  int next = 0;
  options.take_rows = [&](int first, int last) {
    EXPECT_EQ(first, next);
    EXPECT_LE(last - first, held);
    next = last;
    ranks::each_target(band.targets(), [&](const auto& from, std::uint32_t bit) {
      ranks::each_target(picture, [&](const auto& to, std::uint32_t of_picture) {
        if constexpr (std::is_same_v<decltype(from), decltype(to)>)
          if (bit == of_picture && !from.empty())
            for (int y = first; y < last; ++y)
              std::memcpy(static_cast<void*>(to.row(y)), from.row(y - first),
                          sizeof(*from.data) * static_cast<std::size_t>(from.width));
      });
    });
  };
  (void)whole.draw(ranks, deal, band.targets(), options, of_rank);
  EXPECT_EQ(next, frame.height);
}

void expect_equal_in_bands(const Scene& scene, const FrameOptions& frame, int count,
                           RanksOptions options, const RendererOptions& of_rank = kThreadRank) {
  const Whole whole(scene, frame);
  for (const int node : {count, 1}) {  // all ranks on one machine, and each on its own
    LocalRanks ranks(count, node);
    for (const Deal& deal : {round_robin(count), all_on_last(count)}) {
      const AllTargets many = whole.images();
      options.root = count / 2;
      draw_in_bands(whole, ranks, deal, many.targets(), options, of_rank);
      ASSERT_TRUE(same_targets(whole.one(), many.targets()))
          << count << " ranks, " << node << " a machine, " << name(frame.shader) << ", samples "
          << frame.samples;
    }
  }
}

Scene scene_of(std::uint64_t seed, bool with_materials, bool translucent) {
  Scene scene = PartsScene(seed, kParts, with_materials).scene;
  for (std::size_t i = 0; translucent && i < scene.instances.size(); i += 2)
    scene.instances[i].opacity = 0.4F;
  return scene;
}

TEST(RanksRows, HaveTheBitsOfTheWhole) {
  std::uint64_t seed = 1;
  for (const int ranks : {1, 3})
    for (const bool translucent : {false, true})
      for (const int samples : {1, 4}) {
        FrameOptions frame = frame_of(Shader::phong, 70, 150);
        frame.samples = samples;
        expect_equal_in_bands(scene_of(seed, false, translucent), frame, ranks, {.rows = 64});
        frame.shader = Shader::material;
        frame.tone.tone = Tone::aces;
        expect_equal_in_bands(scene_of(seed, true, translucent), frame, ranks, {.rows = 128});
        ++seed;
      }
}

TEST(RanksRows, WithShadowsIdsAndTheReference) {
  FrameOptions frame = frame_of(Shader::phong, 60, 130);
  frame.lights.push_back({.kind = DirectionalLight{{-0.5F, -1, -0.4F}}});
  frame.shadows = true;
  for (const int ranks : {1, 2})
    expect_equal_in_bands(scene_of(20, false, true), frame, ranks, {.rows = 64});
  expect_equal_in_bands(scene_of(21, false, true), frame_of(Shader::id, 60, 130), 2, {.rows = 64});
  expect_equal_in_bands(scene_of(22, false, true), frame_of(Shader::lambert, 40, 70), 2,
                        {.rows = 64}, kSerialRank);
}

/// Bands whose fragments do not fit are drawn in smaller bands.
TEST(RanksRows, InWhichFragmentsGoInBands) {
  for (const int samples : {1, 4}) {
    FrameOptions frame = frame_of(Shader::phong, 150, 160);
    frame.samples = samples;
    expect_equal_in_bands(scene_of(30, false, true), frame, 3,
                          {.fragment_bytes = 20'000, .rows = 64});
  }
}

TEST(RanksRows, AreRefusedWhereThePictureIsOne) {
  const Scene scene = scene_of(40, false, false);
  Image<Rgba8> image(32, 64), all(32, 100);
  LocalRanks ranks(2);
  const auto draw = [&](Shader shader, int rows, ImageView<Rgba8> into) {
    const Whole whole(scene, frame_of(shader, 32, 100));
    whole.draw(ranks, contiguous(2), {.color8 = into}, {.rows = rows});
  };
  expect_refused("rows: 60 rows at once", Errc::invalid_argument,
                 [&] { draw(Shader::phong, 60, image); });
  expect_refused("the color8 target is 32x100 and must be 32x64", Errc::invalid_argument,
                 [&] { draw(Shader::phong, 64, all); });
  expect_refused("the shader depth", Errc::unsupported, [&] { draw(Shader::depth, 64, image); });
  expect_refused("give take_rows", Errc::invalid_argument, [&] { draw(Shader::phong, 64, image); });
}

}  // namespace
}  // namespace rastrum::test::ranks_rows_test
