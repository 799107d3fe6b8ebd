// SPDX-License-Identifier: BSD-3-Clause
#include "arguments.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include <rastrum/color.hpp>
#include <rastrum/core/nearest_word.hpp>
#include <rastrum/image.hpp>

namespace rastrum::cli {
namespace {

template <class T>
bool convert(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

[[noreturn]] void refuse(std::string_view option, std::string_view text,
                         const std::string& wanted) {
  throw UsageError(option, "expected " + wanted + ", got '" + std::string(text) + "'");
}

template <std::size_t N>
void parse_list(std::string_view option, std::string_view text, double (&values)[N],
                const char* wanted) {
  const std::vector<std::string> parts = parts_of(text, ",");
  for (std::size_t i = 0; i < N; ++i)
    if (parts.size() != N || !convert(parts[i], values[i]) || !std::isfinite(values[i]))
      refuse(option, text, wanted);
}

}  // namespace

std::vector<std::string> parts_of(std::string_view text, std::string_view separators) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
    parts.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  return text;
}

double parse_number(std::string_view option, std::string_view text) {
  double value = 0;
  if (!convert(text, value) || !std::isfinite(value)) refuse(option, text, "a number");
  return value;
}

double parse_number_that(std::string_view option, std::string_view text, bool (*is_right)(double),
                         const char* wanted) {
  const double value = parse_number(option, text);
  if (!is_right(value))
    throw UsageError(option, std::string(wanted) + ", got '" + std::string(text) + "'");
  return value;
}

int parse_integer(std::string_view option, std::string_view text, int min, int max) {
  int value = 0;
  if (!convert(text, value) || value < min || value > max)
    refuse(option, text,
           "a whole number from " + std::to_string(min) + " to " + std::to_string(max));
  return value;
}

std::uint64_t parse_bytes(std::string_view option, std::string_view text) {
  std::uint64_t value = 0;
  const std::size_t unit = text.empty() ? 0 : std::string_view("KMG").find(text.back());
  const bool has_unit = !text.empty() && unit != std::string_view::npos;
  const int shift = has_unit ? 10 * (static_cast<int>(unit) + 1) : 0;
  if (!convert(text.substr(0, text.size() - (has_unit ? 1 : 0)), value) || value == 0 ||
      value > (~std::uint64_t{0} >> shift))
    refuse(option, text, "a number of bytes such as 1500000, 64K, 16M or 2G");
  return value << shift;
}

Vec3d parse_vec3(std::string_view option, std::string_view text) {
  double v[3];
  parse_list(option, text, v, "three numbers X,Y,Z");
  return {v[0], v[1], v[2]};
}

ClipPlane parse_clip_plane(std::string_view option, std::string_view text) {
  double v[4];
  parse_list(option, text, v, "four numbers X,Y,Z,D");
  if (v[0] == 0 && v[1] == 0 && v[2] == 0) throw UsageError(option, "the normal must not be 0");
  return {{v[0], v[1], v[2]}, v[3]};
}

Size parse_size(std::string_view option, std::string_view text) {
  Size size;
  const std::size_t x = text.find('x');
  if (x == std::string_view::npos || !convert(text.substr(0, x), size.width) ||
      !convert(text.substr(x + 1), size.height) || size.width < 1 || size.height < 1 ||
      size.width > kMaxImageSize || size.height > kMaxImageSize)
    refuse(option, text, "WIDTHxHEIGHT from 1x1 to 32768x32768");
  return size;
}

Vec4 parse_color(std::string_view option, std::string_view text) {
  const std::optional<Rgba8> color = color_of(text);
  if (!color)
    throw UsageError(option,
                     "expected a colour such as '#ffcc00', '#ffcc0080', fc0 or gold, got '" +
                         std::string(text) + "'" + did_you_mean(text, color_names()));
  const auto value = [](std::uint8_t v) { return static_cast<float>(v) / 255.0F; };
  return {value(color->r), value(color->g), value(color->b), value(color->a)};
}

}  // namespace rastrum::cli
