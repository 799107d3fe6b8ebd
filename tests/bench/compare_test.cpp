// SPDX-License-Identifier: BSD-3-Clause
// The comparisons find what differs.
#include <bench/peers/compare.hpp>

#include <gtest/gtest.h>

namespace rastrum::bench::compare_test {
namespace {

TEST(Compare, CountsFindEachDifference) {
  Image<std::uint32_t> a(4, 4), b(4, 4);
  a(1, 1) = b(1, 1) = 3;
  a(2, 1) = 2, b(2, 1) = 1;
  b(3, 3) = 1;
  const CountDifference d = compare_counts(a, b);
  EXPECT_EQ(d.pixels, 2U);
  EXPECT_EQ(d.coverage, 1U);
  EXPECT_EQ(d.ours, 5U);
  EXPECT_EQ(d.theirs, 5U);
}

TEST(Compare, ColorsFindEachDifference) {
  Image<Rgba8> a(4, 1), b(4, 1);
  a(0, 0) = {10, 20, 30, 255}, b(0, 0) = {11, 19, 30, 255};  // within 1
  a(1, 0) = {10, 20, 30, 255}, b(1, 0) = {10, 22, 30, 255};  // a channel 2 apart
  a(2, 0) = {10, 20, 30, 255};                               // only one covers it
  const ColorDifference d = compare_colors(a, b, 1);
  EXPECT_EQ(d.covered, 3U);
  EXPECT_EQ(d.one_only, 1U);
  EXPECT_EQ(d.far, 2U);
  EXPECT_EQ(d.largest, 2);
  EXPECT_DOUBLE_EQ(d.share(), 1.0 / 3);
}

TEST(Compare, PicturesAreComparedAsTheyLookOverBlack) {
  Image<Vec4> a(4, 1), b(4, 1);
  a(0, 0) = b(0, 0) = {0.5F, 0.25F, 0.125F, 1};
  a(1, 0) = {0.5F, 0.5F, 0.5F, 1}, b(1, 0) = {0.5F, 0.75F, 0.5F, 1};
  a(2, 0) = {1.5F, 0, 0, 1}, b(2, 0) = {1, 0, 0, 0.5F};  // equal when displayed, but for alpha
  const PictureError e = picture_error(a, b, 0.1);       // the last pixel is empty in both
  EXPECT_EQ(e.covered, 3U);
  EXPECT_EQ(e.far, 2U);
  EXPECT_DOUBLE_EQ(e.worst, 0.5);
  EXPECT_DOUBLE_EQ(e.rmse, 0.25 / 3);
  EXPECT_NEAR(e.psnr(), 21.58, 0.01);
  EXPECT_DOUBLE_EQ(e.share(), 1.0 / 3);
  EXPECT_EQ(picture_error(a, a, 0).worst, 0);
}

}  // namespace
}  // namespace rastrum::bench::compare_test
