// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/digest.hpp>

#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace rastrum::test::digest_test {
namespace {

/// From Python: hashlib.sha256(f"{a.dtype} {'x'.join(map(str, a.shape))}\n".encode() + a.tobytes())
/// of numpy.arange(n).reshape(shape).astype(type).
TEST(Digest, IsWhatPythonSays) {
  Image<Rgba8> colors(3, 2);
  for (std::uint8_t i = 0; Rgba8 & p : colors.pixels())
    for (std::uint8_t* const channel : {&p.r, &p.g, &p.b, &p.a}) *channel = i++;
  EXPECT_EQ(digest(colors).hex(),
            "5e5745de22866806ac177dd009c09263c150019b9a5ad866db56cc8e01910351");
  Image<float> depth(40, 30);  // more than a block, and no multiple of one
  for (float i = 0; float& d : depth.pixels()) d = i++;
  EXPECT_EQ(digest(depth).hex(),
            "bd0d7f49137dafdf244d9c3f230fecff5212fd931db046ee32229e04d94923eb");
  Image<std::int64_t> ids(5, 1);
  for (std::int64_t i = 0; std::int64_t & id : ids.pixels()) id = i++;
  EXPECT_EQ(digest(ids).hex(), "6b8a799ba102f54dd1b105cb4a192a4e286c486d98a4ee7ec82ee40ba445205c");
  Image<Vec4> wide(2, 2);
  for (float i = 0; Vec4 & v : wide.pixels())
    for (float* const channel : {&v.x, &v.y, &v.z, &v.w}) *channel = i++;
  EXPECT_EQ(digest(wide).hex(), "cbe04b6db9afcadce256c5692ab1ba6a2bf59fcf69450c0452705b5d32fd691e");
}

TEST(Digest, IsOfSizeTypeAndPixels) {
  Image<std::uint32_t> a(4, 2), b(2, 4);
  const Image<std::uint8_t> bytes(4, 2);
  EXPECT_NE(digest(a), digest(b));
  EXPECT_NE(digest(a), digest(bytes));
  b = a;
  EXPECT_EQ(digest(a), digest(b));
  b(3, 1) = 1;
  EXPECT_NE(digest(a), digest(b));
}

TEST(Digest, IsTheSameForEveryStride) {
  Image<std::uint32_t> whole(7, 5);
  for (std::uint32_t i = 0; std::uint32_t & v : whole.pixels()) v = i++;
  Image<std::uint32_t> part(3, 4);
  std::vector<std::uint32_t> from_below(3 * 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 3; ++x) {
      part(x, y) = whole(x + 2, y + 1);
      from_below[static_cast<std::size_t>((3 - y) * 3 + x)] = part(x, y);
    }
  const ImageView<const std::uint32_t> inside{&whole(2, 1), 3, 4, 7};
  const ImageView<const std::uint32_t> turned{from_below.data() + 9, 3, 4, -3};
  EXPECT_EQ(digest(inside), digest(part));
  EXPECT_EQ(digest(turned), digest(part));
  EXPECT_THROW((void)digest(ImageView<const std::uint32_t>{&whole(0, 0), 7, 5, 6}), Error);
}

TEST(Digest, KnowsOneNan) {
  Image<float> a(1, 1), b(1, 1), zero(1, 1);
  a(0, 0) = std::numeric_limits<float>::quiet_NaN();
  b(0, 0) = std::bit_cast<float>(0xffc12345U);
  EXPECT_EQ(digest(a), digest(b));
  zero(0, 0) = 0.0F;
  a(0, 0) = -0.0F;
  EXPECT_NE(digest(a), digest(zero));
}

}  // namespace
}  // namespace rastrum::test::digest_test
