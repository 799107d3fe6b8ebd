// SPDX-License-Identifier: BSD-3-Clause
// Boxes of vectors, and affine matrices in float64, on the host.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <rastrum/mat.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {

/// The lesser and the greater of each coordinate; among 0 and −0 that of `a`.
template <class V>
[[nodiscard]] V least(const V& a, const V& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
template <class V>
[[nodiscard]] V greatest(const V& a, const V& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

/// A box of points; empty, it goes from infinity to −infinity.
template <class V>
struct BoxOf {
  static constexpr auto kFar = std::numeric_limits<decltype(V::x)>::infinity();
  V min{kFar, kFar, kFar}, max{-kFar, -kFar, -kFar};

  void add(const BoxOf& b) {
    min = least(min, b.min);
    max = greatest(max, b.max);
  }
  void add(const V& p) { add(BoxOf{p, p}); }
  [[nodiscard]] bool empty() const { return !(min.x <= max.x); }
};
using Box3 = BoxOf<Vec3>;
using Box3d = BoxOf<Vec3d>;

/// Null if the length is 0 or not finite.
[[nodiscard]] inline std::optional<Vec3d> direction_of(const Vec3d& v) {
  const double l = length(v);
  if (!(l > 0) || !std::isfinite(l)) return std::nullopt;
  return Vec3d{v.x / l, v.y / l, v.z / l};
}

/// The first three numbers of a row.
[[nodiscard]] inline Vec3d row_of(const Mat4d& a, int i) {
  return {a.m[i][0], a.m[i][1], a.m[i][2]};
}
/// A direction and a point, mapped by an affine matrix.
[[nodiscard]] inline Vec3d turned_by(const Mat4d& a, const Vec3d& v) {
  const auto row = [&](int i) { return a.m[i][0] * v.x + a.m[i][1] * v.y + a.m[i][2] * v.z; };
  return {row(0), row(1), row(2)};
}
[[nodiscard]] inline Vec3d moved_by(const Mat4d& a, const Vec3d& p) {
  const auto row = [&](int i) {
    return a.m[i][0] * p.x + a.m[i][1] * p.y + a.m[i][2] * p.z + a.m[i][3];
  };
  return {row(0), row(1), row(2)};
}

}  // namespace rastrum
