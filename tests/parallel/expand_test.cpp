// SPDX-License-Identifier: BSD-3-Clause
// Compares expansions with nested loops: the lists of expand and expand_masked; and for expand_each
// and the walk of a masked expansion the visited results, their chunks and order, at the first and
// the second walk.
#include <array>
#include <utility>

#include "tests/parallel/backends.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::parallel::test::expand_test {
namespace {

using rastrum::test::test_share;

/// The results of an expansion in order: (segment, j).
using Results = std::vector<std::pair<std::size_t, std::size_t>>;

/// All results, or those that holds(segment, j) keeps.
template <class Holds>
Results results_of(const std::vector<std::uint32_t>& sizes, const Holds& holds) {
  Results all;
  for (std::size_t i = 0; i < sizes.size(); ++i)
    for (std::size_t j = 0; j < sizes[i]; ++j)
      if (holds(i, j)) all.emplace_back(i, j);
  return all;
}
Results results_of(const std::vector<std::uint32_t>& sizes) {
  return results_of(sizes, [](std::size_t, std::size_t) { return true; });
}
/// How many of 8 elements pass, by a hash of segment and index: none, few, half, all.
constexpr std::size_t kDensities[] = {0, 1, 4, 8};
auto holds_of(std::size_t density) {
  return [density](std::size_t i, std::size_t j) {
    return (i * 2654435761U + j * 40503U) / 16 % 8 < density;
  };
}
std::pair<std::size_t, std::size_t> pair_of(std::size_t i, std::size_t j) {
  return {i, j};
}

TEST(Expand, ListsTheElementsOfAllSegments) {
  for (const auto& sizes : segment_sizes()) {
    const Results expected = results_of(sizes);
    const auto size = [&](std::size_t i) { return sizes[i]; };
    on_every_backend([&](auto& exec) {
      EXPECT_EQ(as_vector(expand(exec, counting(sizes.size()), size, pair_of)), expected);
    });
  }
}

TEST(Expand, ExampleOfThePaper) {
  // Paper 1, section 2.2.2: segments of 3, 2, 1 and 1.
  const std::vector<int> sizes = {3, 2, 1, 1};
  const std::vector<std::size_t> offsets = {0, 3, 5, 6};
  on_every_backend([&](auto& exec) {
    EXPECT_EQ(as_vector(expand(
                  exec, counting(4), [&](std::size_t i) { return sizes[i]; },
                  [&](std::size_t i, std::size_t j) { return offsets[i] + j + 1; })),
              (std::vector<std::size_t>{1, 2, 3, 4, 5, 6, 7}));
  });
}

TEST(ExpandMasked, MatchesExpandThenFilter) {
  for (const std::size_t density : kDensities)
    for (const auto& sizes : segment_sizes()) {
      const auto holds = holds_of(density);
      const Results expected = results_of(sizes, holds);
      const auto size = [&](std::size_t i) { return sizes[i]; };
      on_every_backend([&](auto& exec) {
        EXPECT_EQ(as_vector(expand_masked(exec, counting(sizes.size()), size, holds, pair_of)),
                  expected);
      });
    }
}

constexpr std::array<std::size_t, 4> kPerChunk = {1, 7, 64, kBlock};

/// By definition chunk c of `walk` has the results from c · per_chunk on, in order.
template <class Plan, class Walk>
void expect_chunks(const Plan& plan, const Results& expected, Walk&& walk) {
  const std::size_t per_chunk = plan.per_chunk();
  ASSERT_EQ(plan.size(), expected.size());
  ASSERT_EQ(plan.chunks(), (expected.size() + per_chunk - 1) / per_chunk);
  for (int repeat = 0; repeat < 2; ++repeat) {
    Results seen(expected.size());
    std::vector<std::size_t> visited(plan.chunks(), 0);  // race-free with one thread a chunk
    std::vector<std::uint8_t> too_many(plan.chunks(), 0);
    walk([&](std::size_t c, std::size_t i, std::size_t j) {
      const std::size_t k = plan.chunk_begin(c) + visited[c]++;
      if (k < plan.chunk_end(c))
        seen[k] = {i, j};
      else
        too_many[c] = 1;
    });
    EXPECT_EQ(seen, expected);
    for (std::size_t c = 0; c < plan.chunks(); ++c) {
      ASSERT_EQ(visited[c], plan.chunk_end(c) - plan.chunk_begin(c));
      ASSERT_EQ(too_many[c], 0);
    }
  }
}

TEST(ExpandEach, VisitsEachResultInItsChunkInOrder) {
  for (const auto& sizes : segment_sizes()) {
    const Results expected = results_of(sizes);
    const auto in = counting(sizes.size());
    const auto size = [&](std::size_t i) { return sizes[i]; };
    on_every_backend([&](auto& exec) {
      for (const std::size_t per_chunk : kPerChunk) {
        const auto plan = make_expansion(exec, in, size, per_chunk);
        expect_chunks(plan, expected, [&](auto&& f) { expand_each(exec, plan, in, f); });
      }
    });
  }
}

TEST(ExpandEach, RunsAreTheSegmentsSharesOfAChunk) {
  for (const auto& sizes : segment_sizes())
    on_every_backend([&](auto& exec) {
      const auto in = counting(sizes.size());
      const auto plan = make_expansion(
          exec, in, [&](std::size_t i) { return sizes[i]; }, 100);
      std::vector<Results> runs(plan.chunks());
      std::vector<std::vector<std::size_t>> owners_of(plan.chunks());
      expand_chunks(exec, plan, in, [&](const auto& chunk) {
        EXPECT_EQ(chunk.begin(), chunk.index() * 100);
        EXPECT_EQ(chunk.size(), chunk.end() - chunk.begin());
        chunk.each_run([&](std::size_t i, std::size_t begin, std::size_t end) {
          runs[chunk.index()].emplace_back(begin, end);
          owners_of[chunk.index()].push_back(i);
        });
      });
      // After joining runs that a chunk cut, the runs are the non-empty segments.
      std::size_t segment = 0, reached = 0;
      for (std::size_t c = 0; c < plan.chunks(); ++c)
        for (std::size_t r = 0; r < runs[c].size(); ++r) {
          if (reached == 0)
            while (sizes[segment] == 0) ++segment;
          ASSERT_EQ(owners_of[c][r], segment);
          ASSERT_EQ(runs[c][r].first, reached);
          ASSERT_GT(runs[c][r].second, reached);
          ASSERT_LE(runs[c][r].second, sizes[segment]);
          reached = runs[c][r].second;
          if (reached == sizes[segment]) {
            ++segment;
            reached = 0;
          }
        }
      EXPECT_EQ(reached, 0U);
      for (; segment < sizes.size(); ++segment) ASSERT_EQ(sizes[segment], 0U);
    });
}

/// Calls f(chunk, segment, j) for each result.
template <class Exec, class Plan, class In, class F>
void walk(Exec& exec, const Plan& plan, const In& in, const F& f) {
  expand_chunks(exec, plan, in, [&](const auto& chunk) {
    chunk.each([&](std::size_t i, std::size_t j) { f(chunk.index(), i, j); });
  });
}

template <class Width>
class MaskedExpansions : public testing::Test {};
template <int kBits>
using Bits = std::integral_constant<int, kBits>;
/// Many masks per group, the default, and masks of several words. mask_test.cpp has all widths.
using Widths = testing::Types<Bits<8>, Bits<64>, Bits<256>>;
TYPED_TEST_SUITE(MaskedExpansions, Widths);

TYPED_TEST(MaskedExpansions, VisitsEachResultInItsChunkInOrder) {
  constexpr int kBits = TypeParam::value;
  // A smaller share tests every fifth pair of sizes and density.
  const bool all = test_share() >= 100;
  std::size_t pairs = 0;
  for (const std::size_t density : kDensities)
    for (const auto& sizes : segment_sizes()) {
      if (!all && pairs++ % 5 != 0) continue;
      const auto size = [&](std::size_t i) { return sizes[i]; };
      const auto holds = holds_of(density);
      const Results expected = results_of(sizes, holds);
      const auto in = counting(sizes.size());
      on_every_backend([&](auto& exec) {
        for (const std::size_t per_chunk : kPerChunk) {
          const auto plan = make_masked_expansion<kBits>(exec, in, size, holds, per_chunk);
          expect_chunks(plan, expected, [&](auto&& f) { walk(exec, plan, in, f); });
        }
      });
    }
}

TEST(MaskedExpansion, AsksThePredicateOncePerElement) {
  on_every_backend([&](auto& exec) {
    std::vector<int> asked(100000, 0);
    const auto plan = make_masked_expansion<64>(
        exec, counting(1), [](std::size_t) { return 100000; },
        [&](std::size_t, std::size_t j) { return ++asked[j] % 2 == 1; });
    walk(exec, plan, counting(1), [](std::size_t, std::size_t, std::size_t) {});
    EXPECT_EQ(asked, std::vector<int>(100000, 1));
  });
}

}  // namespace
}  // namespace rastrum::parallel::test::expand_test
