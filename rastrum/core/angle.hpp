// Sines and cosines that are the same bits on every machine: a libm may round its own as it likes,
// and what leads to a pixel must not depend on whose it is.
#pragma once

#include <cmath>
#include <numbers>

namespace rastrum {

struct SinCos {
  double sin = 0, cos = 1;
};

/// Of an angle in degrees, any finite one; to about an ulp, exact (−1, 0, 1) at multiples of 90.
inline SinCos sin_cos_degrees(double degrees) {
  // Both are exact: fmod by its definition, and what is left of a quarter by having few enough
  // bits.
  const double turn = std::fmod(degrees, 360.0);
  const double quarters = std::floor(turn / 90 + 0.5);
  const double x = (turn - 90 * quarters) * (std::numbers::pi / 180);
  const double x2 = x * x;
  // Taylor's series within ±45°; the first term left out is below 1e-19.
  double s = 1, c = 1;
  for (int n = 18; n >= 2; n -= 2) {
    s = 1 - x2 / (n * (n + 1)) * s;
    c = 1 - x2 / ((n - 1) * n) * c;
  }
  s *= x;
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

/// The tangent of half an angle in radians, from 0 to below π.
inline double tan_half(double angle_rad) {
  const SinCos half = sin_cos_degrees(angle_rad * (180 / std::numbers::pi) / 2);
  return half.sin / half.cos;
}

}  // namespace rastrum
