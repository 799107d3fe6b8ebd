// SPDX-License-Identifier: BSD-3-Clause
// Images in and out, and what writers leave behind.
#include <sys/stat.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>

#include "tests/io/png_file.hpp"

#include "tests/support/directories.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::image_test {
namespace {

namespace fs = std::filesystem;

Image<Rgba8> random_image(int width, int height) {
  std::mt19937 random(1);
  Image<Rgba8> image(width, height);
  for (Rgba8& p : image.pixels()) {
    const auto bits = static_cast<std::uint32_t>(random());
    p = std::bit_cast<Rgba8>(bits);
  }
  return image;
}

std::size_t files_in(const fs::path& folder) {
  std::size_t n = 0;
  for ([[maybe_unused]] const auto& e : fs::directory_iterator(folder)) ++n;
  return n;
}

TEST(Png, RoundTripsStraightAlpha) {
  const TempFolder folder;
  const Image<Rgba8> image = random_image(37, 5);
  io::write_png(folder.path("a.png"), image.view());
  const Image<Rgba8> back = io::read_image(folder.path("a.png"));
  ASSERT_EQ(back.width(), 37);
  ASSERT_EQ(back.height(), 5);
  for (std::size_t i = 0; i < image.pixels().size(); ++i)
    EXPECT_EQ(back.pixels()[i], image.pixels()[i]);
  EXPECT_EQ(files_in(folder.path("")), 1U);
}

/// Whether zlib accepts the stream of a PNG, with its checksum, which libpng ignores.
bool is_sound_stream(const std::string& png) {
  std::string stream = parts_of_png(png).stream;
  z_stream z{};
  if (inflateInit(&z) != Z_OK) return false;
  z.next_in = reinterpret_cast<unsigned char*>(stream.data());
  z.avail_in = static_cast<uInt>(stream.size());
  std::vector<unsigned char> room(std::size_t{1} << 16U);
  int said = Z_OK;
  while (said == Z_OK) {
    z.next_out = room.data();
    z.avail_out = static_cast<uInt>(room.size());
    said = inflate(&z, Z_NO_FLUSH);
  }
  inflateEnd(&z);
  return said == Z_STREAM_END && z.avail_in == 0;
}

TEST(Png, OfManyBandsIsTheSameFileForEveryNumberOfThreads) {
  const TempFolder folder;
  // Smooth, so that a band's dictionary matters; bands of 64, 1 and 47 rows, the last one cut.
  for (const auto& [width, height] :
       {std::pair{512, 700}, {32768, 5}, {700, 94}, {700, 93}, {1, 3}}) {
    Image<Rgba8> image(width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        image(x, y) = {static_cast<std::uint8_t>(x / 3 + y), static_cast<std::uint8_t>(x * y),
                       static_cast<std::uint8_t>(y / 5), 255};
    io::write_png(folder.path("1.png"), image.view());
    const Image<Rgba8> back = io::read_image(folder.path("1.png"));
    ASSERT_EQ(back.width(), width);
    ASSERT_EQ(back.height(), height);
    ASSERT_TRUE(std::ranges::equal(back.pixels(), image.pixels()));
    EXPECT_TRUE(is_sound_stream(slurp(folder.path("1.png"))));
    for (const int threads : {0, 2, 5}) {
      io::write_png(folder.path("n.png"), image.view(), threads);
      EXPECT_EQ(slurp(folder.path("n.png")), slurp(folder.path("1.png"))) << threads;
    }
  }
  // Noise cannot be compressed: no band may exceed its buffer.
  const Image<Rgba8> noise = random_image(600, 400);
  io::write_png(folder.path("r.png"), noise.view(), 2);
  EXPECT_TRUE(std::ranges::equal(io::read_image(folder.path("r.png")).pixels(), noise.pixels()));
}

/// Writes a picture in bands of `rows` rows.
template <class Pixel>
void write_in_bands(const std::filesystem::path& file, io::PictureRows::Format format,
                    ImageView<const Pixel> image, int rows, int threads) {
  io::AtomicFile out(file);
  io::PictureRows picture(out, format, image.width, image.height, threads);
  for (int y = 0; y < image.height; y += rows) {
    ImageView<const Pixel> band = image;
    band.data += y * band.stride;
    band.height = std::min(rows, image.height - y);
    picture.add(band);
  }
  picture.finish();
  out.commit();
}

TEST(PictureRows, MakeTheFileOfTheWhole) {
  const TempFolder folder;
  for (const auto& [width, height] : {std::pair{512, 700}, {32768, 5}, {700, 94}, {1, 3}}) {
    const Image<Rgba8> image = random_image(width, height);
    io::write_png(folder.path("one.png"), image.view(), 2);
    for (const int rows : {1, 7, 64, 300})
      for (const int threads : {1, 3}) {
        write_in_bands(folder.path("many.png"), io::PictureRows::Format::png, image.view(), rows,
                       threads);
        ASSERT_EQ(slurp(folder.path("many.png")), slurp(folder.path("one.png")))
            << width << "x" << height << " by " << rows;
      }
  }
  Image<Vec4> colors(33, 70);
  Image<float> depth(33, 70);
  Image<std::int64_t> ids(33, 70);
  for (std::size_t i = 0; i < colors.pixels().size(); ++i) {
    depth.pixels()[i] = static_cast<float>(i) / 7;
    colors.pixels()[i] = {depth.pixels()[i], 1, 2, 3};
    ids.pixels()[i] = static_cast<std::int64_t>(i * i);
  }
  const auto compare = [&](const auto& image, io::PictureRows::Format format, const auto& write) {
    write(folder.path("one"), image.view());
    write_in_bands(folder.path("many"), format, image.view(), 32, 1);
    EXPECT_EQ(slurp(folder.path("many")), slurp(folder.path("one")));
  };
  const auto npy = [](const auto& file, const auto& view) { io::write_npy(file, view); };
  compare(std::as_const(colors), io::PictureRows::Format::npy, npy);
  compare(std::as_const(depth), io::PictureRows::Format::npy, npy);
  compare(std::as_const(ids), io::PictureRows::Format::npy, npy);
  const auto exr = [](const auto& file, const auto& view) { io::write_exr(file, view); };
  try {
    exr(folder.path("one"), std::as_const(colors).view());
  } catch (const Error&) {
    return;  // built without
  }
  compare(std::as_const(colors), io::PictureRows::Format::exr, exr);
  compare(std::as_const(depth), io::PictureRows::Format::exr, exr);
}

TEST(PictureRows, RefuseWhatIsNoPicture) {
  const TempFolder folder;
  io::AtomicFile out(folder.path("a.png"));
  const Image<Rgba8> image = random_image(4, 3);
  const Image<float> depth(4, 1);
  io::PictureRows rows(out, io::PictureRows::Format::png, 4, 4);
  expect_refused("a.png: pixels of this kind", Errc::invalid_argument,
                 [&] { rows.add(depth.view()); });
  const Image<Rgba8> wide = random_image(5, 1);
  expect_refused("a.png: rows of 5 pixels, 1 of them after 0, in a picture of 4x4",
                 Errc::invalid_argument, [&] { rows.add(wide.view()); });
  rows.add(image.view());
  expect_refused("a.png: rows of 4 pixels, 3 of them after 3, in a picture of 4x4",
                 Errc::invalid_argument, [&] { rows.add(image.view()); });
  expect_refused("a.png: rows of another kind", Errc::invalid_argument,
                 [&] { rows.add(depth.view()); });
  expect_refused("a.png: 3 of 4 rows", Errc::invalid_argument, [&] { rows.finish(); });
}

TEST(Png, WritesAPartOfAnImage) {
  const TempFolder folder;
  const Image<Rgba8> image = random_image(8, 8);
  ImageView<const Rgba8> part = image.view();
  part.data += 8 * 2 + 3;
  part.width = 4;
  part.height = 3;
  io::write_png(folder.path("a.png"), part);
  EXPECT_EQ(io::read_image(folder.path("a.png"))(1, 2), image(4, 4));
}

TEST(Png, EveryTruncationAndEveryFlippedByteIsAnErrorOrTheSamePicture) {
  const TempFolder folder;
  const Image<Rgba8> image = random_image(4, 4);
  io::write_png(folder.path("a.png"), image.view());
  const std::string good = slurp(folder.path("a.png"));
  const auto decode = [](const std::string& s) {
    return io::decode_image(std::as_bytes(std::span(s)), "here.png");
  };
  for (std::size_t n = 0; n < good.size(); ++n)
    EXPECT_THROW((void)decode(good.substr(0, n)), Error) << n;
  for (std::size_t n = 0; n < good.size(); ++n) {
    std::string bad = good;
    bad[n] = static_cast<char>(bad[n] ^ 0x10);
    EXPECT_THROW((void)decode(bad), Error) << n;
  }
}

TEST(Png, ASmallFileCannotAskForAHugeImage) {
  // A valid IHDR of 32768 × 32768 RGBA, then nothing.
  const std::string bytes =
      "\x89PNG\r\n\x1A\n" +
      png_chunk("IHDR", std::string("\0\0\x80\0\0\0\x80\0\x08\x06\0\0\0", 13)) +
      png_chunk("IDAT", "");
  const std::string said =
      refusal_of([&] { (void)io::decode_image(std::as_bytes(std::span(bytes)), "bomb.png"); },
                 Errc::bad_format);
  EXPECT_TRUE(holds(said, "bomb.png"));
  EXPECT_TRUE(holds(said, "too short"));
}

TEST(Jpeg, TruncationIsAnError) {
  const fs::path file = shared_dir() / "data/terrain/jotunheimen-texture.jpg";
  if (!fs::exists(file)) GTEST_SKIP() << file << " is not there";
  const Image<Rgba8> image = io::read_image(file);
  EXPECT_EQ(image.width(), 4096);
  EXPECT_EQ(image(100, 100).a, 255);
  const std::string bytes = slurp(file).substr(0, 400000);
  EXPECT_THROW((void)io::decode_image(std::as_bytes(std::span(bytes)), "cut.jpg"), Error);
}

TEST(Npy, HeadersAndRows) {
  const TempFolder folder;
  Image<float> depth(3, 2);
  depth(2, 1) = 0.5F;
  io::write_npy(folder.path("d.npy"), std::as_const(depth).view());
  const std::string bytes = slurp(folder.path("d.npy"));
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\0", 8));
  const std::size_t start =
      10 + static_cast<unsigned char>(bytes[8]) + 256U * static_cast<unsigned char>(bytes[9]);
  EXPECT_EQ(start % 64, 0U);
  EXPECT_EQ(bytes[start - 1], '\n');
  EXPECT_EQ(bytes.substr(10, 61), "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }  ");
  ASSERT_EQ(bytes.size(), start + 24);
  EXPECT_EQ(bytes.substr(start + 20), raw(0.5F));

  Image<Vec4> color(1, 1);
  io::write_npy(folder.path("c.npy"), std::as_const(color).view());
  EXPECT_TRUE(
      holds(slurp(folder.path("c.npy")), "'<f4', 'fortran_order': False, 'shape': (1, 1, 4), }"));
  Image<std::int64_t> ids(5, 1);
  ids(4, 0) = -1;
  io::write_npy(folder.path("i.npy"), std::as_const(ids).view());
  EXPECT_TRUE(
      holds(slurp(folder.path("i.npy")), "'<i8', 'fortran_order': False, 'shape': (1, 5), }"));
}

TEST(Exr, WritesChannelsOrSaysWhatIsMissing) {
  const TempFolder folder;
  Image<Vec4> color(3, 2);
  color(1, 1) = {0.25F, 2, -1, 0.5F};
  try {
    io::write_exr(folder.path("a.exr"), std::as_const(color).view());
  } catch (const Error& e) {
    ASSERT_EQ(e.code(), Errc::unsupported);
    EXPECT_TRUE(holds(e.what(), "libopenexr-dev"));
    GTEST_SKIP() << "built without OpenEXR";
  }
  EXPECT_EQ(slurp(folder.path("a.exr")).substr(0, 4), "\x76\x2F\x31\x01");
  EXPECT_EQ(files_in(folder.path("")), 1U);
}

TEST(Writers, TakeImagesUpsideDownAndRefuseRowsThatOverlap) {
  const TempFolder folder;
  Image<Vec4> image(3, 2), turned(3, 2);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x)
      image(x, y) = turned(x, 1 - y) = {static_cast<float>(x), static_cast<float>(y), 0.5F, 1};
  const ImageView<const Vec4> from_below{&turned(0, 1), 3, 2, -3},
      overlapping{&image(0, 0), 3, 2, 0};
  io::write_npy(folder.path("a.npy"), image);
  io::write_npy(folder.path("b.npy"), from_below);
  EXPECT_EQ(slurp(folder.path("a.npy")), slurp(folder.path("b.npy")));
  const auto refuses = [&](auto&& write) {
    try {
      write();
    } catch (const Error& e) {
      return e.code() == Errc::unsupported ||
             std::string(e.what()).find("rows of 3 pixels overlap") != std::string::npos;
    }
    return false;
  };
  EXPECT_TRUE(refuses([&] { io::write_npy(folder.path("c.npy"), overlapping); }));
  EXPECT_TRUE(refuses([&] { io::write_exr(folder.path("c.exr"), overlapping); }));
  const Image<Rgba8> pixels(3, 2);
  const ImageView<const Rgba8> rows{&pixels(0, 0), 3, 2, 0};
  EXPECT_TRUE(refuses([&] { io::write_png(folder.path("c.png"), rows); }));
  EXPECT_EQ(files_in(folder.path("")), 2U);
  try {
    io::write_exr(folder.path("a.exr"), image);
    io::write_exr(folder.path("b.exr"), from_below);
    EXPECT_EQ(slurp(folder.path("a.exr")), slurp(folder.path("b.exr")));
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::unsupported) << e.what();
  }
}

TEST(Writers, ReplaceTheOldFileAndFollowLinks) {
  const TempFolder folder;
  folder.write("real.npy", "old");
  fs::create_symlink("real.npy", folder.path("link.npy"));
  const Image<float> image(1, 1);
  io::write_npy(folder.path("link.npy"), image.view());
  EXPECT_TRUE(fs::is_symlink(folder.path("link.npy")));
  EXPECT_GT(fs::file_size(folder.path("real.npy")), 64U);
  EXPECT_EQ(files_in(folder.path("")), 2U);
  const mode_t mask = ::umask(0);
  ::umask(mask);
  EXPECT_EQ(static_cast<unsigned>(fs::status(folder.path("real.npy")).permissions()),
            0666U & ~mask);
}

TEST(Writers, LeaveNothingBehindWhenTheyFail) {
  const TempFolder folder;
  const Image<float> image(2, 2);
  const Image<Rgba8> pixels(2, 2);
  EXPECT_THROW(io::write_npy(folder.path("none/a.npy"), image.view()), Error);
  EXPECT_THROW(io::write_png(folder.path(""), pixels.view()), Error);
  EXPECT_THROW(io::write_png(folder.path("a.png"), ImageView<const Rgba8>{}), Error);
  if (fs::exists("/dev/full")) {
    expect_refused("/dev/full", Errc::io, [&] { io::write_npy("/dev/full", image.view()); });
    EXPECT_TRUE(fs::is_character_file("/dev/full")) << "a device must not be replaced";
  }
  EXPECT_EQ(files_in(folder.path("")), 0U);
}

TEST(WritePly, RoundTripsWhatSharesThePositions) {
  const TempFolder folder;
  Mesh m{.positions = {{0, 0, 0}, {1, 0, 0.1F}, {0, 1, 0}, {5, 5, 5}},
         .indices = {0, 1, 2, 2, 1, 3}};
  m.normals.values = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}};
  m.texcoords.values = {{0, 0}, {1, 0.25F}, {0, 1}, {0.5F, 0.5F}};
  for (const float red : {51 / 255.0F, 0.123F}) {  // one fits a byte, one does not
    m.colors.values = {{red, 0, 1, 1}, {0, 0, 0, 0}, {1, 1, 1, 1}, {0, 1, 0, 1}};
    io::write_ply(folder.path("a.ply"), m);
    const Scene s = io::read_scene(folder.path("a.ply"));
    const Mesh& back = s.meshes[0];
    EXPECT_EQ(back.indices, m.indices);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_TRUE(back.positions[i] == m.positions[i]);
      EXPECT_TRUE(back.normals.values[i] == m.normals.values[i]);
      EXPECT_EQ(back.texcoords.values[i].y, m.texcoords.values[i].y);
      EXPECT_FLOAT_EQ(back.colors.values[i].x, m.colors.values[i].x);
      EXPECT_EQ(back.colors.values[i].w, m.colors.values[i].w);
    }
  }
  Mesh few = m;
  few.normals.values.resize(3);
  EXPECT_THROW(io::write_ply(folder.path("b.ply"), few), Error) << "normals lost without a word";
  m.indices = {0, 1, 4};
  EXPECT_THROW(io::write_ply(folder.path("b.ply"), m), Error);
}

TEST(WritePly, DrawsPositionsInOrderWhereThereAreNoIndices) {
  const TempFolder folder;
  Mesh m{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  io::write_ply(folder.path("a.ply"), m);
  EXPECT_EQ(io::read_scene(folder.path("a.ply")).meshes[0].indices,
            (std::vector<std::uint32_t>{0, 1, 2}));
}

}  // namespace
}  // namespace rastrum::test::image_test
