// SPDX-License-Identifier: BSD-3-Clause
// reduce, scans and reduce_by_key: their definitions, and equal results on all backends.
#include <bit>
#include <numeric>

#include "tests/parallel/backends.hpp"

namespace rastrum::parallel::test::scan_test {
namespace {

TEST(Reduce, FoldsInOrderWithoutCommuting) {
  for (const std::size_t n : kSizes) {
    const std::vector<Affine> maps = random_maps(n);
    Affine expected;
    for (const Affine& m : maps) expected = then(expected, m);
    on_every_backend([&](auto& exec) { EXPECT_EQ(reduce(exec, maps, Affine{}, then), expected); });
  }
}

TEST(Reduce, ComputesInTheTypeOfTheIdentity) {
  const std::vector<std::uint8_t> ones(100000, 255);
  on_every_backend([&](auto& exec) {
    EXPECT_EQ(reduce(exec, ones, std::uint64_t{0}), 25500000U);
    EXPECT_EQ(reduce(exec, ones, std::uint64_t{5}), 25500005U);
  });
}

TEST(Reduce, FloatSumsHaveOneResult) {
  for (const std::size_t n : kSizes) {
    const std::vector<float> values = random_floats(n);
    // The documented order: blocks from the left, then their sums from the left.
    float expected = 0;
    for (std::size_t b = 0; b < n; b += kBlock) {
      float block = values[b];
      for (std::size_t i = b + 1; i < std::min(n, b + kBlock); ++i) block += values[i];
      expected += block;
    }
    on_every_backend([&](auto& exec) {
      EXPECT_EQ(std::bit_cast<std::uint32_t>(reduce(exec, values, 0.0F)),
                std::bit_cast<std::uint32_t>(expected));
    });
  }
}

TEST(Scan, ExclusiveAndInclusiveMatchTheirDefinitions) {
  for (const std::size_t n : kSizes) {
    const std::vector<Affine> maps = random_maps(n);
    std::vector<Affine> before(n), with(n);
    Affine sum{3, 4};  // an initial value other than the identity comes first
    for (std::size_t i = 0; i < n; ++i) {
      before[i] = sum;
      sum = then(sum, maps[i]);
      with[i] = sum;
    }
    on_every_backend([&](auto& exec) {
      std::vector<Affine> out(n);
      EXPECT_EQ(exclusive_scan(exec, maps, out, Affine{3, 4}, then), sum);
      EXPECT_EQ(out, before);
      EXPECT_EQ(inclusive_scan(exec, maps, out, Affine{3, 4}, then), sum);
      EXPECT_EQ(out, with);
    });
  }
}

TEST(Scan, MayWriteOverItsInput) {
  for (const std::size_t n : kSizes) {
    const std::vector<Affine> maps = random_maps(n);
    on_every_backend([&](auto& exec) {
      std::vector<Affine> expected(n);
      auto in_place = maps;
      const Affine sum = exclusive_scan(exec, maps, expected, Affine{}, then);
      EXPECT_EQ(exclusive_scan(exec, in_place, in_place, Affine{}, then), sum);
      EXPECT_EQ(in_place, expected);
      in_place = maps;
      inclusive_scan(exec, maps, expected, Affine{}, then);
      inclusive_scan(exec, in_place, in_place, Affine{}, then);
      EXPECT_EQ(in_place, expected);
    });
  }
}

TEST(Scan, FloatSumsHaveOneResultOnAllBackends) {
  const std::vector<float> values = random_floats(100003);
  expect_one_result([&](auto& exec) {
    std::vector<float> out(values.size());
    inclusive_scan(exec, values, out, 0.0F);
    return out;
  });
}

/// Runs of equal keys: short ones, one that spans many blocks, and recurring keys.
std::vector<std::uint32_t> keys_in_runs(std::size_t n) {
  std::vector<std::uint32_t> keys(n);
  std::mt19937 random(static_cast<std::uint32_t>(n));
  std::uint32_t key = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const bool in_long_run = i > n / 4 && i < n / 4 * 3;
    if (!in_long_run && random() % 3 == 0) key = (key + 1) % 5;
    keys[i] = key;
  }
  return keys;
}

TEST(ReduceByKey, FoldsRunsInOrder) {
  for (const std::size_t n : kSizes) {
    const std::vector<std::uint32_t> keys = keys_in_runs(n);
    const std::vector<Affine> maps = random_maps(n);
    std::vector<std::uint32_t> expected_keys;
    std::vector<Affine> expected_values;
    for (std::size_t i = 0; i < n; ++i) {
      if (i == 0 || keys[i] != keys[i - 1]) {
        expected_keys.push_back(keys[i]);
        expected_values.emplace_back();
      }
      expected_values.back() = then(expected_values.back(), maps[i]);
    }
    on_every_backend([&](auto& exec) {
      const auto out = reduce_by_key(exec, keys, maps, then);
      EXPECT_EQ(as_vector(out.keys), expected_keys);
      EXPECT_EQ(as_vector(out.values), expected_values);
    });
  }
}

TEST(ReduceByKey, OneHugeRunAndAllRunsOfOne) {
  const std::size_t n = 5 * kBlock + 17;
  std::vector<std::uint32_t> keys(n);
  std::iota(keys.begin(), keys.end(), 0U);
  const std::vector<Affine> maps = random_maps(n);
  on_every_backend([&](auto& exec) {
    const auto one = reduce_by_key(exec, constant(n, 9U), constant(n, std::uint64_t{1}));
    EXPECT_EQ(as_vector(one.keys), std::vector<unsigned>{9U});
    EXPECT_EQ(as_vector(one.values), std::vector<std::uint64_t>{n});
    const auto each = reduce_by_key(exec, keys, maps, then);
    EXPECT_EQ(as_vector(each.keys), keys);
    EXPECT_EQ(as_vector(each.values), maps);
  });
}

TEST(ReduceByKey, FloatSumsHaveOneResultOnAllBackends) {
  const std::size_t n = 200003;
  const std::vector<std::uint32_t> keys = keys_in_runs(n);
  const std::vector<float> values = random_floats(n);
  expect_one_result(
      [&](auto& exec) { return as_vector(reduce_by_key(exec, keys, values).values); });
}

}  // namespace
}  // namespace rastrum::parallel::test::scan_test
