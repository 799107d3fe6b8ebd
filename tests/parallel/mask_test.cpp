// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/parallel/mask.hpp>

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace rastrum::parallel::mask_test {
namespace {

template <class M>
class MaskTest : public testing::Test {};
using Masks = testing::Types<Mask<8>, Mask<16>, Mask<32>, Mask<64>, Mask<128>, Mask<256>>;
TYPED_TEST_SUITE(MaskTest, Masks);

TYPED_TEST(MaskTest, MatchesASetOfNumbers) {
  std::mt19937_64 random(7);
  const int n = TypeParam::size();
  for (int density = 0; density <= 16; ++density)
    for (int repeat = 0; repeat < 50; ++repeat) {
      TypeParam mask;
      std::vector<int> elements;
      for (int i = 0; i < n; ++i)
        if (static_cast<int>(random() % 16) < density) {
          mask.set(i);
          elements.push_back(i);
        }
      ASSERT_EQ(mask.rank(), static_cast<int>(elements.size()));
      std::vector<int> visited, asked;
      mask.for_each([&](int i) { visited.push_back(i); });
      ASSERT_EQ(visited, elements);
      const int below_n = static_cast<int>(random() % static_cast<unsigned>(n + 1));
      const auto part = TypeParam::of(below_n, [&](int i) {
        asked.push_back(i);
        return mask.test(i);
      });
      ASSERT_EQ(static_cast<int>(asked.size()), below_n);
      for (int i = 0; i < n; ++i) ASSERT_EQ(part.test(i), i < below_n && mask.test(i)) << i;
      for (int i = 0; i < below_n; ++i) ASSERT_EQ(asked[static_cast<std::size_t>(i)], i);
      int below = 0;
      for (int i = 0; i <= n; ++i) {
        ASSERT_EQ(mask.rank(i), below) << i;
        if (i == n) break;
        const bool in = below < mask.rank() && elements[static_cast<std::size_t>(below)] == i;
        ASSERT_EQ(mask.test(i), in) << i;
        if (in) {
          ASSERT_EQ(mask.select(below++), i);
        }
      }
    }
}

TYPED_TEST(MaskTest, SetsOneBitOfAnEmptyMask) {
  for (int i = 0; i < TypeParam::size(); ++i) {
    TypeParam mask;
    EXPECT_EQ(mask.rank(), 0);
    mask.set(i);
    mask.set(i);
    EXPECT_EQ(mask.rank(), 1);
    EXPECT_EQ(mask.select(0), i);
  }
}

static_assert(sizeof(Mask<8>) == 1 && sizeof(Mask<16>) == 2 && sizeof(Mask<32>) == 4 &&
              sizeof(Mask<64>) == 8 && sizeof(Mask<128>) == 16 && sizeof(Mask<256>) == 32);

}  // namespace
}  // namespace rastrum::parallel::mask_test
