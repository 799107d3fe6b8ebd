// SPDX-License-Identifier: BSD-3-Clause
// PNGs whose picture is inflated before libpng reads it.
#include <rastrum/io/stored_png.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/io.hpp>
#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/parse.hpp>

#include "tests/io/png_file.hpp"

#include "tests/support/refused.hpp"

namespace rastrum::test::stored_png_test {
namespace {

io::Bytes bytes_of(const std::string& s) {
  return std::as_bytes(std::span(s));
}

/// A picture of several blocks of 64 KiB as a file, in parts.
struct Png : PngParts {
  std::string tail = png_chunk("tEXt", "after") + png_chunk("IEND", "");

  [[nodiscard]] std::string one() const { return head + png_chunk("IDAT", stream) + tail; }
  /// With IDATs of 0, 1, 2, … bytes, which cut the stream's header and its checksum.
  [[nodiscard]] std::string many() const {
    std::string file = head;
    for (std::size_t at = 0, n = 0; at < stream.size(); at += n++)
      file += png_chunk("IDAT", stream.substr(at, n));
    return file + tail;
  }
};

Image<Rgba8> picture() {
  Image<Rgba8> image(300, 200);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 300; ++x)
      image(x, y) = {static_cast<std::uint8_t>(x / 3 + y), static_cast<std::uint8_t>(x * y),
                     static_cast<std::uint8_t>(y / 5), 255};
  return image;
}
Png make_png() {
  const TempFolder folder;
  io::write_png(folder.path("a.png"), picture().view());
  return {parts_of_png(slurp(folder.path("a.png")))};
}

void expect_left_alone(const std::string& file) {
  const io::StoredPng stored(bytes_of(file));
  EXPECT_FALSE(stored.is_checked());
  ASSERT_EQ(stored.parts().size(), 1U);
  EXPECT_EQ(stored.parts()[0].data(), bytes_of(file).data());
  EXPECT_EQ(stored.parts()[0].size(), file.size());
}

TEST(StoredPng, IsAFileOfTheSamePicture) {
  const Png png = make_png();
  const Image<Rgba8> expected = picture();
  for (const std::string& file : {png.one(), png.many()}) {
    const io::StoredPng stored(bytes_of(file));
    ASSERT_TRUE(stored.is_checked());
    std::string joined;
    for (const io::Bytes& part : stored.parts()) joined += io::as_text(part);
    EXPECT_NE(joined, file);
    EXPECT_TRUE(joined.ends_with(png.tail));
    // The joined parts are a valid file, checksums included. Storing it again changes no byte.
    const io::StoredPng again(bytes_of(joined));
    ASSERT_TRUE(again.is_checked());
    std::string twice;
    for (const io::Bytes& part : again.parts()) twice += io::as_text(part);
    EXPECT_EQ(twice, joined);
    for (const std::string& each : {file, joined}) {
      const Image<Rgba8> read = io::decode_image(bytes_of(each), "a.png");
      EXPECT_TRUE(std::ranges::equal(read.pixels(), expected.pixels()));
    }
  }
}

TEST(StoredPng, WhatIsNotSoundIsLeftToLibpng) {
  const Png png = make_png();
  const std::string good = png.many();
  const auto expect_unsound = [](const std::string& file) {
    expect_left_alone(file);
    expect_refused("a.png: is not a valid PNG: ", Errc::bad_format,
                   [&] { (void)io::decode_image(bytes_of(file), "a.png"); });
  };
  std::string flipped = png.one();
  flipped[png.head.size() + 8 + png.stream.size()] ^= 1;  // a chunk's checksum
  expect_unsound(flipped);
  Png bad = png;
  bad.stream[bad.stream.size() / 2] ^= 1;  // its chunk's checksum is right
  expect_unsound(bad.one());
  bad = png;
  bad.stream.back() ^= 1;  // Adler's checksum, which libpng ignores
  expect_left_alone(bad.one());
  expect_unsound(good.substr(0, good.size() / 2));
  for (const std::size_t n : {0U, 7U, 8U, 11U, 20U, 32U, 33U, 40U})
    expect_left_alone(good.substr(0, n));
}

TEST(StoredPng, WhatIsNotAsUsualIsLeftToLibpng) {
  const Png png = make_png();
  const auto with_header = [&](std::size_t at, char value) {
    Png other = png;
    std::string header = png.head.substr(16, 13);
    header[at] = value;
    other.head = png.head.substr(0, 8) + png_chunk("IHDR", header) + png.head.substr(33);
    return other.one();
  };
  ASSERT_EQ(with_header(12, 0), png.one());
  expect_left_alone(with_header(12, 1));    // interlaced
  expect_left_alone(with_header(9, 5));     // no such type
  expect_left_alone(with_header(8, 32));    // nor depth
  expect_left_alone(with_header(0, 0x70));  // too wide
  expect_left_alone(with_header(3, 45));    // 301 wide: the stream is too short
  expect_left_alone(with_header(3, 43));    // 299 wide: it is too long
  Png other = png;
  other.stream += '\0';
  expect_left_alone(other.one());
}

}  // namespace
}  // namespace rastrum::test::stored_png_test
