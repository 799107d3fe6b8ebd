// SPDX-License-Identifier: BSD-3-Clause
// glTF documents that tests write.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tests/io/files.hpp"

namespace rastrum::test {

inline std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string r;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t b = 0;
    for (std::size_t k = 0; k < 3; ++k)
      b = b << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      r += k <= bytes.size() - i ? kDigits[b >> (18 - 6 * k) & 63U] : '=';
  }
  return r;
}

/// A document over `bytes` with one buffer and one view of it; `rest` has more members.
inline std::string document(const std::string& bytes, const std::string& rest) {
  return R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":)" + std::to_string(bytes.size()) +
         R"(,"uri":"data:application/octet-stream;base64,)" + base64(bytes) + R"("}],)" +
         R"("bufferViews":[{"buffer":0,"byteLength":)" + std::to_string(bytes.size()) + "}]," +
         rest + "}";
}

/// A binary container of this JSON and these bytes.
inline std::string glb(std::string json, const std::string& bytes) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto u32 = [](std::size_t v) { return raw(static_cast<std::uint32_t>(v)); };
  return "glTF" + u32(2) + u32(28 + json.size() + bytes.size()) + u32(json.size()) + "JSON" + json +
         u32(bytes.size()) + std::string("BIN\0", 4) + bytes;
}

/// The same document with whole numbers written as 24.0 and 24e0 in turn, since JSON has no
/// integers.
inline std::string with_points(const std::string& text) {
  std::string r;
  bool in_string = false, by_exponent = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    r += c;
    if (c == '"') in_string = !in_string;
    const auto is_number = [&](std::size_t at) {
      return at < text.size() &&
             std::string_view("0123456789.eE+-").find(text[at]) != std::string_view::npos;
    };
    if (in_string || !is_number(i) || is_number(i + 1)) continue;
    std::size_t begin = i;
    while (begin > 0 && is_number(begin - 1)) --begin;
    if (text.substr(begin, i + 1 - begin).find_first_of(".eE") != std::string::npos) continue;
    r += by_exponent ? "e0" : ".0";
    by_exponent = !by_exponent;
  }
  return r;
}

/// Builds a document: bytes, with an accessor for each piece, then members that refer to them.
class GltfDocument {
 public:
  /// Adds an accessor over values of at most 4 bytes and returns its number. `type` is like "VEC3".
  template <class T>
  std::size_t add(const std::vector<T>& values, const std::string& type, int component_type,
                  bool normalized = false) {
    const std::size_t components = type == "SCALAR" ? 1
                                   : type == "MAT4" ? 16
                                                    : static_cast<std::size_t>(type.back() - '0');
    while (bytes_.size() % 4 != 0) bytes_ += '\0';
    accessors_ += (accessors_.empty() ? "" : ",") +
                  std::string(R"({"bufferView":0,"byteOffset":)") + std::to_string(bytes_.size()) +
                  R"(,"componentType":)" + std::to_string(component_type) +
                  (normalized ? R"(,"normalized":true)" : "") + R"(,"count":)" +
                  std::to_string(values.size() / components) + R"(,"type":")" + type + "\"}";
    for (const T& v : values) bytes_ += raw(v);
    return count_++;
  }
  std::size_t floats(const std::vector<float>& values, const std::string& type) {
    return add(values, type, 5126);
  }
  /// `rest`: the members besides buffers, views and accessors.
  [[nodiscard]] std::string text(const std::string& rest) const {
    return document(bytes_, "\"accessors\":[" + accessors_ + "]," + rest);
  }

 private:
  std::string bytes_, accessors_;
  std::size_t count_ = 0;
};

}  // namespace rastrum::test
