// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>

#include "tests/parallel/backends.hpp"

namespace rastrum::parallel::test::sort_test {
namespace {

template <class K>
void sorts_like_stable_sort(const std::vector<K>& keys, int bits) {
  const std::size_t n = keys.size();
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0U);
  const auto low = [&](K k) {
    return bits >= 64 ? std::uint64_t{k} : std::uint64_t{k} & ((std::uint64_t{1} << bits) - 1);
  };
  std::vector<std::uint32_t> expected = order;
  std::stable_sort(expected.begin(), expected.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return low(keys[a]) < low(keys[b]); });
  on_every_backend([&](auto& exec) {
    auto sorted = keys;
    auto values = order;
    sort_by_key(exec, sorted, values, bits);
    EXPECT_EQ(values, expected);
    for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(sorted[i], keys[expected[i]]);
  });
}

TEST(SortByKey, IsStableAndSortsByTheLowBits) {
  for (const std::size_t n : kSizes) {
    SCOPED_TRACE(n);
    // Few distinct keys test stability, many test order; odd and even numbers of passes.
    sorts_like_stable_sort(random_values<std::uint32_t>(n, 10), 32);
    sorts_like_stable_sort(random_values<std::uint32_t>(n, std::uint64_t{1} << 32), 32);
    sorts_like_stable_sort(random_values<std::uint32_t>(n, std::uint64_t{1} << 32), 20);
    sorts_like_stable_sort(random_values<std::uint32_t>(n, std::uint64_t{1} << 32), 3);
    sorts_like_stable_sort(random_values<std::uint64_t>(n, ~std::uint64_t{0}), 64);
    sorts_like_stable_sort(random_values<std::uint64_t>(n, ~std::uint64_t{0}), 41);
    sorts_like_stable_sort(random_values<std::uint32_t>(n, 65536), 16);
    sorts_like_stable_sort(random_values<std::uint32_t>(n, 256), 8);
  }
}

// Most keys are in one bucket of the first pass, too large for one thread, with one or more digits
// left.
TEST(SortByKey, OneHugeBucket) {
  for (const int bits : {14, 20, 31, 40, 53, 64}) {
    SCOPED_TRACE(bits);
    const auto n = static_cast<std::size_t>(rastrum::test::share_of(250007, 50023));
    std::vector<std::uint64_t> keys =
        random_values<std::uint64_t>(n, std::uint64_t{1} << (bits - 8));
    for (std::size_t i = 0; i < n; i += 50) keys[i] |= std::uint64_t{1} << (bits - 1);
    sorts_like_stable_sort(keys, bits);
  }
}

TEST(SortByKey, MovesValuesOfAnySize) {
  struct Value {
    std::uint32_t id;
    std::uint8_t rest[9];
  };
  const std::size_t n = 50021;
  const auto keys = random_values<std::uint32_t>(n, 5000);
  on_every_backend([&](auto& exec) {
    auto sorted = keys;
    std::vector<Value> values(n);
    for (std::size_t i = 0; i < n; ++i) {
      values[i].id = static_cast<std::uint32_t>(i);
      for (std::uint8_t& b : values[i].rest) b = static_cast<std::uint8_t>(i * 31 + keys[i]);
    }
    sort_by_key(exec, sorted, values);
    for (std::size_t i = 0; i < n; ++i) {
      ASSERT_EQ(sorted[i], keys[values[i].id]);
      for (const std::uint8_t b : values[i].rest)
        ASSERT_EQ(b, static_cast<std::uint8_t>(values[i].id * 31 + sorted[i]));
      if (i == 0) continue;
      ASSERT_LE(sorted[i - 1], sorted[i]);
      ASSERT_TRUE(sorted[i - 1] != sorted[i] || values[i - 1].id < values[i].id);
    }
  });
}

TEST(SortByKey, NoBitsChangeNothing) {
  sorts_like_stable_sort(random_values<std::uint32_t>(1000, 1000), 0);
}

TEST(SortByKey, SkipsDigitsThatAreTheSameInAllKeys) {
  std::vector<std::uint64_t> keys = random_values<std::uint64_t>(100003, 256);
  for (std::uint64_t& k : keys) k = k << 24 | 0xABCD00000000EFU;
  sorts_like_stable_sort(keys, 64);
  sorts_like_stable_sort(std::vector<std::uint64_t>(100003, 5), 64);
}

TEST(SortByKey, DefaultsToAllBitsOfTheKey) {
  on_every_backend([](auto& exec) {
    auto keys = random_values<std::uint32_t>(70001, std::uint64_t{1} << 32);
    std::vector<std::uint32_t> values(keys.size());
    sort_by_key(exec, keys, values);
    EXPECT_TRUE(std::is_sorted(keys.begin(), keys.end()));
  });
}

}  // namespace
}  // namespace rastrum::parallel::test::sort_test
