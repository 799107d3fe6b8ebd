// SPDX-License-Identifier: BSD-3-Clause
// segmented_scan: its definition, and equal results on all backends.
#include <numeric>

#include "tests/parallel/backends.hpp"

namespace rastrum::parallel::test::segmented_test {
namespace {

/// The starts of segments of these sizes, and the number of elements.
std::pair<std::vector<std::uint32_t>, std::size_t> begins(const std::vector<std::uint32_t>& sizes) {
  std::vector<std::uint32_t> first(sizes.size());
  std::exclusive_scan(sizes.begin(), sizes.end(), first.begin(), 0U);
  return {first, std::reduce(sizes.begin(), sizes.end(), std::size_t{0})};
}

TEST(Segmented, ExampleOfThePaper) {
  // Paper 1, section 2.2.2.
  const std::vector<float> data = {1, 2, 3, 4, 5, 6, 7};
  const std::vector<std::uint32_t> first = {0, 3, 5, 6};
  on_every_backend([&](auto& exec) {
    std::vector<float> sums(7);
    segmented_scan<float>(exec, first, data, sums);
    EXPECT_EQ(sums, (std::vector<float>{1, 3, 6, 4, 9, 6, 7}));
  });
}

TEST(Segmented, FoldEachSegmentInOrderWithoutCommuting) {
  for (const auto& sizes : segment_sizes()) {
    const auto [first, n] = begins(sizes);
    const std::vector<Affine> maps = random_maps(n);
    std::vector<Affine> scanned;
    for (std::size_t s = 0; s < sizes.size(); ++s) {
      Affine sum;
      for (std::size_t j = 0; j < sizes[s]; ++j)
        scanned.push_back(sum = then(sum, maps[first[s] + j]));
    }
    on_every_backend([&, &first = first](auto& exec) {
      auto in_place = maps;
      segmented_scan<Affine>(exec, first, in_place, in_place, then);
      EXPECT_EQ(in_place, scanned);
    });
  }
}

TEST(Segmented, ComputeInTheTypeThatIsGiven) {
  const std::vector<std::uint8_t> ones(10000, 255);
  const std::vector<std::size_t> first = {0, 9000};
  on_every_backend([&](auto& exec) {
    std::vector<std::uint64_t> sums(ones.size());
    segmented_scan<std::uint64_t>(exec, first, ones, sums);
    EXPECT_EQ(sums[8999], 255U * 9000);
    EXPECT_EQ(sums[9999], 255U * 1000);
  });
}

TEST(Segmented, FloatSumsHaveOneResultOnAllBackends) {
  for (const auto& sizes : segment_sizes()) {
    const auto [first, n] = begins(sizes);
    const std::vector<float> values = random_floats(n);
    expect_one_result([&, &first = first, n = n](auto& exec) {
      std::vector<float> out(n);
      segmented_scan<float>(exec, first, values, out);
      return out;
    });
  }
}

}  // namespace
}  // namespace rastrum::parallel::test::segmented_test
