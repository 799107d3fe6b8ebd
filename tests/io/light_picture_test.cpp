// SPDX-License-Identifier: BSD-3-Clause
// Pictures of light: Radiance's with each encoding of its pixels, OpenEXR's, sRGB ones.
#include <cmath>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/io.hpp>

#include "tests/io/files.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::light_picture_test {
namespace {

using Pixel = std::vector<int>;

std::string bytes_of(const Pixel& values) {
  std::string bytes;
  for (const int v : values) bytes.push_back(static_cast<char>(v));
  return bytes;
}
std::string radiance(const std::string& body, const std::string& size = "-Y 2 +X 8",
                     const std::string& more = "FORMAT=32-bit_rle_rgbe\n") {
  return "#?RADIANCE\n# by hand\n" + more + "\n" + size + "\n" + body;
}
Image<Vec3> decode(const std::string& text) {
  return io::decode_light(std::as_bytes(std::span(text)), "a.hdr");
}
void refused(const char* part, Errc code, const std::string& text) {
  expect_refused(part, code, [&] { (void)decode(text); });
}

// Two rows of eight: 1, 2, 3, … of (m, 2 m, 3 m) · 2^−7.
std::string flat_rows() {
  std::string all;
  for (int i = 0; i < 16; ++i) all += bytes_of({i + 3, 2 * i + 3, 3 * i + 3, 129});
  return all;
}
void expect_rows(const Image<Vec3>& image, float scale = 1) {
  ASSERT_EQ(image.width(), 8);
  ASSERT_EQ(image.height(), 2);
  for (int i = 0; i < 16; ++i) {
    const auto m = static_cast<float>(i);
    EXPECT_EQ(image(i % 8, i / 8), (Vec3{m + 3, 2 * m + 3, 3 * m + 3} * (scale / 128))) << i;
  }
}

TEST(Radiance, ReadsPlainPixels) {
  expect_rows(decode(radiance(flat_rows())));
}

TEST(Radiance, ReadsRunsOfChannels) {
  const std::string flat = flat_rows();
  std::string body;
  for (int row = 0; row < 2; ++row) {
    body += bytes_of({2, 2, 0, 8});
    for (std::size_t c = 0; c < 3; ++c) {
      body += bytes_of({5});  // five literal values, then a run of three
      for (std::size_t x = 0; x < 5; ++x)
        body += flat[(static_cast<std::size_t>(row) * 8 + x) * 4 + c];
      body += bytes_of({3});
      for (std::size_t x = 5; x < 8; ++x)
        body += flat[(static_cast<std::size_t>(row) * 8 + x) * 4 + c];
    }
    body += bytes_of({128 + 8, 129});
  }
  expect_rows(decode(radiance(body)));
}

TEST(Radiance, ReadsRunsOfPixels) {
  std::string body = bytes_of({10, 20, 30, 128});
  body += bytes_of({1, 1, 1, 4});  // four more
  body += bytes_of({7, 7, 7, 130});
  const Image<Vec3> image = decode(radiance(body, "-Y 1 +X 6"));
  for (int x = 0; x < 5; ++x) EXPECT_EQ(image(x, 0), (Vec3{10, 20, 30} * (1.0F / 256)));
  EXPECT_EQ(image(5, 0), (Vec3{7, 7, 7} * (4.0F / 256)));
  // 2 + 256 · 1 repetitions.
  const Image<Vec3> wide =
      decode(radiance(bytes_of({9, 9, 9, 128, 1, 1, 1, 2, 1, 1, 1, 1}), "-Y 1 +X 259"));
  EXPECT_EQ(wide(258, 0), wide(0, 0));
}

TEST(Radiance, TakesExposuresBack) {
  expect_rows(decode(radiance(flat_rows(), "-Y 2 +X 8", "EXPOSURE=4\nEXPOSURE= 2\n")), 0.125F);
}

TEST(Radiance, ThatIsUnsoundIsRefused) {
  using enum Errc;
  const std::string flat = flat_rows();
  refused("header does not end", bad_format, "#?RADIANCE\n");
  refused("header does not end", bad_format, "#?" + std::string(10000, 'x'));
  refused("32-bit_rle_xyze", unsupported, radiance(flat, "-Y 2 +X 8", "FORMAT=32-bit_rle_xyze\n"));
  refused("EXPOSURE is 0", bad_format, radiance(flat, "-Y 2 +X 8", "EXPOSURE=0\n"));
  refused("'hell' is no number", bad_format, radiance(flat, "-Y 2 +X 8", "EXPOSURE=hell\n"));
  refused("EXPOSURE is nan", bad_format, radiance(flat, "-Y 2 +X 8", "EXPOSURE=nan\n"));
  refused("its rows lie as '+Y 2 +X 8'", unsupported, radiance(flat, "+Y 2 +X 8"));
  refused("its size is 'two by eight'", bad_format, radiance(flat, "two by eight"));
  refused("its size is '-Y 0 +X 8'", bad_format, radiance(flat, "-Y 0 +X 8"));
  refused("its size is '-Y 2 +X -8'", bad_format, radiance(flat, "-Y 2 +X -8"));
  refused("beyond 32768", unsupported, radiance(flat, "-Y 99999999999 +X 8"));
  refused("too short for its size", bad_format, radiance(flat, "-Y 32768 +X 32768"));
  refused("row 1: the file ends too early", bad_format, radiance(flat.substr(0, 50)));
  refused("row 0: it repeats a pixel before the first", bad_format,
          radiance(bytes_of({1, 1, 1, 8})));
  refused("row 0: a run does not fit", bad_format,
          radiance(bytes_of({5, 5, 5, 5, 1, 1, 1, 9}) + flat));
  refused("row 0: it says that it has 9 pixels", bad_format,
          radiance(bytes_of({2, 2, 0, 9}) + flat));
  refused("row 0: a run does not fit", bad_format,
          radiance(bytes_of({2, 2, 0, 8, 128 + 9, 1}) + flat));
  refused("row 0: a run does not fit", bad_format, radiance(bytes_of({2, 2, 0, 8, 0, 1}) + flat));
}

// Any bytes end in an error or a picture.
TEST(Radiance, SurvivesAnyBytes) {
  std::mt19937 random(1);
  for (int i = 0; i < 3000; ++i) {
    std::string body;
    for (int k = 0; k < 200; ++k)
      body.push_back(static_cast<char>(random() % 4 == 0 ? random() : random() % 3));
    if (i % 2 == 0) body = bytes_of({2, 2, 0, 12}) + body;
    try {
      (void)decode(radiance(body, "-Y 3 +X 12"));
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), Errc::bad_format);
    }
  }
}

TEST(OpenExr, ColoursComeBack) {
  const TempFolder folder;
  Image<Vec4> image(6, 3);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 6; ++x)
      image(x, y) = {static_cast<float>(x) * 100, static_cast<float>(y), 1e-6F, 0.5F};
  try {
    io::write_exr(folder.path("a.exr"), image.view());
  } catch (const Error& e) {
    ASSERT_EQ(e.code(), Errc::unsupported);
    GTEST_SKIP() << e.what();
  }
  const Image<Vec3> back = io::read_light(folder.path("a.exr"));
  ASSERT_EQ(back.width(), 6);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 6; ++x)
      EXPECT_EQ(back(x, y), (Vec3{image(x, y).x, image(x, y).y, image(x, y).z}));
  // Positions have no colours.
  io::write_exr(folder.path("b.exr"), Image<Vec3>(4, 2).view());
  expect_refused("has no channel R", Errc::unsupported,
                 [&] { (void)io::read_light(folder.path("b.exr")); });
}

TEST(OpenExr, ThatIsCutIsRefused) {
  const TempFolder folder;
  try {
    io::write_exr(folder.path("a.exr"), Image<Vec4>(64, 32).view());
  } catch (const Error& e) {
    GTEST_SKIP() << e.what();
  }
  const std::string whole = slurp(folder.path("a.exr"));
  for (std::size_t size = 4; size < whole.size(); size += 37)
    expect_refused("cut.exr", Errc::bad_format, [&] {
      (void)io::decode_light(std::as_bytes(std::span(whole).first(size)), "cut.exr");
    });
  std::mt19937 random(1);
  for (int i = 0; i < 500; ++i) {
    std::string bytes = whole;
    for (int k = 0; k < 4; ++k)
      bytes[4 + random() % (bytes.size() - 4)] = static_cast<char>(random());
    try {
      (void)io::decode_light(std::as_bytes(std::span(bytes)), "changed.exr");
    } catch (const Error& e) {
      EXPECT_TRUE(holds(e.what(), "changed.exr"));
    }
  }
}

TEST(LightPictures, OfDisplayValuesBecomeLinear) {
  const TempFolder folder;
  Image<Rgba8> image(2, 1);
  image(0, 0) = {0, 255, 128, 255};
  io::write_png(folder.path("a.png"), image.view());
  const Image<Vec3> light = io::read_light(folder.path("a.png"));
  EXPECT_EQ(light(0, 0).x, 0);
  EXPECT_EQ(light(0, 0).y, 1);
  EXPECT_NEAR(light(0, 0).z, std::pow((128 / 255.0 + 0.055) / 1.055, 2.4), 1e-7);
  expect_refused("give an .hdr", Errc::unsupported, [&] { (void)decode("P6 2 1 255 "); });
}

}  // namespace
}  // namespace rastrum::test::light_picture_test
