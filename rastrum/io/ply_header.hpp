// SPDX-License-Identifier: BSD-3-Clause
// The header of a PLY file: elements and their properties.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/io/parse.hpp>

namespace rastrum::io::ply {

enum class Type : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };
enum class Format : std::uint8_t { ascii, little_endian, big_endian };

[[nodiscard]] constexpr std::size_t size_of(Type t) {
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(t)];
}
[[nodiscard]] constexpr bool is_integer(Type t) {
  return t < Type::f32;
}

struct Property {
  std::string name;
  Type type = Type::f32;
  bool is_list = false;
  Type count_type = Type::u8;  ///< of a list
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;

  /// Bytes in a binary file if every list is empty.
  [[nodiscard]] std::size_t least_bytes() const;
  [[nodiscard]] bool has_list() const;
  /// The property of one of these names, or −1.
  [[nodiscard]] int find(std::initializer_list<std::string_view> names) const;
  /// Likewise, but no list.
  [[nodiscard]] int find_number(std::initializer_list<std::string_view> names) const;
};

/// Full intensity of an element's colours; 0: the colours decide.
struct ColorUnits {
  float rgb = 0, alpha = 0;
};

struct Header {
  Format format = Format::ascii;
  std::vector<Element> elements;
  std::size_t size = 0;                    ///< bytes up to the first element
  std::vector<std::string> texture_files;  ///< `comment TextureFile NAME`
  /// `comment colour_units ELEMENT RGB ALPHA` in a selection's file: the units of the large file.
  ColorUnits vertex_units, face_units;
  /// `comment position_type float|double`, likewise: the type that float64 positions become.
  std::optional<bool> wide_positions;
};

/// The properties of an attribute of N numbers: all of them, or none.
template <std::size_t N>
struct Places {
  std::array<int, N> number{};
  [[nodiscard]] bool any() const {
    return std::ranges::all_of(number, [](int k) { return k >= 0; });
  }
};
[[nodiscard]] Places<3> find_positions(const Element& e);
[[nodiscard]] Places<3> find_normals(const Element& e);
[[nodiscard]] Places<2> find_texcoords(const Element& e);

/// Red, green, blue and alpha properties, or −1. Without the first three there is no colour.
struct ColorPlaces {
  int channel[4] = {-1, -1, -1, -1};
  [[nodiscard]] bool any() const { return channel[0] >= 0; }
};
[[nodiscard]] ColorPlaces find_colors(const Element& e);

/// Throws Error{bad_format | unsupported} naming the line.
[[nodiscard]] Header parse_header(Bytes bytes, const std::string& name);

}  // namespace rastrum::io::ply
