// SPDX-License-Identifier: BSD-3-Clause
// Linear light to display values, in lanes (kernels/lane_math-inl.hpp) or in one float (srgb.hpp).

/// Clamps to [0, 1]; NaN gives 0.
RASTRUM_LANES F srgb_from_linear(F linear) {
  const F x = min_of(choose_or_zero(linear > set(0), linear), set(1));
  const F s2 = square_root(x);
  const F s4 = square_root(s2);
  const F s8 = square_root(s4);
  const F curve = set(kSrgbRoot2) * s2 + set(kSrgbRoot4) * s4 - set(kSrgbRoot8) * s8 -
                  (set(kSrgbLinear) * x + set(kSrgbConstant));
  return choose(x < set(kSrgbKnee), x * set(kSrgbSlope), curve);
}
