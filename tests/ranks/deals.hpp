// SPDX-License-Identifier: BSD-3-Clause
// Distributes parts over ranks ("deals") and compares the pictures with one renderer's.
#pragma once

#include <cstdint>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/ranks/parts_picture.hpp"
#include "tests/support/shaded_scenes.hpp"
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
/// With empty ranks, and a rank's parts in any order.
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

/// Compares one picture of each deal and each exchange with one renderer's. `of_rank`: each rank's
/// options.
inline void expect_equal(const Scene& scene, const FrameOptions& frame,
                         const std::vector<int>& counts, std::uint64_t seed,
                         const RendererOptions& of_rank = kSerialRank, RanksOptions options = {}) {
  const Whole whole(scene, frame);
  Random random(seed);
  for (const int n : counts) {
    LocalRanks ranks(n);
    const std::vector<Deal> deals{contiguous(n), round_robin(n), all_on_last(n),
                                  random_deal(n, random)};
    constexpr WordExchange kForms[] = {WordExchange::shared, WordExchange::sparse,
                                       WordExchange::two_hops};
    // With a small test share, each deal uses one exchange, else all but the last.
    const bool few = test_share() < 100;
    for (std::size_t d = 0; d < deals.size(); ++d)
      for (std::size_t form = 0; form < std::size(kForms); ++form) {
        if (form != d % std::size(kForms) && (few || kForms[form] == WordExchange::two_hops))
          continue;
        SCOPED_TRACE(testing::Message()
                     << n << " ranks, " << name(frame.shader) << ", seed " << seed);
        options.exchange = kForms[form];
        options.root = n / 2;
        const RanksStats stats = whole.expect(ranks, deals[d], options, of_rank);
        EXPECT_EQ(stats.exchange, kForms[form]);
        EXPECT_EQ(stats.primitives, scene.primitive_count());
        if (testing::Test::HasFailure()) return;
      }
  }
}
inline void expect_equal(std::uint64_t seed, bool with_materials, const FrameOptions& frame,
                         const std::vector<int>& counts) {
  expect_equal(PartsScene(seed, kParts, with_materials).scene, frame, counts, seed);
}

/// Generated scenes on three ranks, with frames from change(frame, seed). Scenes with one instance
/// leave ranks empty. Returns the number of scenes with layers.
template <class Change, class OfRank>
int expect_equal_generated(std::uint64_t seeds, const Change& change, const OfRank& of_rank) {
  int layered = 0;
  for (std::uint64_t seed = 0; seed < seeds && !testing::Test::HasFailure(); ++seed) {
    ShadedScene s = generate_shaded(seed);
    SCOPED_TRACE(s.kind + ", seed " + std::to_string(seed));
    change(s.frame, seed);
    const Whole whole(std::move(s.scene), s.frame, s.camera);
    Deal deal(3);
    for (std::uint64_t p = 0; p < whole.scene.instances.size(); ++p)
      deal[(p + seed) % 3].push_back(p);
    LocalRanks ranks(3);
    whole.expect(ranks, deal, {}, of_rank(seed));
    layered += whole.stats().visibility == "layers" ? 1 : 0;
  }
  return layered;
}

}  // namespace rastrum::test
