// SPDX-License-Identifier: BSD-3-Clause
// Height maps are read exactly, in every type and byte order. Damaged files are refused with name
// and place.
#include <cmath>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>

#include "tests/io/dem_file.hpp"
#include "tests/io/png_file.hpp"

#include "tests/support/directories.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::height_test {
namespace {

using io::HeightGrid;

std::span<const std::byte> bytes_of(const std::string& s) {
  return std::as_bytes(std::span(s.data(), s.size()));
}

/// Expects that f() throws an error of `code` that says `part` and names the file.
template <class F>
void expect_refused(Errc code, const std::string& part, F&& f) {
  const std::string said = refusal_of(f, code);
  EXPECT_TRUE(holds(said, part));
  EXPECT_TRUE(said.starts_with("in.put")) << said;
}

// --- NPY

std::string npy(const std::string& descr, const std::string& order, const std::string& shape,
                const std::string& data, char version = 1) {
  std::string header =
      "{'descr': '" + descr + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }\n";
  std::string file("\x93NUMPY", 6);
  file += version;
  file += '\0';
  file += static_cast<char>(header.size());
  file.append(version == 1 ? 1 : 3, '\0');
  return file + header + data;
}

HeightGrid read_npy(const std::string& file) {
  return io::decode_heights(bytes_of(file), "npy", "in.put");
}

template <class T>
void check_type(const char* kind) {
  // 2 rows of 3, with a negative value if the type has one.
  const T values[6] = {T(1), T(2), T(3), T(100), std::is_signed_v<T> ? T(-5) : T(5), T(6)};
  for (const bool swap : {false, true})
    for (const bool fortran : {false, true}) {
      std::string data;
      for (std::size_t i = 0; i < 6; ++i)
        data += raw(values[fortran ? i % 2 * 3 + i / 2 : i], swap);
      const HeightGrid g = read_npy(
          npy((swap ? ">" : "<") + std::string(kind), fortran ? "True" : "False", "(2, 3)", data));
      ASSERT_EQ(g.heights.width(), 3);
      ASSERT_EQ(g.heights.height(), 2);
      for (std::size_t i = 0; i < 6; ++i)
        EXPECT_EQ(g.heights.pixels()[i], static_cast<float>(values[i]))
            << kind << " swap " << swap << " fortran " << fortran << " at " << i;
    }
}

TEST(HeightNpy, EveryTypeOrderAndEndianness) {
  check_type<float>("f4");
  check_type<double>("f8");
  check_type<std::int8_t>("i1");
  check_type<std::uint8_t>("u1");
  check_type<std::int16_t>("i2");
  check_type<std::uint16_t>("u2");
  check_type<std::int32_t>("i4");
  check_type<std::uint32_t>("u4");
}

TEST(HeightNpy, VersionsTwoAndThreeAndWhatFloat32CannotHold) {
  for (const char version : {char{2}, char{3}})
    EXPECT_EQ(read_npy(npy("<f4", "False", "(1,1)", raw(7.5F), version)).heights(0, 0), 7.5F);
  const HeightGrid g =
      read_npy(npy("<f8", "False", "(1, 3)", raw(1e300) + raw(-1e300) + raw(std::nan(""))));
  EXPECT_EQ(g.heights(0, 0), INFINITY);
  EXPECT_EQ(g.heights(1, 0), -INFINITY);
  EXPECT_TRUE(std::isnan(g.heights(2, 0)));
}

TEST(HeightNpy, RefusesWhatIsDamaged) {
  const std::string four(16, '\0');
  const std::string good = npy("<f4", "False", "(2, 2)", four);
  ASSERT_NO_THROW((void)read_npy(good));
  for (std::size_t n = 0; n < good.size(); ++n)
    expect_refused(Errc::bad_format, "", [&] { (void)read_npy(good.substr(0, n)); });
  const auto refuse = [](Errc code, const std::string& part, const std::string& file) {
    SCOPED_TRACE(part);
    expect_refused(code, part, [&] { (void)read_npy(file); });
  };
  refuse(Errc::bad_format, "3 of 4", npy("<f4", "False", "(2, 2)", four.substr(1)));
  refuse(Errc::unsupported, "3 dimensions", npy("<f4", "False", "(2, 2, 1)", four));
  refuse(Errc::unsupported, "1 dimensions", npy("<f4", "False", "(4,)", four));
  refuse(Errc::unsupported, "'<c8'", npy("<c8", "False", "(1, 2)", four));
  refuse(Errc::unsupported, "outside", npy("<f4", "False", "(0, 2)", four));
  refuse(Errc::unsupported, "outside", npy("<f4", "False", "(4294967296, 4294967296)", four));
  refuse(Errc::bad_format, "no number", npy("<f4", "False", "(99999999999999999999999, 1)", four));
  refuse(Errc::bad_format, "no number", npy("<f4", "False", "(-2, 2)", four));
  refuse(Errc::bad_format, "no number", npy("<f4", "False", "(2, 2", four));
  refuse(Errc::bad_format, "fortran_order", npy("<f4", "Maybe", "(2, 2)", four));
  refuse(Errc::bad_format, "version", npy("<f4", "False", "(2, 2)", four, 9));
}

// --- Raw

TEST(HeightRaw, SquareOrOfTheGivenSize) {
  std::string file;
  for (int i = 0; i < 16; ++i) file += std::string{static_cast<char>(i), '\x01'};
  const HeightGrid square = io::decode_heights(bytes_of(file), "raw", "in.put");
  EXPECT_EQ(square.heights.width(), 4);
  EXPECT_EQ(square.heights(1, 2), 256 + 9);
  EXPECT_EQ(square.units_per_cell, 257);
  EXPECT_FALSE(square.scale_known);
  const HeightGrid wide = io::decode_heights(bytes_of(file), "raw", "in.put", {8, 2});
  EXPECT_EQ(wide.heights.width(), 8);
  EXPECT_EQ(wide.heights(1, 1), 256 + 9);
  const HeightGrid big = io::decode_heights(bytes_of(file), "raw", "in.put", {.big_endian = true});
  EXPECT_EQ(big.heights(1, 2), 256 * 9 + 1);
}

TEST(HeightRaw, RefusesOtherSizes) {
  const std::string odd(31, '\0'), six(12, '\0');
  const auto read = [](const std::string& f, io::RawSize size = {}) {
    return [&f, size] { (void)io::decode_heights(bytes_of(f), "raw", "in.put", size); };
  };
  expect_refused(Errc::bad_format, "31 bytes", read(odd));
  expect_refused(Errc::bad_format, "--height-size", read(six));
  expect_refused(Errc::bad_format, "--height-size", read(""));
  expect_refused(Errc::bad_format, "take 8", read(six, {2, 2}));
  expect_refused(Errc::bad_format, "has 12", read(six, {-6, -1}));
  expect_refused(Errc::bad_format, "has 12", read(six, {2147483647, 2147483647}));
}

// --- PNG

/// 16-bit grey PNGs, which this library does not write.
std::string png16(int width, int height, const std::vector<std::uint16_t>& values) {
  std::string rows;
  for (std::size_t i = 0; i < values.size(); ++i)
    rows += (i % static_cast<std::size_t>(width) == 0 ? std::string(1, '\0') : "") +
            raw(values[i], true);
  std::string packed(compressBound(rows.size()), '\0');
  uLongf size = packed.size();
  EXPECT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size,
                     reinterpret_cast<const Bytef*>(rows.data()), rows.size()),
            Z_OK);
  return "\x89PNG\r\n\x1a\n" +
         png_chunk("IHDR", raw(width, true) + raw(height, true) + std::string("\x10\0\0\0\0", 5)) +
         png_chunk("IDAT", packed.substr(0, size)) + png_chunk("IEND", "");
}

TEST(HeightPng, SixteenBitsAreKept) {
  const std::vector<std::uint16_t> expected{0, 1, 256, 65535, 4660, 300};
  const std::string file = png16(3, 2, expected);
  const HeightGrid g = io::decode_heights(bytes_of(file), "png", "in.put");
  ASSERT_EQ(g.heights.width(), 3);

  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(g.heights.pixels()[i], expected[i]);
  EXPECT_EQ(g.units_per_cell, 257);
  EXPECT_FALSE(g.scale_known);
  for (std::size_t n = 0; n < file.size(); ++n)
    expect_refused(Errc::bad_format, "PNG", [&] {
      const std::string cut = file.substr(0, n);
      (void)io::decode_heights(bytes_of(cut), "png", "in.put");
    });
}

TEST(HeightPng, EightBitsAsTheyAreAndNoColours) {
  const TempFolder folder;
  Image<Rgba8> image(256, 1);
  for (int x = 0; x < 256; ++x) {
    const auto v = static_cast<std::uint8_t>(x);
    image(x, 0) = {v, v, v, 255};
  }
  io::write_png(folder.path("h.png"), image.view());
  const HeightGrid g = io::read_heights(folder.path("h.png"));
  for (int x = 0; x < 256; ++x) EXPECT_EQ(g.heights(x, 0), static_cast<float>(x));
  EXPECT_EQ(g.units_per_cell, 1);
  EXPECT_TRUE(g.scale_known);
  image(7, 0).g = 8;
  io::write_png(folder.path("c.png"), image.view());
  const std::string file = slurp(folder.path("c.png"));
  expect_refused(Errc::unsupported, "(7, 0)",
                 [&] { (void)io::decode_heights(bytes_of(file), "png", "in.put"); });
}

// --- USGS DEM

HeightGrid read_dem(const std::string& file) {
  return io::decode_heights(bytes_of(file), "dem", "in.put");
}

TEST(HeightDem, ProfilesOfDifferingStartsDatumScaleAndVoids) {
  for (const std::string line_end : {"", "\n", "\r\n"}) {
    const HeightGrid g = read_dem(dem(
        {{1000, 5030, 0, {10, 20}}, {1030, 5000, 100, {1, 2, 3, 4}}, {1060, 5060, 0, {-32767, 8}}},
        "2", line_end));
    ASSERT_EQ(g.heights.width(), 3);
    ASSERT_EQ(g.heights.height(), 4);
    const float v = NAN;
    const float expected[12] = {v,  102,    4,  //
                                10, 101.5F, v,  //
                                5,  101,    v,  //
                                v,  100.5F, v};
    for (std::size_t i = 0; i < 12; ++i) {
      const float got = g.heights.pixels()[i];
      EXPECT_TRUE(got == expected[i] || (std::isnan(got) && std::isnan(expected[i])))
          << i << ": " << got;
    }
    EXPECT_EQ(g.units_per_cell, 30);
  }
  EXPECT_NEAR(read_dem(dem({{0, 0, 0, {1}}}, "1")).units_per_cell, 30 / 0.3048, 1e-9);
}

TEST(HeightDem, LongProfilesGoOverBlocks) {
  std::vector<int> elevations(700);
  for (std::size_t i = 0; i < elevations.size(); ++i) elevations[i] = static_cast<int>(2 * i);
  const HeightGrid g = read_dem(dem({{0, 0, 0, elevations}, {30, 0, 0, {5}}}));
  ASSERT_EQ(g.heights.height(), 700);
  for (int i = 0; i < 700; ++i) EXPECT_EQ(g.heights(0, 699 - i), static_cast<float>(i));
  EXPECT_EQ(g.heights(1, 699), 2.5F);
}

TEST(HeightDem, RefusesWhatIsDamaged) {
  const std::string good = dem({{0, 0, 0, {1, 2}}, {30, 0, 0, {3, 4}}});
  ASSERT_NO_THROW((void)read_dem(good));
  // The last block is blank after its elevations, so cutting there loses nothing.
  for (std::size_t n = 0; n<2048 + 144 + 12; n += n> 1000 && n < 1100 ? 1 : 13)
    expect_refused(Errc::bad_format, n < 1024 ? "first record" : "record ",
                   [&] { (void)read_dem(good.substr(0, n)); });
  const auto with = [&](std::size_t at, const std::string& text, std::size_t width,
                        const std::string& part) {
    SCOPED_TRACE(part);
    std::string bad = good;
    put(bad, at, text, width);
    expect_refused(Errc::bad_format, part, [&] { (void)read_dem(bad); });
  };
  with(534, "3", 6, "record 1, byte 535: the unit of elevation");
  with(828, "0.0", 12, "record 1, byte 829: the resolution along y");
  with(828, "-3.0", 12, "byte 829");
  with(828, "nan", 12, "byte 829");
  with(858, "99999", 6, "byte 859");
  with(858, "3", 6, "record 4, byte 13: the file ends before");
  with(1024 + 12, "0", 6, "record 2, byte 13");
  with(1024 + 12, "", 6, "is missing");
  with(1024 + 12, "9999", 6, "the file ends before");
  with(1024 + 48, "1.0D+30", 24, "farther apart");
  std::string strewn = good;
  put(strewn, 1024 + 24, "900000.0D+00", 24);
  put(strewn, 1024 + 48, "900000.0D+00", 24);
  expect_refused(Errc::bad_format, "do not fill", [&] { (void)read_dem(strewn); });
  with(1024 + 144, "1x", 6, "record 2, byte 145: an elevation is no whole number: '1x'");
}

TEST(HeightDem, TheRealMap) {
  const auto file = shared_dir() / "data" / "terrain" / "SainteHelens.dem";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const HeightGrid g = io::read_heights(file);
  EXPECT_EQ(g.heights.width(), 327);  // as in its A record
  EXPECT_NEAR(g.units_per_cell, 30, 1e-12);
  EXPECT_TRUE(g.scale_known);
  float least = INFINITY, most = -INFINITY;
  for (const float h : g.heights.pixels()) {
    if (std::isnan(h)) continue;
    least = std::min(least, h);
    most = std::max(most, h);
  }
  EXPECT_EQ(least, 682.0F);  // as in its A record
  EXPECT_EQ(most, 2543.0F);
}

// --- The door

#ifdef RASTRUM_HAS_GDAL
struct TiffWith {
  bool south_up = false;
  std::string metadata{};  ///< GDAL's items
};

/// An uncompressed float32 TIFF with a cell size and a value for "no data".
std::string tiff(const std::vector<float>& heights, std::uint32_t width, std::uint32_t height,
                 const TiffWith& with = {}) {
  const std::string no_data("-9999", 6);
  const std::string scale = raw(10.0) + raw(10.0) + raw(0.0);
  const std::string tie = std::string(24, '\0') + raw(500.0) + raw(900.0) + raw(0.0);
  std::string matrix;  // y grows with the rows
  for (const double m : {10., 0., 0., 500., 0., 10., 0., 900., 0., 0., 0., 0., 0., 0., 0., 1.})
    matrix += raw(m);
  const std::string metadata = with.metadata.empty()
                                   ? std::string{}
                                   : "<GDALMetadata>" + with.metadata + "</GDALMetadata>" + '\0';
  const auto entry_count =
      static_cast<std::uint16_t>(12 - (with.south_up ? 1 : 0) + (metadata.empty() ? 0 : 1));
  const std::uint32_t first_data = 8 + 2 + 12U * entry_count + 4;
  const std::size_t place_bytes = with.south_up ? matrix.size() : scale.size() + tie.size();
  std::string entries, data;
  const auto entry = [&](int tag, int type, std::size_t count, const std::string& value) {
    entries += raw(static_cast<std::uint16_t>(tag));
    entries += raw(static_cast<std::uint16_t>(type));
    entries += raw(static_cast<std::uint32_t>(count));
    if (value.size() <= 4) {
      entries += value + std::string(4 - value.size(), '\0');
    } else {
      entries += raw(first_data + static_cast<std::uint32_t>(data.size()));
      data += value;
    }
  };
  const auto number = [&](int tag, std::size_t value) {
    entry(tag, 4, 1, raw(static_cast<std::uint32_t>(value)));
  };
  std::string pixels;
  for (const float h : heights) pixels += raw(h);
  number(256, width);
  number(257, height);
  number(258, 32);
  number(259, 1);
  number(262, 1);
  number(273, first_data + place_bytes + metadata.size() + no_data.size());
  number(277, 1);
  number(279, pixels.size());
  number(339, 3);
  if (with.south_up) {
    entry(34264, 12, 16, matrix);
  } else {
    entry(33550, 12, 3, scale);
    entry(33922, 12, 6, tie);
  }
  if (!metadata.empty()) entry(42112, 2, metadata.size(), metadata);
  entry(42113, 2, 6, no_data);
  return std::string("II*\0\x08\0\0\0", 8) + raw(entry_count) + entries + std::string(4, '\0') +
         data + pixels;
}

TEST(HeightGdal, ReadsGeoTiff) {
  const TempFolder folder;
  const std::string file = tiff({1, 2, -9999, 4.5F, -3, 1e6F}, 3, 2);
  const HeightGrid g = io::read_heights(folder.write("g.tif", file));
  ASSERT_EQ(g.heights.width(), 3);
  ASSERT_EQ(g.heights.height(), 2);
  EXPECT_EQ(g.heights(0, 0), 1);
  EXPECT_TRUE(std::isnan(g.heights(2, 0)));
  EXPECT_EQ(g.heights(0, 1), 4.5F);
  EXPECT_EQ(g.heights(2, 1), 1e6F);
  EXPECT_EQ(g.units_per_cell, 10);
  EXPECT_TRUE(g.scale_known);
  for (const std::size_t n : {3U, 20U, 100U, 200U}) {
    const auto cut = folder.write("cut.tif", file.substr(0, n));
    test::expect_refused("cut.tif", Errc::bad_format, [&] { (void)io::read_heights(cut); });
  }
}

TEST(HeightGdal, TurnsMapsWhoseFirstRowIsTheSouthernmost) {
  const TempFolder folder;
  const HeightGrid g =
      io::read_heights(folder.write("g.tif", tiff({1, 2, 3, 4, 5, 6}, 2, 3, {.south_up = true})));
  EXPECT_EQ(g.heights(0, 0), 5);
  EXPECT_EQ(g.heights(1, 0), 6);
  EXPECT_EQ(g.heights(0, 1), 3);
  EXPECT_EQ(g.heights(1, 2), 2);
  EXPECT_EQ(g.units_per_cell, 10);
}

TEST(HeightGdal, TakesScaleAndOffsetOfTheBand) {
  const TempFolder folder;
  const HeightGrid g = io::read_heights(folder.write(
      "g.tif", tiff({1, -9999, 3, -4}, 2, 2,
                    {.metadata = R"(<Item name="OFFSET" sample="0" role="offset">100</Item>)"
                                 R"(<Item name="SCALE" sample="0" role="scale">0.5</Item>)"})));
  EXPECT_EQ(g.heights(0, 0), 100.5F);
  EXPECT_TRUE(std::isnan(g.heights(1, 0)));
  EXPECT_EQ(g.heights(0, 1), 101.5F);
  EXPECT_EQ(g.heights(1, 1), 98);
}
#endif

TEST(ReadHeights, KnowsWhatEndsAtItsEdge) {
  for (const char* name : {"a.dem", "A.DEM", "b.tif", "b.Tiff"})
    EXPECT_TRUE(io::ends_at_edge(name)) << name;
  for (const char* name : {"a.png", "a.raw", "a.npy", "dem"})
    EXPECT_FALSE(io::ends_at_edge(name)) << name;
}

TEST(ReadHeights, NamesWhatItDoesNotRead) {
  const TempFolder folder;
  const auto refused = [](const char* part, const std::filesystem::path& file, Errc code) {
    test::expect_refused(part, code, [&] { (void)io::read_heights(file); });
  };
  refused("gone.png", folder.path("gone.png"), Errc::not_found);
  refused("no kind of height map", folder.write("a.txt", "1 2"), Errc::unsupported);
#ifdef RASTRUM_HAS_GDAL
  refused("gone.tif", folder.path("gone.tif"), Errc::not_found);
  refused("not a valid GeoTIFF", folder.write("bad.tif", "II*"), Errc::bad_format);
#else
  refused("gone.tif", folder.path("gone.tif"), Errc::unsupported);
  refused("libgdal-dev", folder.write("bad.tif", "II*"), Errc::unsupported);
#endif
}

}  // namespace
}  // namespace rastrum::test::height_test
