// SPDX-License-Identifier: BSD-3-Clause
// The values of a PLY file's elements in order, from text or binary.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include <rastrum/io/colors.hpp>
#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/io/ply_header.hpp>
#include <rastrum/io/text_cursor.hpp>

namespace rastrum::io::ply {

/// Calls f with a value of the C++ type of `type`.
template <class F>
auto with_type(Type type, F&& f) {
  switch (type) {
    case Type::i8:
      return f(std::int8_t{});
    case Type::u8:
      return f(std::uint8_t{});
    case Type::i16:
      return f(std::int16_t{});
    case Type::u16:
      return f(std::uint16_t{});
    case Type::i32:
      return f(std::int32_t{});
    case Type::u32:
      return f(std::uint32_t{});
    case Type::f32:
      return f(float{});
    case Type::f64:
      break;
  }
  return f(double{});
}

[[nodiscard]] inline double number_at(const std::byte* p, Type type, bool swap = false) {
  return with_type(type, [&](auto v) { return static_cast<double>(load<decltype(v)>(p, swap)); });
}

/// Full intensity of a colour channel: the largest number of the type, 1 for floats.
[[nodiscard]] inline double largest_channel(Type type) {
  if (!is_integer(type)) return 1;
  return with_type(
      type, [](auto v) { return static_cast<double>(std::numeric_limits<decltype(v)>::max()); });
}

/// The largest numbers of the types of red and of alpha; 0: there is none.
struct ColorTypes {
  double rgb = 0, alpha = 0;
};
[[nodiscard]] inline ColorTypes color_types(const Element& e, const ColorPlaces& places) {
  const auto largest = [&](int k) {
    return k < 0 ? 0 : largest_channel(e.properties[static_cast<std::size_t>(k)].type);
  };
  return {largest(places.channel[0]), largest(places.channel[3])};
}
[[nodiscard]] inline ColorUnits units_of(const LargestChannels& largest, const ColorTypes& types) {
  return {color_unit(largest.rgb, types.rgb),
          types.alpha == 0 ? 1 : color_unit(largest.alpha, types.alpha)};
}
/// Whether units follow from the largest of all colours (color_unit); not for 8 bits.
[[nodiscard]] inline bool depend_on_largest(const ColorTypes& types) {
  const auto is_open = [](double most) { return most == 1 || most > 255; };
  return is_open(types.rgb) || is_open(types.alpha);
}

/// Calls fail(why), which throws, if `left` bytes are too few for an element. In text a value takes
/// at least a character and a separator.
template <class Fail>
void check_room(const Element& e, std::size_t left, bool ascii, const Fail& fail) {
  if (e.properties.empty() || e.count == 0) return;
  const std::size_t most = ascii ? (left + 1) / 2 : left;
  const std::size_t each = ascii ? e.properties.size() : e.least_bytes();
  if (e.count > most / each)
    fail("the header says " + std::to_string(e.count) + " of '" + e.name +
         "', but the file is too short for them (" + std::to_string(left) + " bytes are left)");
}

class Source {
 public:
  /// Borrows its arguments.
  Source(Bytes bytes, const Header& header, const std::string& name)
      : bytes_(bytes),
        name_(name),
        ascii_(header.format == Format::ascii),
        swap_((header.format == Format::big_endian) == kLittleEndian),
        at_(header.size),
        text_(as_text(bytes), name) {
    text_.advance(header.size);
  }

  [[nodiscard]] bool ascii() const { return ascii_; }
  /// Whether the file's byte order is not this machine's.
  [[nodiscard]] bool swap() const { return swap_; }
  [[nodiscard]] std::size_t left() const { return ascii_ ? text_.left() : bytes_.size() - at_; }

  [[noreturn]] void fail(const std::string& message) const {
    throw Error(Errc::bad_format, name_ + ": " + message);
  }
  void check_room(const Element& e) const {
    rastrum::io::ply::check_room(e, left(), ascii_, [&](const std::string& why) { fail(why); });
  }

  [[nodiscard]] const std::byte* take(std::size_t n, const Element& e) {
    if (n > bytes_.size() - at_) fail("the file ends inside of '" + e.name + "'");
    const std::byte* p = bytes_.data() + at_;
    at_ += n;
    return p;
  }
  [[nodiscard]] Bytes rest() const { return bytes_.subspan(at_); }

  [[nodiscard]] float word(const Property& p) { return text_.word<float>(p.name.c_str(), true); }
  [[nodiscard]] double number(const Property& p, const Element& e) {
    if (ascii_) return text_.word<double>(p.name.c_str(), true);
    return number_at(take(size_of(p.type), e), p.type, swap_);
  }
  /// `T`: int64 for a list of integers, or double.
  template <class T>
  void list(const Property& p, const Element& e, std::vector<T>& values) {
    const std::size_t n = list_count(p, e);
    values.clear();
    if (ascii_) {
      for (std::size_t i = 0; i < n; ++i)
        values.push_back(text_.word<T>(("a value of " + p.name).c_str(), true));
      return;
    }
    const std::byte* at = take(n * size_of(p.type), e);
    values.resize(n);
    with_type(p.type, [&](auto v) {
      using V = decltype(v);
      if constexpr (std::is_integral_v<V> || !std::is_integral_v<T>)
        for (std::size_t i = 0; i < n; ++i)
          values[i] = static_cast<T>(load<V>(at + i * sizeof(V), swap_));
    });
  }
  void skip(const Property& p, const Element& e) {
    const std::size_t n = p.is_list ? list_count(p, e) : 1;
    if (!ascii_) {
      (void)take(n * size_of(p.type), e);
      return;
    }
    for (std::size_t i = 0; i < n; ++i)
      if (text_.token().empty()) text_.fail("the file ends too early");
  }
  void skip(const Element& e) {
    if (e.properties.empty()) return;
    if (!ascii_ && !e.has_list()) {
      (void)take(e.least_bytes() * e.count, e);
      return;
    }
    for (std::size_t i = 0; i < e.count; ++i)
      for (const Property& p : e.properties) skip(p, e);
  }

 private:
  /// take() checks it.
  std::size_t list_count(const Property& p, const Element& e) {
    if (ascii_) return text_.word<std::uint32_t>(("the count of " + p.name).c_str(), true);
    const double n = number_at(take(size_of(p.count_type), e), p.count_type, swap_);
    if (n < 0)
      fail("a list of '" + e.name + "' has the count " +
           std::to_string(static_cast<std::int64_t>(n)));
    return static_cast<std::size_t>(n);
  }

  Bytes bytes_;
  const std::string& name_;
  bool ascii_, swap_;
  std::size_t at_;   ///< of a binary file
  TextCursor text_;  ///< of text
};

}  // namespace rastrum::io::ply
