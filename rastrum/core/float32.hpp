// SPDX-License-Identifier: BSD-3-Clause
// Rounds float64 numbers to float32.
#pragma once

#include <rastrum/vec.hpp>

namespace rastrum {

/// Goes through memory: GCC 12 (-O2) vectorizes the rounding together with the conversion back, and
/// then leaves both out.
[[nodiscard]] inline double in_float32(double x) {
  const volatile float rounded = static_cast<float>(x);
  return rounded;
}
[[nodiscard]] inline Vec3d in_float32(Vec3d v) {
  return {in_float32(v.x), in_float32(v.y), in_float32(v.z)};
}

}  // namespace rastrum
