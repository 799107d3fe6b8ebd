// SPDX-License-Identifier: BSD-3-Clause
// The colours of the parts of a shape.
#pragma once

#include <rastrum/vec.hpp>

namespace rastrum::shapes {

/// The colour for a place in the cube [−1, 1]³: linear, neither black nor white.
inline Vec4 place_color(Vec3d p) {
  const auto channel = [](double v) { return static_cast<float>(0.15 + 0.35 * (v + 1)); };
  return {channel(p.x), channel(p.y), channel(p.z), 1};
}

}  // namespace rastrum::shapes
