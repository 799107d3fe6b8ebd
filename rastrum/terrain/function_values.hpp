// SPDX-License-Identifier: BSD-3-Clause
// The named functions, on any device. Sine and exponential are polynomials of float64 operations in
// one written order; a C library's differ between machines and from host to device.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <rastrum/config.hpp>

namespace rastrum::terrain {

/// In the order of named_functions().
enum class NamedFunction : std::uint8_t { cosines, squares, expo, expo2, wavy, noise };

namespace functions_detail {

/// sin(2π·turns), to about 1e-9.
RASTRUM_HD inline double sine(double turns) {
  const double whole = std::floor(turns + 0.5);
  double t = turns - whole;  // [-1/2, 1/2)
  if (t > 0.25) t = 0.5 - t;
  if (t < -0.25) t = -0.5 - t;
  const double x = t * 6.283185307179586, x2 = x * x;
  return x * (1 + x2 * (-1.0 / 6 +
                        x2 * (1.0 / 120 +
                              x2 * (-1.0 / 5040 + x2 * (1.0 / 362880 + x2 * (-1.0 / 39916800))))));
}
RASTRUM_HD inline double cosine(double turns) {
  return sine(turns + 0.25);
}

/// exp(−x) for x ≥ 0: (1 − x/256 + …)^256, to about 1e-7.
RASTRUM_HD inline double decay(double x) {
  if (!(x < 80)) return 0;
  const double y = x / 256;
  double r = 1 - y * (1 - y / 2 * (1 - y / 3 * (1 - y / 4 * (1 - y / 5))));
  for (int i = 0; i < 8; ++i) r *= r;
  return r;
}

RASTRUM_HD inline double hump(double dx, double dy, double width) {
  return decay((dx * dx + dy * dy) / (width * width));
}

RASTRUM_HD inline double cosines(double x, double y) {
  return 50 + 50 * cosine(x / 256) * sine(y / 256);
}
RASTRUM_HD inline double squares(double x, double y) {
  const double u = std::floor(x / 64), v = std::floor(y / 64);
  const double sum = (u + v) / 2;
  return sum == std::floor(sum) ? 40 : 5;
}
RASTRUM_HD inline double expo(double x, double y) {
  return 140 * hump(x - 512, y - 512, 150);
}
RASTRUM_HD inline double expo2(double x, double y) {
  const double u = std::floor(x / 256), v = std::floor(y / 256), odd = (u + v) / 2;
  const double height = odd == std::floor(odd) ? 90 : 50;
  return height * hump(x - u * 256 - 128, y - v * 256 - 128, 60);
}
RASTRUM_HD inline double wavy(double x, double y) {
  return 40 + 25 * sine(x / 300 + 0.2 * sine(y / 410)) + 15 * sine(y / 130 + 0.3 * sine(x / 220));
}

/// A value in [0, 1) for each corner of the lattice.
RASTRUM_HD inline double corner(std::int64_t x, std::int64_t y, std::uint64_t octave) {
  std::uint64_t z = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15U +
                    static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FU +
                    octave * 0x165667B19E3779F9U;
  z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9U;
  z = (z ^ z >> 27) * 0x94D049BB133111EBU;
  return static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53;
}
RASTRUM_HD inline double value_noise(double x, double y, std::uint64_t octave) {
  const double fx = std::floor(x), fy = std::floor(y);
  // As in cell_at, int64 cannot hold all floors.
  const auto cell = [](double f) {
    return static_cast<std::int64_t>(f > -0x1p52 ? (f < 0x1p52 ? f : 0x1p52) : -0x1p52);
  };
  const std::int64_t ix = cell(fx), iy = cell(fy);
  const auto smooth = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
  const double u = smooth(x - fx), v = smooth(y - fy);
  const double top = corner(ix, iy, octave) * (1 - u) + corner(ix + 1, iy, octave) * u;
  const double bottom = corner(ix, iy + 1, octave) * (1 - u) + corner(ix + 1, iy + 1, octave) * u;
  return top * (1 - v) + bottom * v;
}
/// Fractal Brownian motion (Musgrave) of value noise.
RASTRUM_HD inline double noise(double x, double y) {
  double sum = 0, amplitude = 0.5, scale = 1.0 / 256;
  for (std::uint64_t octave = 0; octave < 8; ++octave) {
    sum += amplitude * value_noise(x * scale, y * scale, octave);
    amplitude /= 2;
    scale *= 2;
  }
  return 160 * sum;
}

}  // namespace functions_detail

[[nodiscard]] RASTRUM_HD inline float height_of(NamedFunction function, double x, double y) {
  using namespace functions_detail;
  switch (function) {
    case NamedFunction::cosines:
      return static_cast<float>(cosines(x, y));
    case NamedFunction::squares:
      return static_cast<float>(squares(x, y));
    case NamedFunction::expo:
      return static_cast<float>(expo(x, y));
    case NamedFunction::expo2:
      return static_cast<float>(expo2(x, y));
    case NamedFunction::wavy:
      return static_cast<float>(wavy(x, y));
    case NamedFunction::noise:
      break;
  }
  return static_cast<float>(noise(x, y));
}

/// Remembers the function's name, so that a device can compute it too.
struct NamedHeights {
  NamedFunction function;
  void operator()(const double* x, const double* y, std::size_t n, float* out) const {
    for (std::size_t i = 0; i < n; ++i) out[i] = height_of(function, x[i], y[i]);
  }
};

}  // namespace rastrum::terrain
