// SPDX-License-Identifier: BSD-3-Clause
// Whether a file's positions are kept in float64 (docs/read_files.md, "Positions of files").
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include <rastrum/core/vectors.hpp>
#include <rastrum/io/reading.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::io {

/// Rounds to float32. Numbers beyond its range become infinite; C++ leaves that undefined.
[[nodiscard]] inline float float32_of(double value) {
  constexpr double kMost = std::numeric_limits<float>::max();
  if (value > kMost) return std::numeric_limits<float>::infinity();
  if (value < -kMost) return -std::numeric_limits<float>::infinity();
  return static_cast<float>(value);
}
[[nodiscard]] inline Vec3 float32_of(Vec3d p) {
  return {float32_of(p.x), float32_of(p.y), float32_of(p.z)};
}

/// The box of the finite positions, rounded to float32.
class PlaceBox {
 public:
  void add(Vec3 p) {
    if (is_finite(p)) box_.add(p);
  }
  /// Whether on every axis part of it lies within 16 times its longest side of 0. Then float32
  /// moves its vertices by at most about the 1/256 px of snapping, in a picture of it 4,096 px
  /// wide. Adding positions keeps it near.
  [[nodiscard]] bool is_near() const {
    if (box_.empty()) return false;
    const Vec3d low(box_.min), high(box_.max), size = high - low;
    const double away = std::max({0.0, low.x, low.y, low.z, -high.x, -high.y, -high.z});
    return away <= 16 * std::max({size.x, size.y, size.z});
  }
  /// Whether float32 would move its vertices more. A box of one place counts as near.
  [[nodiscard]] bool is_far() const { return !is_near() && !box_.empty() && box_.min != box_.max; }

 private:
  Box3 box_;
};

/// Whether the positions lie far from 0. The first few mostly decide.
[[nodiscard]] inline bool lie_far(std::span<const Vec3> positions) {
  PlaceBox box;
  for (const Vec3& p : positions) {
    box.add(p);
    if (box.is_near()) return false;
  }
  return box.is_far();
}

/// Sets the positions of a mesh, points or lines; float64 ones in both forms.
template <class G>
void set_positions(G& geometry, std::vector<Vec3> positions, Budget& /*budget*/) {
  geometry.positions = std::move(positions);
}
template <class G>
void set_positions(G& geometry, std::vector<Vec3d> wide, Budget& budget) {
  budget.resize(geometry.positions, wide.size());
  std::ranges::transform(wide, geometry.positions.begin(), [](Vec3d p) { return float32_of(p); });
  geometry.wide_positions = std::move(wide);
}

}  // namespace rastrum::io
