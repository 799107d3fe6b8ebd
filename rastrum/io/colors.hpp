// SPDX-License-Identifier: BSD-3-Clause
// Colours of mesh files: numbers in some unit, per vertex or face.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <rastrum/io/reading.hpp>
#include <rastrum/mesh.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::io {

/// The plain shaders' colour, for what has none where others have one.
inline constexpr Vec4 kPlainColor{0.8F, 0.7F, 0.6F, 1};

/// The largest channels of a file's vertex or face colours, which decide their unit.
struct LargestChannels {
  float rgb = 0, alpha = 0;
  void add(const Vec4& c) {
    for (const float x : {c.x, c.y, c.z})
      if (std::isfinite(x)) rgb = std::max(rgb, x);
    if (std::isfinite(c.w)) alpha = std::max(alpha, c.w);
  }
  void add(std::span<const Vec4> colors) {
    for (const Vec4& c : colors) add(c);
  }
};

/// The number for full intensity, given the largest of all. Integers: the least of 255, 65,535 and
/// `most`, the largest of their type, that is not below it. Floats (`most` 1): 1 if it is below 2,
/// so that colours a little brighter than white stay; else 255 or 65,535.
[[nodiscard]] inline float color_unit(float largest, double most) {
  if (most == 1 && largest < 2) return 1;
  for (const float unit : {255.0F, 65535.0F})
    if (largest <= unit && (most == 1 || double{unit} < most)) return unit;
  return static_cast<float>(most);
}

/// A warning for a unit that the type does not suggest.
[[nodiscard]] inline std::string said_unit(float largest, float unit,
                                           const std::string& whose = "its colours") {
  const auto text = [](float x) { return std::to_string(static_cast<std::int64_t>(x)); };
  return whose + " go up to " + text(largest) + ": taken as parts of " + text(unit);
}

inline void scale_colors(std::span<Vec4> colors, float rgb_unit, float alpha_unit) {
  const float rgb = 1 / rgb_unit, alpha = 1 / alpha_unit;
  if (rgb == 1 && alpha == 1) return;
  for (Vec4& c : colors) c = {c.x * rgb, c.y * rgb, c.z * rgb, c.w * alpha};
}

/// Colours of faces, for all corners. Equal colours are stored once.
class FaceColors {
 public:
  explicit FaceColors(Budget& budget) : budget_(budget) {}
  /// Gives `color` to the triangles without an entry, up to `triangles`.
  void add(const Vec4& color, std::size_t triangles) {
    if (triangles > numbers_.size()) budget_.resize(numbers_, triangles, number(color));
  }
  /// Likewise, without a colour.
  void add_none(std::size_t triangles) {
    if (triangles > numbers_.size()) budget_.resize(numbers_, triangles, kNone);
  }
  [[nodiscard]] std::vector<Vec4>& values() { return values_; }
  /// Empty if no triangle has a colour, unless `others_have`: triangles of another part of the
  /// file.
  [[nodiscard]] Attribute<Vec4> take(bool others_have = false) {
    Attribute<Vec4> colors;
    if (values_.empty() && !others_have) return colors;
    const auto plain = static_cast<std::uint32_t>(values_.size());
    budget_.reserve(colors.indices, 3 * numbers_.size());
    for (const std::uint32_t n : numbers_)
      colors.indices.insert(colors.indices.end(), 3, n == kNone ? plain : n);
    colors.values = std::move(values_);
    budget_.add(colors.values, kPlainColor);
    return colors;
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  std::uint32_t number(const Vec4& color) {
    using Bits = std::array<std::uint32_t, 4>;
    const Bits bits = std::bit_cast<Bits>(color);
    if (!values_.empty() && std::bit_cast<Bits>(values_.back()) == bits)
      return static_cast<std::uint32_t>(values_.size()) - 1;
    std::uint64_t key = 0;
    for (const std::uint32_t b : bits) key = (key ^ b) * 0x9E3779B97F4A7C15ULL;
    const auto next = static_cast<std::uint32_t>(values_.size());
    // With more colours than this, most differ, and looking them up saves little.
    constexpr std::size_t kMost = 1 << 16;
    if (const auto known = known_.find(key);
        known != known_.end() && std::bit_cast<Bits>(values_[known->second]) == bits)
      return known->second;
    if (known_.size() < kMost) known_.emplace(key, next);
    budget_.add(values_, color);
    return next;
  }

  Budget& budget_;
  std::vector<Vec4> values_;
  std::vector<std::uint32_t> numbers_;  ///< the colour of each triangle
  std::unordered_map<std::uint64_t, std::uint32_t> known_;
};

}  // namespace rastrum::io
