// SPDX-License-Identifier: BSD-3-Clause
// The shortest turn from +y to another up.
#pragma once

#include <rastrum/vec.hpp>

namespace rastrum {

/// v turned the shortest way from +y to the unit vector `up` (Rodrigues); to −y about x.
[[nodiscard]] inline Vec3d tilted(const Vec3d& up, const Vec3d& v) {
  if (up.y <= -1) return {v.x, -v.y, -v.z};
  const Vec3d axis{up.z, 0, -up.x};  // cross(+y, up)
  // 1 + up.y, with all its digits where up is almost −y.
  const double above = up.y < 0 ? (up.x * up.x + up.z * up.z) / (1 - up.y) : 1 + up.y;
  return v * up.y + cross(axis, v) + axis * (dot(axis, v) / above);
}

}  // namespace rastrum
