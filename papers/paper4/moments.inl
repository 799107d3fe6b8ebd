// SPDX-License-Identifier: BSD-3-Clause
// The arithmetic of moment-based transparency (mboit.cpp), in lanes of pixels or in one float
// (approximations_simd.cpp). One body gives all instruction sets and the scalar kernels the same
// bits.
//
// The 2 n moments belong to a measure of mass 1. The absorbance in front of depth z is that of the
// truncated Hamburger moment problem (Peters and Klein, "Moment Shadow Mapping", 2015): of the
// measure with these moments that has a node at z and n others. The others are the roots of the
// kernel K(z, ·) = Σ Pᵢ(z) Pᵢ(·) / Dᵢ of its orthogonal polynomials. Node z has mass 1 / K(z, z).
// The paper interpolates over all roots, but one root is enough. The sign of K's leading
// coefficient says how many roots lie in front of z, up to a pair; K's derivatives at z say whether
// all others lie on one side. If not, one outermost root is alone on its side, and the moments
// about z give its mass. The polynomial is written in t = 1 / (x − z) and begins with K(z, z) ≥ 1:
// far roots are small t, so nothing grows without bound.

/// log(n / d) of positive normal numbers n ≥ d. The relative error is small for small results too.
RASTRUM_LANES F log_ratio(F n, F d) {
  // d · 2^k is near n; then log(n / d) = 2 artanh((n − d) / (n + d)) + k log 2.
  const I k = shift_right_23(bits(n) - bits(d) + integer(1 << 22));
  const F near = from_bits(bits(d) + shift_left_23(k));
  const F s = (n - near) / (n + near);
  const F z = s * s, twice = s + s;
  const F series =
      z * (set(1.0F / 3) + z * (set(1.0F / 5) + z * (set(1.0F / 7) + z * set(1.0F / 9))));
  return to_float(k) * set(0.693147181F) + (twice + twice * series);
}

/// exp(−x) for x ≥ 0, with x clamped to 80. Exactly 1 at 0.
RASTRUM_LANES F exp_of_minus(F x) {
  constexpr float kRounder = 12582912;  // 1.5 · 2²³: adding it rounds to an integer
  const F y = set(0) - min_of(x, set(80));
  const F rounded = y * set(1.44269504F) + set(kRounder);
  const F k = rounded - set(kRounder);
  // log 2 in two parts; products of the first are exact.
  const F r = (y - k * set(0.693359375F)) - k * set(-2.12194440e-4F);
  const F series = set(1.0F / 2) +
                   r * (set(1.0F / 6) +
                        r * (set(1.0F / 24) +
                             r * (set(1.0F / 120) + r * (set(1.0F / 720) + r * set(1.0F / 5040)))));
  const F power = set(1) + (r + r * r * series);
  return from_bits(bits(power) + shift_left_23(bits(rounded) - bits(set(kRounder))));
}

/// −log(1 − α), for an α of at most 1 − 10⁻⁶ and at least 0.
RASTRUM_LANES F absorbance(F alpha) {
  // Uses comparisons, not a minimum, so that NaN becomes 0.
  const F kept =
      choose(alpha > set(0), choose(alpha < set(kMostAlpha), alpha, set(kMostAlpha)), set(0));
  return log_ratio(set(1), set(1) - kept);
}

/// Maps a block's depths to −1 (the nearest) … 1 (the farthest), or to 0 if they are all equal. A
/// lane without a fragment counts as the farthest, or its result is not used.
struct Warp {
  F nearest, farthest, scale, offset;

  RASTRUM_LANES F operator()(F depth) const {
    return log_ratio(nearest, max_of(depth, farthest)) * scale + offset;
  }
};

/// Σ absorbance · zᵏ.
template <int kCount>
struct Sums {
  F sum[static_cast<std::size_t>(kCount)];

  RASTRUM_LANES void add(F term, F z) {
    for (int k = 0; k < kCount; ++k) {
      sum[k] = sum[k] + term;
      if (k + 1 < kCount) term = term * z;
    }
  }
};

/// Moment k of `sums`, moved by `bias` towards that of a spread-out measure. This makes the moments
/// valid despite rounding (the paper's supplement, table 1).
template <int kCount>
RASTRUM_LANES F biased(const Sums<kCount>& sums, F scale, int k, float bias, float towards) {
  return set(1 - bias) * (sums.sum[k] * scale) + set(bias * towards);
}

template <int n>
struct Problem;

/// Four moments.
template <>
struct Problem<2> {
  F b1, b2, l21, over_d1, over_d2;

  RASTRUM_LANES explicit Problem(const Sums<5>& sums) {
    constexpr float kBias = 5e-7F;
    const F scale = set(1) / choose(sums.sum[0] > set(0), sums.sum[0], set(1));
    b1 = biased(sums, scale, 1, kBias, 0);
    b2 = biased(sums, scale, 2, kBias, 0.375F);
    const F b3 = biased(sums, scale, 3, kBias, 0);
    const F b4 = biased(sums, scale, 4, kBias, 0.375F);
    // The Hankel matrix as L D Lᵀ. But for rounding, the bias keeps D above the bias's own part.
    const F d1 = max_of(b2 - b1 * b1, set(kBias * 0.375F));
    over_d1 = set(1) / d1;
    const F v21 = b3 - b1 * b2;
    l21 = v21 * over_d1;
    over_d2 = set(1) / max_of(b4 - b2 * b2 - l21 * v21, set(kBias * 0.234375F));
  }

  /// The share of the absorbance in front of z, with a quarter of the mass at z.
  RASTRUM_LANES F before(F z) const {
    const F p1 = z - b1, p2 = z * z - b2 - l21 * p1;
    const F u1 = p1 * over_d1, u2 = p2 * over_d2;
    const F mass = set(1) / (set(1) + p1 * u1 + p2 * u2);
    // t² + a t + b, whose roots t are the inverse distances of the two nodes.
    const F a = (u1 + u2 * (z + z - l21)) * mass, b = u2 * mass;
    const F half = a * set(0.5F);
    const F root = square_root(max_of(half * half - b, set(1e-30F)));
    const F rest = set(1) - mass, quarter = mass * set(kOverestimation);
    // One root on either side: the moments 1 and z give the mass of the one in front.
    const F first = (rest * (half + root) - p1 * b) / (root + root);
    const F same_side = choose(half > set(0), rest, set(0));
    return quarter + choose(b < set(0), first, same_side);
  }
};

/// 2 cos(acos(2 s² − 1) / 3) for s from 0 to 1, with an error below 5e-8.
RASTRUM_LANES F two_cos_of_third(F s) {
  return set(1.0000000455F) +
         s * (set(1.154694445F) +
              s * (set(-0.222086479F) +
                   s * (set(0.105738212F) +
                        s * (set(-0.060626126F) +
                             s * (set(0.032318978F) +
                                  s * (set(-0.012339899F) + s * set(0.002300858F)))))));
}

/// Six.
template <>
struct Problem<3> {
  F b1, b2, b3, l21, l31, l32, over_d1, over_d2, over_d3;

  RASTRUM_LANES explicit Problem(const Sums<7>& sums) {
    constexpr float kBias = 5e-6F;
    const F scale = set(1) / choose(sums.sum[0] > set(0), sums.sum[0], set(1));
    b1 = biased(sums, scale, 1, kBias, 0);
    b2 = biased(sums, scale, 2, kBias, 0.48F);
    b3 = biased(sums, scale, 3, kBias, 0);
    const F b4 = biased(sums, scale, 4, kBias, 0.451F);
    const F b5 = biased(sums, scale, 5, kBias, 0);
    const F b6 = biased(sums, scale, 6, kBias, 0.45F);
    over_d1 = set(1) / max_of(b2 - b1 * b1, set(kBias * 0.48F));
    const F v21 = b3 - b1 * b2;
    l21 = v21 * over_d1;
    over_d2 = set(1) / max_of(b4 - b2 * b2 - l21 * v21, set(kBias * 0.2206F));
    const F v31 = b4 - b1 * b3;
    l31 = v31 * over_d1;
    const F v32 = b5 - b2 * b3 - l21 * v31;
    l32 = v32 * over_d2;
    over_d3 = set(1) / max_of(b6 - b3 * b3 - l31 * v31 - l32 * v32, set(kBias * 0.02624F));
  }

  RASTRUM_LANES F before(F z) const {
    const F square = z * z;
    const F p1 = z - b1, p2 = square - b2 - l21 * p1;
    const F p3 = square * z - b3 - l31 * p1 - l32 * p2;
    const F u1 = p1 * over_d1, u2 = p2 * over_d2, u3 = p3 * over_d3;
    const F mass = set(1) / (set(1) + p1 * u1 + p2 * u2 + p3 * u3);
    // t³ + a t² + b t + c, mirrored so that c ≥ 0: then the roots behind z come in a pair.
    const F slope2 = z + z - l21;
    const F slope = u1 + u2 * slope2 + u3 * (set(3) * square - l31 - l32 * slope2);
    const auto mirrored = u3 < set(0);
    const F a = choose(mirrored, set(0) - slope, slope) * mass;
    const F b = (u2 + u3 * (set(3) * z - l32)) * mass;
    const F c = choose(mirrored, set(0) - u3, u3) * mass;
    const F first_moment = choose(mirrored, p1, set(0) - p1);
    const F second_moment = b2 - (z + z) * b1 + square;
    // The smallest root (Viète). One root is below 0, or three are.
    const F h = a * set(1.0F / 3), square_r = max_of(h * h - b * set(1.0F / 3), set(1e-24F));
    const F r = square_root(square_r);
    const F q = (h * (h * h - b * set(0.5F)) + c * set(0.5F)) / (square_r * r);
    const F half = min_of(max_of(q * set(0.5F) + set(0.5F), set(0)), set(1));
    const F t = set(0) - r * two_cos_of_third(square_root(half)) - h;
    const F others = a + t;  // minus the sum of the other two roots
    const F product = b + t * others;
    const F rest = set(1) - mass, quarter = mass * set(kOverestimation);
    const F slope_at_t = t * (set(3) * t + a + a) + b;
    const F alone = t * t * (rest + others * first_moment + product * second_moment) /
                    max_of(slope_at_t, set(1e-30F));
    const F outer = choose(a > set(0), choose(b > set(0), rest, alone), alone);
    return quarter + choose(mirrored, rest - outer, outer);
  }
};

/// The transmittance of everything in front of a fragment at z.
template <int n>
RASTRUM_LANES F transmittance(const Problem<n>& problem, F absorbance_sum, F z) {
  const F share = min_of(max_of(problem.before(z), set(0)), set(1));
  return exp_of_minus(max_of(absorbance_sum, set(0)) * share);
}
