// SPDX-License-Identifier: BSD-3-Clause
// The operators of paper 3's scans. terrain/methods_test.cpp and, for a device,
// terrain/cuda_renderer_test.cpp compare the pictures of `words` with the other methods'.
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

#include <papers/paper3/scans.hpp>

namespace rastrum::family::terrain_words_test {
namespace {

TEST(TerrainScans, AreAssociative) {
  std::mt19937 random(1);
  const auto pair = [&] {
    const std::int32_t row =
        random() % 4 == 0 ? terrain::kNoRow : static_cast<std::int32_t>(random() % 5);
    return Pair{
        {static_cast<std::uint8_t>(random()), 0, 0, 255}, static_cast<float>(random() % 100), row};
  };
  const auto pixel = [&] {
    return Pixel{{static_cast<std::uint8_t>(random()), 0, 0, 255},
                 static_cast<float>(random() % 3)};
  };
  const Occlude occlude;
  const Fill fill;
  for (int i = 0; i < 10000; ++i) {
    const Pair a = pair(), b = pair(), c = pair();
    EXPECT_EQ(occlude(occlude(a, b), c), occlude(a, occlude(b, c)));
    EXPECT_EQ(occlude(a, kNoPair), a);
    EXPECT_EQ(occlude(kNoPair, a).row, a.row);
    EXPECT_EQ(occlude(a, b), b.row < a.row ? b : a) << "of one row the nearer is seen";
    const Pixel p = pixel(), q = pixel(), r = pixel();
    // All empty pixels are equal, whatever colour they hold.
    const Pixel left = fill(fill(p, q), r), right = fill(p, fill(q, r));
    EXPECT_TRUE(left == right || (left.depth == 0 && right.depth == 0));
    EXPECT_EQ(fill(Pixel{}, q).depth, q.depth);
    EXPECT_EQ(fill(p, Pixel{}), p);
    if (q.depth != 0) {
      EXPECT_EQ(fill(p, q), q) << "what was drawn stays";
    }
  }
}

}  // namespace
}  // namespace rastrum::family::terrain_words_test
