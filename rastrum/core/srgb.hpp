// SPDX-License-Identifier: BSD-3-Clause
// The sRGB transfer function (IEC 61966-2-1).
#pragma once

#include <rastrum/core/elementary.hpp>

namespace rastrum {

/// Display value to linear light, both in [0, 1].
[[nodiscard]] inline double linear_from_srgb(double display) {
  return display <= 0.04045 ? display / 12.92 : elementary::pow((display + 0.055) / 1.055, 2.4);
}

}  // namespace rastrum
