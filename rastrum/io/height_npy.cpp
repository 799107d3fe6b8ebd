// SPDX-License-Identifier: BSD-3-Clause
// Heights of a two-dimensional NPY file, of any type and order.
#include <string_view>
#include <type_traits>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/npy_header.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/io/text_cursor.hpp>
#include <rastrum/io/wide_positions.hpp>

namespace rastrum::io {
namespace {

template <class T>
HeightGrid heights_of(const NpyHeader& header, std::span<const std::byte> bytes,
                      const std::string& name) {
  const std::size_t rows = header.shape[0], columns = header.shape[1], count = rows * columns;
  if (const std::size_t there = (bytes.size() - header.data) / sizeof(T); count > there)
    throw Error(Errc::bad_format, name + ": is not a valid NPY file: it ends after " +
                                      std::to_string(there) + " of " + std::to_string(count) +
                                      " heights");
  const bool swap = header.type[0] == (kLittleEndian ? '>' : '<');
  HeightGrid grid{Image<float>(static_cast<int>(columns), static_cast<int>(rows)), 1,
                  sizeof(T) == 1};
  const std::byte* at = bytes.data() + header.data;
  for (std::size_t i = 0; i < count; ++i, at += sizeof(T)) {
    const std::size_t to = header.fortran ? i % rows * columns + i / rows : i;
    const T value = load<T>(at, swap);
    if constexpr (std::is_same_v<T, double>)
      grid.heights.pixels()[to] = float32_of(value);
    else
      grid.heights.pixels()[to] = static_cast<float>(value);
  }
  return grid;
}

}  // namespace

HeightGrid decode_height_npy(std::span<const std::byte> bytes, const std::string& name) {
  const FloatScope floats;
  const NpyHeader header = parse_npy_header(bytes, name);
  const auto refuse = [&](const std::string& what) {
    throw Error(Errc::unsupported, name + ": " + what);
  };
  if (header.shape.size() != 2)
    refuse("has " + std::to_string(header.shape.size()) +
           " dimensions, but a height map has 2 (rows, columns)");
  const std::size_t rows = header.shape[0], columns = header.shape[1];
  const auto most = static_cast<std::size_t>(kMaxImageSize);
  if (rows < 1 || columns < 1 || rows > most || columns > most)
    refuse("its size " + std::to_string(columns) + "x" + std::to_string(rows) +
           " is outside 1x1 to 32768x32768");
  const std::string_view kind = std::string_view(header.type).substr(1);
  if (kind == "f4") return heights_of<float>(header, bytes, name);
  if (kind == "f8") return heights_of<double>(header, bytes, name);
  if (kind == "i1") return heights_of<std::int8_t>(header, bytes, name);
  if (kind == "u1") return heights_of<std::uint8_t>(header, bytes, name);
  if (kind == "i2") return heights_of<std::int16_t>(header, bytes, name);
  if (kind == "u2") return heights_of<std::uint16_t>(header, bytes, name);
  if (kind == "i4") return heights_of<std::int32_t>(header, bytes, name);
  if (kind == "u4") return heights_of<std::uint32_t>(header, bytes, name);
  throw Error(Errc::unsupported,
              name + ": heights of type " + quoted(std::string_view(header.type)) +
                  " are not read (float32, float64, int or uint of 8, 16 or 32 bits are)");
}

}  // namespace rastrum::io
