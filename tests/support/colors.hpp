// SPDX-License-Identifier: BSD-3-Clause
// The transfer function of sRGB and its inverse, in float64.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <rastrum/image.hpp>

namespace rastrum::test {

inline double display(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}
inline double light_of(double display_value) {
  return display_value <= 0.04045 ? display_value / 12.92
                                  : std::pow((display_value + 0.055) / 1.055, 2.4);
}
inline double light(int code) {
  return light_of(code / 255.0);
}

/// The largest difference of a channel, without alpha.
inline int difference(Rgba8 a, Rgba8 b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

}  // namespace rastrum::test
