#include <algorithm>
#include <numeric>

#include <tests/parallel/backends.hpp>

namespace rastrum::parallel::test {
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
    // Few distinct keys show stability, many show order; odd and even numbers of passes.
    sorts_like_stable_sort(random_values<std::uint32_t>(n, 10), 32);
    sorts_like_stable_sort(random_values<std::uint32_t>(n, std::uint64_t{1} << 32), 32);
    sorts_like_stable_sort(random_values<std::uint32_t>(n, std::uint64_t{1} << 32), 20);
    sorts_like_stable_sort(random_values<std::uint32_t>(n, std::uint64_t{1} << 32), 3);
    sorts_like_stable_sort(random_values<std::uint64_t>(n, ~std::uint64_t{0}), 64);
    sorts_like_stable_sort(random_values<std::uint64_t>(n, ~std::uint64_t{0}), 41);
    sorts_like_stable_sort(random_values<std::uint16_t>(n, 65536), 16);
    sorts_like_stable_sort(random_values<std::uint8_t>(n, 256), 8);
  }
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
    std::vector<std::uint8_t> values(keys.size());
    sort_by_key(exec, keys, values);
    EXPECT_TRUE(std::is_sorted(keys.begin(), keys.end()));
  });
}

}  // namespace
}  // namespace rastrum::parallel::test
