// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/core/view_rows.hpp>
#include <rastrum/image.hpp>

#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace rastrum::test::image_test {
namespace {

std::string message_of(const ImageView<int>& view, int width = 4, int height = 3) {
  try {
    check_size(view, width, height, "the target");
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::invalid_argument);
    return e.what();
  }
  return "";
}

TEST(ImageView, WithoutAStrideHasItsRowsOneAfterTheOther) {
  int pixels[12] = {};
  const ImageView<int> view{pixels, 4, 3};
  EXPECT_EQ(view.stride, 4);
  view(1, 2) = 7;
  EXPECT_EQ(pixels[9], 7);
  EXPECT_EQ((ImageView<int>{.data = pixels, .width = 4, .height = 3}.stride), 4);
  EXPECT_EQ(ImageView<int>{}.stride, 0);
  EXPECT_TRUE(ImageView<int>{}.empty());
}

TEST(ImageView, MayLieUpsideDown) {
  int pixels[12] = {};
  const ImageView<int> view{pixels + 8, 4, 3, -4};
  view(1, 2) = 7;
  EXPECT_EQ(pixels[1], 7);
  EXPECT_EQ(view.row(0), pixels + 8);
  EXPECT_EQ(message_of(view), "");
}

TEST(ImageView, WhoseRowsOverlapIsRefused) {
  int pixels[64] = {};
  EXPECT_EQ(message_of({pixels, 4, 3}), "");
  EXPECT_EQ(message_of({pixels, 4, 3, 9}), "");
  EXPECT_EQ(message_of({}), "");
  for (const std::ptrdiff_t stride : {0, 1, 3, -3})
    EXPECT_EQ(message_of({pixels + 32, 4, 3, stride}),
              "the target: rows of 4 pixels overlap with a stride of " + std::to_string(stride) +
                  "; make the view as {data, width, height}, or give the elements from a row to "
                  "the next (negative: from the bottom up)");
  ImageView<int> by_fields;
  by_fields.data = pixels;
  by_fields.width = 4;
  by_fields.height = 3;
  EXPECT_NE(message_of(by_fields).find("a stride of 0"), std::string::npos);
}

TEST(ImageView, OfAnotherSizeIsRefused) {
  int pixels[12] = {};
  EXPECT_EQ(message_of({pixels, 4, 3}, 3, 4), "the target is 4x3 and must be 3x4, as the frame is");
}

int sum(ImageView<const int> image) {
  int total = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) total += image(x, y);
  return total;
}

TEST(Image, IsAViewWhereOneIsWanted) {
  Image<int> image(3, 2);
  const ImageView<int> view = image;
  view(2, 1) = 5;
  EXPECT_EQ(image(2, 1), 5);
  EXPECT_EQ(sum(image), 5);
  EXPECT_EQ(sum(std::as_const(image)), 5);
  EXPECT_EQ(sum(Image<int>(2, 2)), 0) << "a temporary one may be read";
  static_assert(!std::is_convertible_v<Image<int>, ImageView<int>>, "but not be written");
  static_assert(!std::is_convertible_v<const Image<int>&, ImageView<int>>);
  static_assert(!std::is_convertible_v<Image<int>&, ImageView<const float>>);
}

}  // namespace
}  // namespace rastrum::test::image_test
