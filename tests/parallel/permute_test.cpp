// SPDX-License-Identifier: BSD-3-Clause
// transform, tabulate, for_each, transpose, scatter and the computed ranges.
#include <algorithm>
#include <numeric>

#include "tests/parallel/backends.hpp"

namespace rastrum::parallel::test::permute_test {
namespace {

std::vector<std::uint32_t> random_permutation(std::size_t n) {
  std::vector<std::uint32_t> p(n);
  std::iota(p.begin(), p.end(), 0U);
  std::shuffle(p.begin(), p.end(), std::mt19937(static_cast<std::uint32_t>(n)));
  return p;
}

TEST(Transform, AppliesTheFunctionToEachElement) {
  for (const std::size_t n : kSizes) {
    const auto a = random_values<std::uint32_t>(n, 1000, 1);
    on_every_backend([&](auto& exec) {
      std::vector<std::uint64_t> out(n, 99);
      transform(exec, a, out, [](std::uint32_t x) { return std::uint64_t{x} * 3; });
      for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(out[i], std::uint64_t{a[i]} * 3);
      transform(exec, out, out, [](std::uint64_t x) { return x + 1; });
      for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(out[i], std::uint64_t{a[i]} * 3 + 1);
    });
  }
}

TEST(Tabulate, WritesTheFunctionOfTheIndexOnce) {
  for (const std::size_t n : kSizes)
    on_every_backend([&](auto& exec) {
      std::vector<std::size_t> out(n, 7);
      std::vector<int> calls(n);
      tabulate(exec, out, [&](std::size_t i) {
        ++calls[i];
        return i * i;
      });
      for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(out[i], i * i);
      EXPECT_EQ(std::count(calls.begin(), calls.end(), 1), static_cast<std::ptrdiff_t>(n));
    });
}

TEST(ForEach, CallsTheFunctionOnEachElementOnce) {
  for (const std::size_t n : kSizes)
    on_every_backend([&](auto& exec) {
      auto values = random_values<std::uint32_t>(n, 1000);
      const auto before = values;
      for_each(exec, values, [](std::uint32_t& x) { x = x * 2 + 1; });
      for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(values[i], before[i] * 2 + 1);
    });
}

TEST(Transpose, SwapsRowsAndColumns) {
  for (const std::size_t rows : {0U, 1U, 31U, 32U, 33U, 500U})
    for (const std::size_t columns : {0U, 1U, 32U, 65U, 301U}) {
      const auto in = random_values<std::uint32_t>(rows * columns, 1U << 30);
      on_every_backend([&](auto& exec) {
        std::vector<std::uint32_t> out(in.size(), 5), back(in.size(), 5);
        transpose(exec, in, rows, columns, out);
        for (std::size_t y = 0; y < rows; ++y)
          for (std::size_t x = 0; x < columns; ++x)
            ASSERT_EQ(out[x * rows + y], in[y * columns + x]);
        transpose(exec, out, columns, rows, back);
        EXPECT_EQ(back, in);
      });
    }
}

TEST(Permuted, ReadsThroughTheMap) {
  for (const std::size_t n : kSizes) {
    const auto in = random_values<std::uint32_t>(n + 5, 1U << 30);
    const auto map = random_values<std::uint32_t>(n, n + 5);
    on_every_backend([&](auto& exec) {
      std::vector<std::uint32_t> out(n);
      transform(exec, permuted(in, map), out, [](std::uint32_t x) { return x; });
      for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(out[i], in[map[i]]);
    });
  }
}

TEST(Scatter, WritesThroughTheMap) {
  for (const std::size_t n : kSizes) {
    const auto in = random_values<std::uint32_t>(n, 1U << 30);
    const auto map = random_permutation(n);
    on_every_backend([&](auto& exec) {
      std::vector<std::uint32_t> out(n);
      scatter(exec, in, map, out);
      for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(out[map[i]], in[i]);
    });
  }
}

TEST(Scatter, StencilLeavesTheRestAlone) {
  for (const std::size_t n : kSizes) {
    const auto in = random_values<std::uint32_t>(n, 1U << 30);
    auto map = random_permutation(n);
    const auto stencil = random_values<std::uint8_t>(n, 2);
    std::vector<std::uint32_t> expected(n, 42);
    for (std::size_t i = 0; i < n; ++i) {
      if (stencil[i] != 0) expected[map[i]] = in[i];
      // The index may be anything if its stencil is false.
      if (stencil[i] == 0) map[i] = 0xFFFFFFFFU;
    }
    on_every_backend([&](auto& exec) {
      std::vector<std::uint32_t> out(n, 42);
      scatter_if(exec, in, map, stencil, out);
      EXPECT_EQ(out, expected);
    });
  }
}

}  // namespace
}  // namespace rastrum::parallel::test::permute_test
