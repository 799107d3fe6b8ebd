// SPDX-License-Identifier: BSD-3-Clause
// A place in a glTF file's JSON, with checked access. Errors name the file and the place
// ("meshes[2].primitives[0].mode"). nlohmann::json parses, without recursion.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include <rastrum/error.hpp>

namespace rastrum::io::gltf {

/// Borrows the document and the file's name. A copy copies the path.
class Json {
 public:
  Json(const nlohmann::json& value, const std::string& file, std::string path = {})
      : value_(&value), file_(&file), path_(std::move(path)) {}

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] bool is_object() const { return value_->is_object(); }

  [[noreturn]] void fail(const std::string& what, Errc code = Errc::bad_format) const {
    throw Error(code, *file_ + ": " + (path_.empty() ? "the document" : path_) + ": " + what);
  }

  [[nodiscard]] std::optional<Json> get(const char* key) const {
    if (!value_->is_object()) fail("must be an object");
    const auto it = value_->find(key);
    if (it == value_->end()) return std::nullopt;
    return Json(*it, *file_, path_.empty() ? key : path_ + "." + key);
  }
  [[nodiscard]] Json operator[](const char* key) const {
    auto member = get(key);
    if (!member) fail(std::string("has no ") + key);
    return *std::move(member);
  }

  [[nodiscard]] std::size_t size() const {
    if (!value_->is_array()) fail("must be an array");
    return value_->size();
  }
  [[nodiscard]] Json at(std::size_t i) const {
    return {(*value_)[i], *file_, path_ + "[" + std::to_string(i) + "]"};
  }
  template <class F>
  void for_each(F&& f) const {
    for (std::size_t i = 0, n = size(); i < n; ++i) f(at(i));
  }
  /// For the array `key` of this object, if it has one.
  template <class F>
  void for_each(const char* key, F&& f) const {
    if (const auto array = get(key)) array->for_each(f);
  }
  /// Calls f(name, value) for the members of this object.
  template <class F>
  void for_each_member(F&& f) const {
    if (!value_->is_object()) fail("must be an object");
    for (auto it = value_->begin(); it != value_->end(); ++it)
      f(it.key(), Json(*it, *file_, path_ + "." + it.key()));
  }

  [[nodiscard]] double number() const {
    if (!value_->is_number()) fail("must be a number");
    const double x = value_->get<double>();
    if (!std::isfinite(x)) fail("must be a finite number");
    return x;
  }
  [[nodiscard]] float real() const {
    const double x = number();
    if (std::abs(x) > static_cast<double>(std::numeric_limits<float>::max()))
      fail("does not fit float32");
    return static_cast<float>(x);
  }
  /// The largest count that a double and a size both hold exactly.
  static constexpr double kMostCount = sizeof(std::size_t) < 8 ? 4294967295.0 : 9007199254740992.0;
  /// A whole number ≥ 0, which JSON may write as 1.0 or 1e0.
  [[nodiscard]] std::size_t count() const {
    const double x = number();
    if (x < 0 || x != std::floor(x) || x > kMostCount)
      fail("must be a whole number that is not negative");
    return static_cast<std::size_t>(x);
  }
  [[nodiscard]] std::size_t index(std::size_t limit) const {
    const std::size_t i = count();
    if (i >= limit) fail("is " + std::to_string(i) + ", but there are " + std::to_string(limit));
    return i;
  }
  [[nodiscard]] bool boolean() const {
    if (!value_->is_boolean()) fail("must be true or false");
    return value_->get<bool>();
  }
  [[nodiscard]] const std::string& string() const {
    if (!value_->is_string()) fail("must be a string");
    return value_->get_ref<const std::string&>();
  }

  [[nodiscard]] float real(const char* key, float otherwise) const {
    const auto member = get(key);
    return member ? member->real() : otherwise;
  }
  [[nodiscard]] std::size_t count(const char* key, std::size_t otherwise) const {
    const auto member = get(key);
    return member ? member->count() : otherwise;
  }
  [[nodiscard]] bool boolean(const char* key, bool otherwise) const {
    const auto member = get(key);
    return member ? member->boolean() : otherwise;
  }
  [[nodiscard]] std::string string(const char* key, const char* otherwise) const {
    const auto member = get(key);
    return member ? member->string() : std::string(otherwise);
  }
  /// Reads exactly N numbers, if the member exists.
  template <std::size_t N>
  bool numbers(const char* key, double (&to)[N]) const {
    const auto member = get(key);
    if (!member) return false;
    if (member->size() != N) member->fail("must have " + std::to_string(N) + " numbers");
    for (std::size_t i = 0; i < N; ++i) to[i] = member->at(i).number();
    return true;
  }
  [[nodiscard]] std::optional<Json> extension(const char* name) const {
    const auto all = get("extensions");
    return all ? all->get(name) : std::nullopt;
  }

 private:
  const nlohmann::json* value_;
  const std::string* file_;
  std::string path_;
};

/// The length of the document's array `key`; 0 without it.
[[nodiscard]] inline std::size_t length(const Json& document, const char* key) {
  const auto array = document.get(key);
  return array ? array->size() : 0;
}

}  // namespace rastrum::io::gltf
