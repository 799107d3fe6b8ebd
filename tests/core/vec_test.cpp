// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/vec.hpp>

#include <gtest/gtest.h>

namespace rastrum::test::vec_test {
namespace {

// Rules for vectors of any size. `a` and `b` need even whole numbers.
template <Vector V>
void expect_arithmetic(V a, V b) {
  EXPECT_TRUE(a == a);
  EXPECT_FALSE(a == b);
  EXPECT_TRUE(a + -a == V{});
  EXPECT_TRUE(a - b == a + -b);
  EXPECT_TRUE(2.0F * a == a + a);
  EXPECT_TRUE(2 * a == a * 2);
  EXPECT_TRUE(a / 2 + a / 2 == a);
  V v = a;
  EXPECT_TRUE((v += b) == a + b);
  EXPECT_TRUE((v -= b) == a);
  EXPECT_TRUE((v *= b) == a * b);
  v = a;
  EXPECT_TRUE((v *= 4) == 4 * a);
  EXPECT_TRUE((v /= 2) == 2 * a);
  EXPECT_TRUE(v == 2 * a) << "the left side is what changes";
  EXPECT_EQ(&(v += a), &v);
}

TEST(Vector, HasTheArithmeticThatOneExpects) {
  expect_arithmetic(Vec2{2, -4}, Vec2{6, 8});
  expect_arithmetic(Vec3{2, -4, 6}, Vec3{8, 10, -12});
  expect_arithmetic(Vec4{2, -4, 6, 8}, Vec4{10, -12, 14, 16});
  static_assert(2.0F * Vec2{1, 2} == Vec2{2, 4} && Vec2{2, 4} / 2 == Vec2{1, 2});
  static_assert(Vec2{1, 2} * Vec2{3, 4} == Vec2{3, 8} && -Vec2{1, 2} == Vec2{-1, -2});
  static_assert(Vec3{3, 6, 9} / 3 == Vec3{1, 2, 3});
  static_assert(Vec4{3, 6, 9, 12} / 3 == Vec4{1, 2, 3, 4} && !(Vec4{0, 0, 0, 1} == Vec4{}));
}

}  // namespace
}  // namespace rastrum::test::vec_test
