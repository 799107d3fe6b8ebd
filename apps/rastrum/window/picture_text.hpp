// SPDX-License-Identifier: BSD-3-Clause
// Values as texts that give back the same bits, for a shell and for Python.
#pragma once

#include <string>
#include <vector>

#include <rastrum/vec.hpp>

#include "parse/arguments.hpp"

namespace rastrum::cli::window {

/// The shortest text of the same number.
[[nodiscard]] std::string number(double v);
/// X,Y,Z
[[nodiscard]] std::string numbers(const Vec3d& v);
/// Degrees from which options and Python make the same float32 of radians.
[[nodiscard]] double degrees(float rad);
/// #rrggbbaa of a display value.
[[nodiscard]] std::string hex(Vec4 c);

/// As one word of a shell.
[[nodiscard]] std::string quoted(const std::string& text);
/// A command line, word by word.
class Words {
 public:
  Words& operator()(const std::string& option) {
    all_ += (all_.empty() ? "" : " ") + option;
    return *this;
  }
  Words& operator()(const std::string& option, const std::string& text) {
    return (*this)(option)(quoted(text));
  }
  [[nodiscard]] std::string take() { return std::move(all_); }

 private:
  std::string all_;
};

// For Python.
[[nodiscard]] std::string literal(const std::string& text);
[[nodiscard]] std::string tuple(const Vec3d& v);
[[nodiscard]] std::string in_brackets(const std::vector<std::string>& items);
[[nodiscard]] std::string listed(const std::vector<std::string>& items);
[[nodiscard]] std::string listed(const std::vector<double>& values);
/// name(value, key=value, …)
class Call {
 public:
  explicit Call(std::string name) : name_(std::move(name)) {}
  Call& operator()(const std::string& value) {
    said_.push_back(value);
    return *this;
  }
  Call& operator()(const char* key, const std::string& value) {
    return (*this)(std::string(key).append("=").append(value));
  }
  [[nodiscard]] std::string text() const { return name_ + in_brackets(said_); }

 private:
  std::string name_;
  std::vector<std::string> said_;
};

}  // namespace rastrum::cli::window
