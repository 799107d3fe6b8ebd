// SPDX-License-Identifier: BSD-3-Clause
// reduce_by_index against the loop that defines it.
#include <initializer_list>

#include "tests/parallel/backends.hpp"

namespace rastrum::parallel::test::histogram_test {
namespace {

/// Indices of a histogram, some out of range; spread out, or nearly all in one bin.
std::vector<std::int32_t> random_indices(std::size_t n, std::size_t bins, bool crowded) {
  std::mt19937 random(static_cast<std::uint32_t>(n + bins));
  std::vector<std::int32_t> indices(n);
  for (std::int32_t& i : indices) {
    i = static_cast<std::int32_t>(random() % (bins + 4)) - 2;
    if (crowded && random() % 16 != 0) i = static_cast<std::int32_t>(bins / 2);
  }
  return indices;
}

template <class T, class V, class Op>
void apply(std::vector<T>& dest, const std::vector<std::int32_t>& indices,
           const std::vector<V>& values, Op op) {
  for (std::size_t i = 0; i < indices.size(); ++i)
    if (indices[i] >= 0 && static_cast<std::size_t>(indices[i]) < dest.size()) {
      T& bin = dest[static_cast<std::size_t>(indices[i])];
      bin = static_cast<T>(op(bin, static_cast<T>(values[i])));
    }
}

/// With bins that already hold numbers, which `make(n, seed)` makes.
template <class Make, class Op>
void expect_loop(std::initializer_list<std::size_t> bin_counts, const Make& make, const Op& op) {
  for (const std::size_t n : kSizes)
    for (const std::size_t bins : bin_counts)
      for (const bool crowded : {false, true}) {
        const auto indices = random_indices(n, bins, crowded);
        const auto values = make(n, 1), old = make(bins, 9);
        auto expected = old;
        apply(expected, indices, values, op);
        on_every_backend([&](auto& exec) {
          auto dest = old;
          reduce_by_index(exec, dest, indices, values, op);
          EXPECT_EQ(dest, expected);
        });
      }
}

TEST(ReduceByIndex, MaximumOf64BitWords) {
  expect_loop(
      {0, 1, 1000},
      [](std::size_t n, std::uint64_t seed) {
        return random_values<std::uint64_t>(n, ~std::uint64_t{0}, seed);
      },
      Maximum{});
}

TEST(ReduceByIndex, FoldsInOrderWithoutCommuting) {
  expect_loop(
      {0, 1, 77, 100000}, [](std::size_t n, std::uint64_t) { return random_maps(n); }, then);
}

TEST(ReduceByIndex, ComputesInTheTypeOfTheBins) {
  const std::vector<std::uint8_t> values(100000, 255);
  on_every_backend([&](auto& exec) {
    std::vector<std::uint32_t> dest = {5, 5};
    reduce_by_index(exec, dest, constant(values.size(), 1), values, std::plus<>());
    EXPECT_EQ(dest, (std::vector<std::uint32_t>{5, 5 + 255 * 100000}));
  });
}

TEST(ReduceByIndex, IgnoresIndicesThatFitNoSignedNumber) {
  on_every_backend([&](auto& exec) {
    std::vector<std::uint64_t> dest(3, 1);
    const std::vector<std::uint64_t> indices = {~std::uint64_t{0}, 3, 2, std::uint64_t{1} << 32};
    reduce_by_index(exec, dest, indices, constant(4, std::uint64_t{8}), Maximum{});
    EXPECT_EQ(dest, (std::vector<std::uint64_t>{1, 1, 8}));
    reduce_by_index(exec, dest, indices, constant(4, std::uint64_t{8}), std::plus<>());
    EXPECT_EQ(dest, (std::vector<std::uint64_t>{1, 1, 16}));
  });
}

TEST(ReduceByIndex, FloatSumsHaveOneResultOnAllBackends) {
  const std::size_t n = 100003;
  const auto indices = random_indices(n, 10, true);
  const auto values = random_floats(n);
  expect_one_result([&](auto& exec) {
    std::vector<float> dest(10, 1.0F);
    reduce_by_index(exec, dest, indices, values, std::plus<>());
    return dest;
  });
}

}  // namespace
}  // namespace rastrum::parallel::test::histogram_test
