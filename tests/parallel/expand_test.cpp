// expand and expand_masked against their definitions as nested loops.
#include <utility>

#include <tests/parallel/backends.hpp>

namespace rastrum::parallel::test::expand_test {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

Pair make_pair_of(std::size_t i, std::size_t j) {
  return {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)};
}

TEST(Expand, ListsTheElementsOfAllSegments) {
  for (const auto& sizes : segment_sizes()) {
    std::vector<Pair> expected;
    for (std::size_t i = 0; i < sizes.size(); ++i)
      for (std::size_t j = 0; j < sizes[i]; ++j) expected.push_back(make_pair_of(i, j));
    on_every_backend([&](auto& exec) {
      EXPECT_EQ(
          as_vector(expand(
              exec, counting(sizes.size()), [&](std::size_t i) { return sizes[i]; }, make_pair_of)),
          expected);
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

// Masks of other widths: expand_each_test.cpp, by which this is written.
TEST(ExpandMasked, MatchesExpandThenFilter) {
  // How many of 8 elements hold, by a hash of segment and index: none, few, half, all.
  for (const std::size_t density : {0U, 1U, 4U, 8U})
    for (const auto& sizes : segment_sizes()) {
      const auto holds = [&](std::size_t i, std::size_t j) {
        return (i * 2654435761U + j * 40503U) / 16 % 8 < density;
      };
      std::vector<Pair> expected;
      for (std::size_t i = 0; i < sizes.size(); ++i)
        for (std::size_t j = 0; j < sizes[i]; ++j)
          if (holds(i, j)) expected.push_back(make_pair_of(i, j));
      on_every_backend([&](auto& exec) {
        EXPECT_EQ(as_vector(expand_masked(
                      exec, counting(sizes.size()), [&](std::size_t i) { return sizes[i]; }, holds,
                      make_pair_of)),
                  expected);
      });
    }
}

}  // namespace
}  // namespace rastrum::parallel::test::expand_test
