// SPDX-License-Identifier: BSD-3-Clause
// The elementary functions for all that leads to a pixel. Each libm, and each version of it, rounds
// differently. These give the same bits on every machine, because they use only IEEE's + − · / √
// and integers (decision 0030; tools/check_libm.py enforces their use).
//
// In float64, faithfully rounded: the error is below 0.53 ulp, so the result is nearly always the
// nearest number; 0.8 ulp for pow where |y log x| is above 100, 1 ulp for results below 2⁻¹⁰²².
// NaN, infinities and zeros as in IEEE. Cost: 50 (sin) to 200 ns (cbrt).
#pragma once

namespace rastrum::elementary {

struct SinCos {
  double sin = 0, cos = 1;
};

/// Sine, cosine and tangent of any angle in radians, however large; NaN if it is not finite.
[[nodiscard]] SinCos sin_cos(double rad);
[[nodiscard]] double sin(double rad);
[[nodiscard]] double cos(double rad);
[[nodiscard]] double tan(double rad);

/// In radians: [−π/2, π/2], [−π/2, π/2], [0, π]; asin and acos are NaN beyond [−1, 1].
[[nodiscard]] double atan(double t);
[[nodiscard]] double asin(double s);
[[nodiscard]] double acos(double c);
/// The angle of (x, y), in [−π, π].
[[nodiscard]] double atan2(double y, double x);

[[nodiscard]] double exp(double x);
/// −∞ at 0, NaN below.
[[nodiscard]] double log(double x);
/// log(1 + x), accurate for small x. −∞ at −1, NaN below.
[[nodiscard]] double log1p(double x);
[[nodiscard]] double log2(double x);
[[nodiscard]] double log10(double x);

/// As in IEEE: pow(x, 0) = pow(1, y) = 1; a negative x needs an integer y.
[[nodiscard]] double pow(double x, double y);
[[nodiscard]] double cbrt(double x);

}  // namespace rastrum::elementary
