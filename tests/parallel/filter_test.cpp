// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "tests/parallel/backends.hpp"

namespace rastrum::parallel::test::filter_test {
namespace {

const std::vector<std::uint32_t> kThresholds = {0, 1, 50, 99, 100};  // of 100: none to all

TEST(Filter, KeepsWhatHoldsInOrder) {
  for (const std::size_t n : kSizes) {
    const auto in = random_values<std::uint32_t>(n, 100);
    for (const std::uint32_t threshold : kThresholds) {
      const auto holds = [&](std::uint32_t x) { return x < threshold; };
      std::vector<std::uint32_t> expected;
      std::copy_if(in.begin(), in.end(), std::back_inserter(expected), holds);
      on_every_backend([&](auto& exec) {
        EXPECT_EQ(as_vector(filter(exec, in, holds)), expected);
        const auto indices =
            as_vector(filter(exec, counting(n), [&](std::size_t i) { return holds(in[i]); }));
        ASSERT_EQ(indices.size(), expected.size());
        for (std::size_t k = 0; k < indices.size(); ++k) ASSERT_EQ(in[indices[k]], expected[k]);
        EXPECT_TRUE(std::is_sorted(indices.begin(), indices.end()));
      });
    }
  }
}

TEST(Partition, PutsWhatHoldsFirstBothInOrder) {
  for (const std::size_t n : kSizes) {
    // The low digits tell equal elements apart, which shows their order.
    auto in = random_values<std::uint64_t>(n, 100);
    for (std::size_t i = 0; i < n; ++i) in[i] = in[i] << 32 | i;
    for (const std::uint32_t threshold : kThresholds) {
      const auto holds = [&](std::uint64_t x) { return (x >> 32) < threshold; };
      auto expected = in;
      const auto middle = std::stable_partition(expected.begin(), expected.end(), holds);
      on_every_backend([&](auto& exec) {
        const auto out = partition(exec, in, holds);
        EXPECT_EQ(as_vector(out.elements), expected);
        EXPECT_EQ(static_cast<std::ptrdiff_t>(out.first_count), middle - expected.begin());
      });
    }
  }
}

}  // namespace
}  // namespace rastrum::parallel::test::filter_test
