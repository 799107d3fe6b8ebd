// SPDX-License-Identifier: BSD-3-Clause
// Each function is computed as an unevaluated sum of two doubles (Dekker, "A floating-point
// technique for extending the available precision", 1971) and rounded once. A series' first terms
// are such pairs, its small rest is one double. Sine and cosine reduce their argument in integers,
// with as many bits of 2/π as its size needs (Payne and Hanek, "Radian reduction for trigonometric
// functions", 1983).
#include <rastrum/core/elementary.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace rastrum::elementary {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// hi + lo; lo is at most half an ulp of hi.
struct Pair {
  double hi = 0, lo = 0;
};

constexpr Pair kHalfPi{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr Pair kPi{2 * kHalfPi.hi, 2 * kHalfPi.lo};
/// log 2: 41 bits, whose products with exponents are exact, and the rest.
constexpr double kLog2High = 0x1.62e42fefa3000p-1;
constexpr Pair kLog2Rest{0x1.3de6af278ece6p-42, 0x1.f97b57a079a19p-103};

/// a + b, exactly. Requires |a| ≥ |b|.
Pair sum_sorted(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}
/// a + b, exactly (Knuth).
Pair sum(double a, double b) {
  const double s = a + b, from_b = s - a;
  return {s, (a - (s - from_b)) + (b - from_b)};
}
/// a · b, exactly, for factors below 2⁹⁹⁵ whose product is above 2⁻⁹⁶⁹.
Pair product(double a, double b) {
  constexpr double kSplit = 0x1p27 + 1;
  const double ca = kSplit * a, cb = kSplit * b;
  const double a1 = ca - (ca - a), b1 = cb - (cb - b);
  const double a2 = a - a1, b2 = b - b1;
  const double p = a * b;
  return {p, a2 * b2 - (((p - a1 * b1) - a2 * b1) - a1 * b2)};
}
Pair operator-(Pair a) {
  return {-a.hi, -a.lo};
}
Pair operator+(Pair a, Pair b) {
  const Pair s = sum(a.hi, b.hi), t = sum(a.lo, b.lo);
  const Pair u = sum_sorted(s.hi, s.lo + t.hi);
  return sum_sorted(u.hi, u.lo + t.lo);
}
Pair operator*(Pair a, Pair b) {
  const Pair p = product(a.hi, b.hi);
  return sum_sorted(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}
Pair operator/(Pair a, Pair b) {
  const double q = a.hi / b.hi;
  const Pair r = a + -(b * Pair{q});
  return sum_sorted(q, r.hi / b.hi);
}
Pair square_root(Pair a) {
  const double root = std::sqrt(a.hi);
  const Pair rest = a + -product(root, root);
  return root > 0 ? sum_sorted(root, rest.hi / (2 * root)) : Pair{};
}
double rounded(Pair a) {
  return a.hi + a.lo;
}
/// c[0] + c[1] z + …
template <std::size_t n>
double polynomial(const std::array<double, n>& c, double z) {
  double v = c[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) v = c[i] + z * v;
  return v;
}

// --- Sine and cosine ----------------------------------------------------------------------------

/// The bits of 2/π behind the point, as many as the largest double needs.
constexpr std::uint64_t kTwoOverPi[19] = {
    0xa2f9836e4e441529, 0xfc2757d1f534ddc0, 0xdb6295993c439041, 0xfe5163abdebbc561,
    0xb7246e3a424dd2e0, 0x06492eea09d1921c, 0xfe1deb1cb129a73e, 0xe88235f52ebb4484,
    0xe99c7026b45f7e41, 0x3991d639835339f4, 0x9c845f8bbdf9283b, 0x1ff897ffde05980f,
    0xef2f118b5a0a6d1f, 0x6d367ecf27cb09b7, 0x4f463f669e5fea2d, 0x7527bac7ebe5f17b,
    0x3d0739f78a5292ea, 0x6bfb5fb11f8d5d08, 0x56033046fc7b6bab};

/// An angle as quarter turns and a rest of at most π/4.
struct Reduced {
  unsigned quarters = 0;
  Pair rest;
};

__extension__ using Uint128 = unsigned __int128;

/// 192 bits, highest first.
struct Bits {
  std::uint64_t word[3];

  [[nodiscard]] Bits shifted_left(int by) const {
    if (by >= 64) return Bits{{word[1], word[2], 0}}.shifted_left(by - 64);
    if (by == 0) return *this;
    return {{word[0] << by | word[1] >> (64 - by), word[1] << by | word[2] >> (64 - by),
             word[2] << by}};
  }
};

/// Payne and Hanek's reduction, for finite angles above π/4.
Reduced reduce_large(double rad) {
  const auto bits = std::bit_cast<std::uint64_t>(rad);
  const int exponent = static_cast<int>(bits >> 52) - 1075;  // rad = mantissa · 2^exponent
  const std::uint64_t mantissa = (bits & 0xfffffffffffff) | 0x10000000000000;
  // 192 bits of 2/π, from the first whose product is not a whole number of turns.
  const int first = exponent > 2 ? exponent - 2 : 0;
  std::uint64_t window[3];
  for (int i = 0; i < 3; ++i) {
    const int at = first + 64 * i;
    const std::uint64_t* w = kTwoOverPi + at / 64;
    window[i] = at % 64 == 0 ? w[0] : w[0] << at % 64 | w[1] >> (64 - at % 64);
  }
  // Times the mantissa: four words.
  std::uint64_t p[4];
  Uint128 carry = 0;
  for (int i = 3; i-- > 0;) {
    carry += Uint128{window[i]} * mantissa;
    p[i + 1] = static_cast<std::uint64_t>(carry);
    carry >>= 64;
  }
  p[0] = static_cast<std::uint64_t>(carry);
  // Align to two bits of quarter turns, then 190 bits of the rest.
  if (const int down = 2 - (exponent - first); down > 0)
    for (int i = 3; i > 0; --i) p[i] = p[i] >> down | p[i - 1] << (64 - down);
  unsigned quarters = static_cast<unsigned>(p[1] >> 62);
  Bits rest = Bits{{p[1], p[2], p[3]}}.shifted_left(2);
  // Round to the nearest quarter turn.
  const bool negative = rest.word[0] >> 63 != 0;
  if (negative) {
    ++quarters;
    rest = {{~rest.word[0], ~rest.word[1], ~rest.word[2]}};  // an error of 2⁻¹⁹² does not matter
  }
  int zeros = 0;
  while (zeros < 128 && rest.shifted_left(zeros).word[0] >> 63 == 0)
    zeros += std::countl_zero(rest.shifted_left(zeros).word[0]);
  const Bits top = rest.shifted_left(zeros);
  // The first 53 bits, then the next 53.
  const auto hi = static_cast<double>(top.word[0] >> 11);
  const auto lo = static_cast<double>((top.word[0] & 0x7ff) << 42 | top.word[1] >> 22);
  const double unit = std::ldexp(negative ? -1.0 : 1.0, -53 - zeros);
  return {quarters, sum_sorted(hi * unit, lo * (unit * 0x1p-53)) * kHalfPi};
}

/// Cody and Waite's reduction: π/2 as two parts of 33 bits, whose products with numbers up to 2¹⁹
/// are exact, and the rest.
Reduced reduce_small(double rad) {
  constexpr double kPerHalfPi = 0x1.45f306dc9c883p-1;
  constexpr double kFirst = 0x1.921fb54400000p+0, kSecond = 0x1.0b4611a600000p-34;
  constexpr Pair kThird{0x1.3198a2e037073p-69, 0x1.129024e088a68p-123};
  const double k = std::floor(rad * kPerHalfPi + 0.5);
  return {static_cast<unsigned>(static_cast<int>(k)),
          sum(rad - k * kFirst, -k * kSecond) + -(kThird * Pair{k})};
}

Reduced reduce(double rad) {
  const double size = std::abs(rad);
  if (size <= kHalfPi.hi / 2) return {0, {rad}};
  if (size < 0x1p19) return reduce_small(rad);
  Reduced r = reduce_large(size);
  if (rad < 0) r = {0U - r.quarters, -r.rest};
  return r;
}

/// Sine and cosine of an angle of at most π/4, by Taylor series.
Pair sin_small(Pair x) {
  constexpr Pair kSixth{-0x1.5555555555555p-3, -0x1.5555555555555p-57};
  constexpr std::array<double, 8> kSeries{
      1. / 120,        -1. / 5040,          1. / 362880,          -1. / 39916800,
      1. / 6227020800, -1. / 1307674368000, 1. / 355687428096000, -1. / 121645100408832000};
  const Pair z = x * x;
  return x + x * z * (kSixth + Pair{z.hi * polynomial(kSeries, z.hi)});
}
Pair cos_small(Pair x) {
  constexpr Pair k24th{0x1.5555555555555p-5, 0x1.5555555555555p-59};
  constexpr std::array<double, 7> kSeries{
      -1. / 720,         1. / 40320,          -1. / 3628800,         1. / 479001600,
      -1. / 87178291200, 1. / 20922789888000, -1. / 6402373705728000};
  const Pair z = x * x;
  const Pair rest = k24th + Pair{z.hi * polynomial(kSeries, z.hi)};
  return Pair{1} + (Pair{-z.hi / 2, -z.lo / 2} + z * z * rest);
}

/// The sine of an angle plus `quarters` quarter turns; 1 gives the cosine.
Pair sin_of(const Reduced& angle, unsigned quarters) {
  quarters += angle.quarters;
  const Pair v = quarters % 2 == 0 ? sin_small(angle.rest) : cos_small(angle.rest);
  return quarters % 4 < 2 ? v : -v;
}

// --- Arc functions ------------------------------------------------------------------------------

/// The angle of (x, y) in [0, π] for y ≥ 0. Both are at most 1, and one is at least 0.7.
Pair angle_of(Pair y, Pair x) {
  if (x.hi < 0) return kPi + -angle_of(y, -x);
  if (y.hi > x.hi) return kHalfPi + -angle_of(x, y);
  const double t = y.hi / x.hi;
  if (t < 0x1p-30) return y / x;
  // A guess within 0.005; the rest follows from its exact sine and cosine.
  const double guess = t / (1 + 0.28086 * t * t);
  const Pair s = sin_small({guess}), c = cos_small({guess});
  const double d = (y * c + -(x * s)).hi / (x * c + y * s).hi, z = d * d;
  return Pair{guess} + Pair{d - d * z * (1. / 3 - z * (1. / 5 - z / 7))};
}

/// √(1 − s²).
Pair other_leg(double s) {
  return square_root(sum(1, -s) * sum(1, s));
}

// --- Exponential and logarithm ------------------------------------------------------------------

/// m · 2^k for |k| below 2,200, rounded once in float64's normal range.
double scaled(double m, int k) {
  const int half = k / 2;
  const auto power = [](int e) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(e + 1023) << 52);
  };
  return m * power(half) * power(k - half);
}

double exp_pair(Pair x) {
  constexpr double kPerLog2 = 0x1.71547652b82fep+0;
  constexpr std::array<double, 12> kSeries{1. / 6,         1. / 24,          1. / 120,
                                           1. / 720,       1. / 5040,        1. / 40320,
                                           1. / 362880,    1. / 3628800,     1. / 39916800,
                                           1. / 479001600, 1. / 6227020800., 1. / 87178291200.};
  if (x.hi > 710) return kInfinity;
  if (x.hi < -746) return 0;
  const double k = std::floor(x.hi * kPerLog2 + 0.5);
  const Pair r = sum(x.hi - k * kLog2High, x.lo) + -(kLog2Rest * Pair{k});
  const Pair square = r * r;
  const Pair rest{square.hi * r.hi * polynomial(kSeries, r.hi)};
  const Pair value = Pair{1} + (r + (Pair{square.hi / 2, square.lo / 2} + rest));
  return scaled(rounded(value), static_cast<int>(k));
}

/// The natural logarithm of a positive finite number.
Pair log_pair(double x) {
  constexpr Pair kTwoThirds{0x1.5555555555555p-1, 0x1.5555555555555p-55};
  constexpr Pair kTwoFifths{0x1.999999999999ap-2, -0x1.999999999999ap-56};
  constexpr std::array<double, 11> kSeries{2. / 7,  2. / 9,  2. / 11, 2. / 13, 2. / 15, 2. / 17,
                                           2. / 19, 2. / 21, 2. / 23, 2. / 25, 2. / 27};
  int k = 0;
  if (x < 0x1p-1022) {
    x *= 0x1p54;
    k = -54;
  }
  // x = m · 2^k, m between √½ and √2.
  const auto bits = std::bit_cast<std::uint64_t>(x);
  k += static_cast<int>(bits >> 52) - 1023;
  double m = std::bit_cast<double>((bits & 0xfffffffffffff) | 0x3ff0000000000000);
  if (m > 0x1.6a09e667f3bcdp+0) {
    m /= 2;
    ++k;
  }
  // log m = 2 artanh s, s = (m − 1) / (m + 1).
  const Pair s = Pair{m - 1} / sum(m, 1);
  const Pair z = s * s;
  const Pair rest = kTwoThirds + z * (kTwoFifths + Pair{z.hi * polynomial(kSeries, z.hi)});
  const Pair log_m = Pair{2 * s.hi, 2 * s.lo} + s * z * rest;
  return Pair{k * kLog2High} + (kLog2Rest * Pair{static_cast<double>(k)} + log_m);
}

/// The logarithm of x if it is ±∞ or NaN; 0 if it is finite.
double odd_log(double x) {
  return x > 0 ? (x < kInfinity ? 0 : x) : x == 0 ? -kInfinity : kNan;
}

bool is_integer(double y) {
  return std::floor(y) == y;
}
bool is_odd(double y) {
  return is_integer(y) && !is_integer(y / 2);
}

}  // namespace

double sin(double rad) {
  if (!std::isfinite(rad)) return kNan;
  if (std::abs(rad) < 0x1p-30) return rad;
  return rounded(sin_of(reduce(rad), 0));
}
double cos(double rad) {
  if (!std::isfinite(rad)) return kNan;
  return rounded(sin_of(reduce(rad), 1));
}
SinCos sin_cos(double rad) {
  if (!std::isfinite(rad)) return {kNan, kNan};
  if (std::abs(rad) < 0x1p-30) return {rad, 1};
  const Reduced angle = reduce(rad);
  return {rounded(sin_of(angle, 0)), rounded(sin_of(angle, 1))};
}
double tan(double rad) {
  if (!std::isfinite(rad)) return kNan;
  if (std::abs(rad) < 0x1p-30) return rad;
  const Reduced angle = reduce(rad);
  return rounded(sin_of(angle, 0) / sin_of(angle, 1));
}

double atan(double t) {
  const double size = std::abs(t);
  if (std::isnan(t) || size < 0x1p-30) return t;
  const double angle = size < 0x1p60 ? rounded(size > 1 ? angle_of({1}, Pair{1} / Pair{size})
                                                        : angle_of({size}, {1}))
                                     : kHalfPi.hi;
  return std::copysign(angle, t);
}
double asin(double s) {
  const double size = std::abs(s);
  if (!(size <= 1)) return kNan;
  if (size < 0x1p-30) return s;
  return std::copysign(rounded(angle_of({size}, other_leg(size))), s);
}
double acos(double c) {
  if (!(std::abs(c) <= 1)) return kNan;
  return rounded(angle_of(other_leg(c), {c}));
}

double atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return kNan;
  double across = std::abs(x), up = std::abs(y);
  if (across == kInfinity || up == kInfinity || across == up) {
    // Infinite or equal: only the ratio matters. (0, 0) lies on the x axis.
    across = across >= up ? 1 : 0;
    up = up >= std::abs(x) && up > 0 ? 1 : 0;
  }
  const double larger = std::max(across, up), smaller = std::min(across, up);
  double angle;
  if (smaller < larger * 0x1p-60) {
    const bool steep = up > across;
    angle = steep ? kHalfPi.hi : std::signbit(x) ? kPi.hi : up / across;
  } else {
    // Scale to where products are exact.
    const double scale = larger > 1 ? 0x1p-500 : larger < 0x1p-400 ? 0x1p500 : 1;
    const Pair unit{larger * scale};
    const Pair c = Pair{across * scale} / unit;
    angle = rounded(angle_of(Pair{up * scale} / unit, std::signbit(x) ? -c : c));
  }
  return std::copysign(angle, y);
}

double exp(double x) {
  return std::isnan(x) ? x : exp_pair({x});
}
double log(double x) {
  if (const double odd = odd_log(x); odd != 0) return odd;
  return rounded(log_pair(x));
}
double log1p(double x) {
  const Pair one_more = sum(1, x);
  if (const double odd = odd_log(one_more.hi); odd != 0) return odd;
  if (std::abs(x) < 0x1p-54) return x;
  return rounded(log_pair(one_more.hi) + Pair{one_more.lo / one_more.hi});
}
double log2(double x) {
  if (const double odd = odd_log(x); odd != 0) return odd;
  constexpr Pair kPerLog2{0x1.71547652b82fep+0, 0x1.777d0ffda0d24p-56};
  return rounded(log_pair(x) * kPerLog2);
}
double log10(double x) {
  if (const double odd = odd_log(x); odd != 0) return odd;
  constexpr Pair kPerLog10{0x1.bcb7b1526e50ep-2, 0x1.95355baaafad3p-57};
  return rounded(log_pair(x) * kPerLog10);
}

double pow(double x, double y) {
  if (x == 1 || y == 0) return 1;
  if (std::isnan(x) || std::isnan(y)) return kNan;
  const double size = std::abs(x);
  const bool negative = std::signbit(x) && is_odd(y);
  double power;
  if (size == 0 || size == kInfinity || std::abs(y) > 0x1p70) {
    // The result is 0 or infinite, or 1 if x is −1.
    power = size == 1 ? 1 : (size > 1) == (y > 0) ? kInfinity : 0;
  } else {
    if (x < 0 && !is_integer(y)) return kNan;
    power = exp_pair(log_pair(size) * Pair{y});
  }
  return negative ? -power : power;
}
double cbrt(double x) {
  const double size = std::abs(x);
  if (!(size > 0 && size < kInfinity)) return x;
  return std::copysign(exp_pair(log_pair(size) / Pair{3}), x);
}

}  // namespace rastrum::elementary
