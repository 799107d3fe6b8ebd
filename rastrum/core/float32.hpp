// SPDX-License-Identifier: BSD-3-Clause
// Numbers in float64, rounded to what float32 holds.
#pragma once

#include <rastrum/vec.hpp>

namespace rastrum {

/// Through memory: where GCC 12 (-O2) makes vectors of the rounding and of the way back, it leaves
/// both out, as if float32 held all numbers of float64.
[[nodiscard]] inline double in_float32(double x) {
  const volatile float rounded = static_cast<float>(x);
  return rounded;
}
[[nodiscard]] inline Vec3d in_float32(Vec3d v) {
  return {in_float32(v.x), in_float32(v.y), in_float32(v.z)};
}

}  // namespace rastrum
