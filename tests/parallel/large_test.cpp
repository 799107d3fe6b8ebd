// SPDX-License-Identifier: BSD-3-Clause
// Words on more than 2³¹ elements, where a 32-bit index or count would wrap. Skipped, with a
// message, if too little memory is free.
#include <cstdint>
#include <fstream>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/parallel/words.hpp>

namespace rastrum::parallel::large_test {
namespace {

constexpr std::size_t kMany = (std::size_t{1} << 31) + 12345;

/// Memory that is available without swapping, GiB; unlimited if the system does not say.
double available_gib() {
  std::ifstream in("/proc/meminfo");
  for (std::string key, rest; in >> key && std::getline(in, rest);)
    if (key == "MemAvailable:") return std::stod(rest) / 1048576;
  return std::numeric_limits<double>::infinity();
}

#define SKIP_BELOW_GIB(gib)        \
  if (available_gib() < (gib) + 1) \
  GTEST_SKIP() << "wants " << (gib) << " GiB, " << available_gib() << " GiB are available"

std::uint8_t noise(std::size_t i) {
  return static_cast<std::uint8_t>(i * 0x9E3779B97F4A7C15U >> 56);
}

TEST(Large, ReduceScanAndFilter) {
  SKIP_BELOW_GIB(3);
  Threads exec;
  auto values = make_buffer<std::uint8_t>(exec, kMany);
  tabulate(exec, values, noise);
  std::uint64_t sum = 0, ones = 0;
  for (std::size_t i = 0; i < kMany; ++i) {
    sum += noise(i);
    ones += noise(i) == 1 ? 1U : 0U;
  }
  EXPECT_EQ(reduce(exec, values, std::uint64_t{0}), sum);
  EXPECT_EQ(filter(exec, values, [](std::uint8_t x) { return x == 1; }).size(), ones);
  const std::uint8_t last = inclusive_scan(exec, values, values, std::uint8_t{0});
  EXPECT_EQ(last, static_cast<std::uint8_t>(sum));
  EXPECT_EQ(values[kMany - 1], last);
}

TEST(Large, SegmentsOfMoreThanAllOf32Bits) {
  Threads exec;
  const auto in = counting(3);
  const auto size = [](std::size_t i) { return i == 1 ? 2 * kMany : i; };
  const Expansion plan(exec, in, size, std::size_t{1} << 24);
  ASSERT_EQ(plan.size(), 2 * kMany + 2);
  std::vector<std::uint64_t> sums(plan.chunks(), 0);
  expand_chunks(exec, plan, in, [&](const auto& chunk) {
    std::uint64_t sum = 0;
    chunk.each([&](std::size_t i, std::size_t j) { sum += i + j; });
    sums[chunk.index()] = sum;
  });
  EXPECT_EQ(reduce(exec, sums, std::uint64_t{0}), kMany * (2 * kMany - 1) + 2 * kMany + 5);

  const MaskedExpansion<64> masked(exec, in, size,
                                   [](std::size_t, std::size_t j) { return j % 1000000 == 7; });
  std::vector<std::uint64_t> found(masked.size());
  expand_chunks(exec, masked, in, [&](const auto& chunk) {
    std::size_t k = chunk.begin();
    chunk.each([&](std::size_t i, std::size_t j) { found[k++] = i * 10000000000U + j; });
  });
  ASSERT_EQ(found.size(), (2 * kMany - 8) / 1000000 + 1);
  for (std::size_t k = 0; k < found.size(); ++k) ASSERT_EQ(found[k], 10000000007U + k * 1000000);
}

TEST(Large, SortByKey) {
  SKIP_BELOW_GIB(10);
  Threads exec;
  auto keys = make_buffer<std::uint8_t>(exec, kMany);
  auto values = make_buffer<std::uint8_t>(exec, kMany);
  tabulate(exec, keys, noise);
  std::vector<std::size_t> counts(256, 0), seen(256, 0);
  for (std::size_t i = 0; i < kMany; ++i) values[i] = static_cast<std::uint8_t>(counts[keys[i]]++);
  sort_by_key(exec, keys, values);
  for (std::size_t i = 0; i < kMany; ++i) {
    ASSERT_TRUE(i == 0 || keys[i - 1] <= keys[i]);
    // Stable: the value counts its key's elements, modulo 256.
    ASSERT_EQ(values[i], static_cast<std::uint8_t>(seen[keys[i]]++));
  }
  EXPECT_EQ(seen, counts);
}

TEST(Large, ScatterAndReduceByIndex) {
  SKIP_BELOW_GIB(5);
  Threads exec;
  auto in = make_buffer<std::uint8_t>(exec, kMany);
  auto out = make_buffer<std::uint8_t>(exec, kMany);
  tabulate(exec, in, noise);
  const auto backwards = Computed(kMany, [](std::size_t i) { return kMany - 1 - i; });
  scatter(exec, in, backwards, out);
  for (std::size_t i = 0; i < kMany; ++i) ASSERT_EQ(out[i], noise(kMany - 1 - i));

  std::vector<std::uint64_t> last(256, 0), expected(256, 0);
  for (std::size_t i = 0; i < kMany; ++i) expected[noise(i)] = i;
  reduce_by_index(exec, last, in, counting<std::uint64_t>(kMany), Maximum{});
  EXPECT_EQ(last, expected);
}

}  // namespace
}  // namespace rastrum::parallel::large_test
