// SPDX-License-Identifier: BSD-3-Clause
#include "picture_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string_view>

namespace rastrum::cli::window {

std::string number(double v) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, v).ptr};
}
std::string numbers(const Vec3d& v) {
  return number(v.x) + "," + number(v.y) + "," + number(v.z);
}
double degrees(float rad) {
  return static_cast<double>(rad) / (std::numbers::pi / 180);
}

std::string quoted(const std::string& text) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_./,:=@%+-").find(c) != std::string_view::npos;
  };
  if (!text.empty() && std::ranges::all_of(text, is_plain)) return text;
  std::string all = "'";
  for (const char c : text) all += c == '\'' ? "'\\''" : std::string(1, c);
  return all + "'";
}

std::string hex(Vec4 c) {
  const auto byte = [](float v) {
    return static_cast<unsigned>(std::lround(std::clamp(v, 0.0F, 1.0F) * 255));
  };
  char text[16];
  std::snprintf(text, sizeof text, "#%02x%02x%02x%02x", byte(c.x), byte(c.y), byte(c.z), byte(c.w));
  return text;
}

std::string literal(const std::string& text) {
  std::string all = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') all += '\\';
    all += c == '\n' ? std::string("\\n") : std::string(1, c);
  }
  return all + "\"";
}
std::string tuple(const Vec3d& v) {
  return in_brackets({number(v.x), number(v.y), number(v.z)});
}

std::string in_brackets(const std::vector<std::string>& items) {
  return std::string("(").append(joined(items)).append(")");
}
std::string listed(const std::vector<std::string>& items) {
  return std::string("[").append(joined(items)).append("]");
}
std::string listed(const std::vector<double>& values) {
  std::vector<std::string> items;
  for (const double v : values) items.push_back(number(v));
  return listed(items);
}

}  // namespace rastrum::cli::window
