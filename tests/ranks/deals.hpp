// Which rank holds which part: deals of all kinds, and the pictures of each against one renderer's.
#pragma once

#include <cstdint>
#include <iterator>
#include <vector>

#include <gtest/gtest.h>

#include "tests/ranks/parts_picture.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test {

inline constexpr int kParts = 24;

inline Deal contiguous(int ranks) {
  Deal deal(static_cast<std::size_t>(ranks));
  for (std::uint64_t p = 0; p < kParts; ++p) deal[p * deal.size() / kParts].push_back(p);
  return deal;
}
inline Deal round_robin(int ranks) {
  Deal deal(static_cast<std::size_t>(ranks));
  for (std::uint64_t p = 0; p < kParts; ++p) deal[p % deal.size()].push_back(p);
  return deal;
}
/// With empty ranks, and parts of a rank in any order.
inline Deal random_deal(int ranks, Random& random) {
  Deal deal(static_cast<std::size_t>(ranks));
  for (std::uint64_t p = 0; p < kParts; ++p) {
    auto& parts = deal[static_cast<std::size_t>(random.integer(0, ranks - 1) / 2)];
    parts.insert(random.chance(0.5) ? parts.begin() : parts.end(), p);
  }
  return deal;
}
inline Deal all_on_last(int ranks) {
  Deal deal(static_cast<std::size_t>(ranks));
  for (std::uint64_t p = 0; p < kParts; ++p) deal.back().push_back(p);
  return deal;
}

inline FrameOptions frame_of(Shader shader, int width, int height) {
  return FrameOptions{
      .width = width, .height = height, .shader = shader, .background = {0.1F, 0.2F, 0.3F, 0.5F}};
}

/// One picture of each deal, both exchanges, against one renderer's. `of_rank`: each rank's.
inline void expect_equal(const Scene& scene, const FrameOptions& frame,
                         const std::vector<int>& counts, std::uint64_t seed,
                         const RendererOptions& of_rank = {.device = Device::serial},
                         RanksOptions options = {}) {
  const SceneBinding binding(scene);
  const Camera camera = fit_camera(binding.view(), 1.0472F, false);
  const bool linear = shader_for(frame.shader, binding.view()) == Shader::material;
  const AllTargets one(frame.width, frame.height, linear);
  Renderer renderer({.threads = 2});
  (void)renderer.render(binding.view(), camera, frame, one.targets());
  Random random(seed);
  for (const int n : counts) {
    LocalRanks ranks(n);
    const std::vector<Deal> deals{contiguous(n), round_robin(n), all_on_last(n),
                                  random_deal(n, random)};
    constexpr WordExchange kForms[] = {WordExchange::shared, WordExchange::sparse,
                                       WordExchange::two_hops};
    // Where few scenes are drawn each deal goes by one form, else by all but the last.
    const bool few = test_share() < 100;
    for (std::size_t d = 0; d < deals.size(); ++d)
      for (std::size_t form = 0; form < std::size(kForms); ++form) {
        if (form != d % std::size(kForms) && (few || kForms[form] == WordExchange::two_hops))
          continue;
        const Deal& deal = deals[d];
        const WordExchange exchange = kForms[form];
        const AllTargets many(frame.width, frame.height, linear);
        options.exchange = exchange;
        options.root = n / 2;
        const RanksStats stats = draw_dealt(ranks, deal, binding.view(), camera, frame,
                                            many.targets(), options, {}, of_rank);
        ASSERT_TRUE(same_targets(one.targets(), many.targets()))
            << n << " ranks, " << name(frame.shader) << ", seed " << seed;
        EXPECT_EQ(stats.exchange, exchange);
        EXPECT_EQ(stats.primitives, scene.primitive_count());
      }
  }
}
inline void expect_equal(std::uint64_t seed, bool with_materials, const FrameOptions& frame,
                         const std::vector<int>& counts) {
  expect_equal(PartsScene(seed, kParts, with_materials).scene, frame, counts, seed);
}

}  // namespace rastrum::test
