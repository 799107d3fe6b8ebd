// SPDX-License-Identifier: BSD-3-Clause
// Angles in degrees, exact at quarter turns.
#pragma once

#include <cmath>
#include <numbers>

#include <rastrum/core/elementary.hpp>

namespace rastrum {

using elementary::SinCos;

/// The sine and cosine of any finite angle in degrees, to about an ulp; exact at multiples of 90.
inline SinCos sin_cos_degrees(double degrees) {
  // Both are exact: fmod by definition, and the rest of a quarter because it has few enough bits.
  const double turn = std::fmod(degrees, 360.0);
  const double quarters = std::floor(turn / 90 + 0.5);
  const auto [s, c] = elementary::sin_cos((turn - 90 * quarters) * (std::numbers::pi / 180));
  switch (static_cast<int>(quarters) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

}  // namespace rastrum
