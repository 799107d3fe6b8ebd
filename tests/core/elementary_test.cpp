// SPDX-License-Identifier: BSD-3-Clause
// The elementary functions beside long double's, whose 64 bits (113 on ARM) show errors of float64
// to 0.001 ulp: 10⁵ arguments per function, in its usual range and everywhere.
#include <rastrum/core/elementary.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/core/angle.hpp>

#include "tests/support/random.hpp"

namespace rastrum::test::elementary_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kArguments = 100000;

/// The error in units in the last place of the nearest float64.
double error_ulp(double value, long double exact) {
  const auto nearest = static_cast<double>(exact);
  if (value == nearest && std::isinf(value)) return 0;
  const double ulp = std::ldexp(1.0, std::max(std::ilogb(nearest), -1022) - 52);
  return static_cast<double>(std::abs(static_cast<long double>(value) - exact)) / ulp;
}

struct Range {
  double low, high;
};

/// Any finite number, with all exponents equally likely.
double any(Random& random) {
  for (;;) {
    if (const auto x = std::bit_cast<double>(random.bits()); std::isfinite(x)) return x;
  }
}

struct Function {
  const char* name;
  double (*own)(double);
  long double (*exact)(long double);
  double (*libm)(double);
};
const Function kSin{"sin", elementary::sin, std::sin, std::sin},
    kCos{"cos", elementary::cos, std::cos, std::cos},
    kTan{"tan", elementary::tan, std::tan, std::tan},
    kAtan{"atan", elementary::atan, std::atan, std::atan},
    kAsin{"asin", elementary::asin, std::asin, std::asin},
    kAcos{"acos", elementary::acos, std::acos, std::acos},
    kExp{"exp", elementary::exp, std::exp, std::exp},
    kLog{"log", elementary::log, std::log, std::log},
    kLog1p{"log1p", elementary::log1p, std::log1p, std::log1p},
    kLog2{"log2", elementary::log2, std::log2, std::log2},
    kLog10{"log10", elementary::log10, std::log10, std::log10},
    kCbrt{"cbrt", elementary::cbrt, std::cbrt, std::cbrt};

template <class Draw>
double worst(const Draw& draw, const Function& f) {
  Random random(5);
  double most = 0;
  for (int i = 0; i < kArguments; ++i) {
    const double x = draw(random);
    const double error = error_ulp(f.own(x), f.exact(static_cast<long double>(x)));
    if (!(error <= most)) most = error;
  }
  return most;
}

TEST(Elementary, IsFaithfulWhereItIsUsed) {
  const struct {
    std::vector<Function> functions;
    std::vector<Range> ranges;
    double bound = 0.53;
  } kUses[] = {{{kSin, kCos, kTan, kAtan}, {{-7, 7}, {-1e6, 1e6}, {-1e-6, 1e-6}}},
               {{kAsin, kAcos, kLog1p}, {{-1, 1}, {0.999, 1}, {-1e-4, 1e-4}}},
               {{kExp}, {{-700, 709}, {-1, 1}}},
               {{kExp}, {{-745, -708}}, 1.01},
               {{kLog, kLog2, kLog10, kCbrt}, {{0, 10}, {0.9, 1.1}, {0, 1e300}}}};
  for (const auto& [functions, ranges, bound] : kUses)
    for (const Function& f : functions)
      for (const Range range : ranges)
        EXPECT_LT(worst([&](Random& r) { return r.real(range.low, range.high); }, f), bound)
            << f.name << " in [" << range.low << ", " << range.high << "]";
}

TEST(Elementary, IsFaithfulEverywhere) {
  // Sines of large arguments: long double's are accurate up to 2^63.
  const auto far = [](Random& r) { return std::ldexp(r.real(-1, 1), r.integer(0, 62)); };
  for (const Function& f : {kSin, kCos}) EXPECT_LT(worst(far, f), 0.53) << f.name;
  for (const Function& f : {kAtan, kCbrt}) EXPECT_LT(worst(any, f), 0.53) << f.name;
  EXPECT_LT(worst([](Random& r) { return std::abs(any(r)); }, kLog), 0.53);
  // Beyond: the doubles nearest to multiples of π/2 (Muller, Elementary Functions, 11.2).
  EXPECT_EQ(elementary::cos(0x1.6ac5b262ca1ffp849), -0x1.14ae72e6ba22fp-61);
  EXPECT_EQ(elementary::sin(0x1.fffffffffffffp1023), 0x1.452fc98b34e97p-8);
  double most = 0;
  for (int k = 1; k < kArguments; ++k) {
    const double x = k * (std::numbers::pi / 2);
    const auto wide = static_cast<long double>(x);
    most = std::max(most, std::min(error_ulp(elementary::sin(x), std::sin(wide)),
                                   error_ulp(elementary::cos(x), std::cos(wide))));
  }
  EXPECT_LT(most, 0.53);
}

TEST(Elementary, PowersAndAngles) {
  Random random(9);
  for (int i = 0; i < kArguments; ++i) {
    const double x = random.real(0, 3), y = random.real(-30, 30);
    ASSERT_LT(error_ulp(elementary::pow(x, y), std::pow(static_cast<long double>(x), y)), 0.54)
        << x << " to " << y;
    const double a = random.real(-2, 2), b = std::ldexp(random.real(-2, 2), random.integer(0, 90));
    ASSERT_LT(error_ulp(elementary::atan2(a, b), std::atan2(static_cast<long double>(a), b)), 0.53)
        << a << " over " << b;
    ASSERT_LT(error_ulp(elementary::atan2(b, a), std::atan2(static_cast<long double>(b), a)), 0.53)
        << b << " over " << a;
  }
  for (int base = 1; base < 30; ++base) {
    double power = 1;
    for (int n = 0; n < 10; ++n, power *= base) EXPECT_EQ(elementary::pow(base, n), power);
  }
}

/// Special values follow the C standard's annex F.
TEST(Elementary, OddArgumentsAreThoseOfIeee) {
  const auto same = [](double a, double b) {
    return std::isnan(a) ? std::isnan(b)
                         : std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double odd[] = {0.0, -0.0, 1,     -1,     2,      -2,        0.5,       -0.5,
                        3,   nan,  1e300, -1e300, 5e-324, kInfinity, -kInfinity};
  for (const double x : odd) {
    for (const Function& f : {kSin, kCos, kTan, kAtan, kAsin, kAcos, kExp, kLog, kLog1p, kLog2}) {
      const double own = f.own(x), libm = f.libm(x);
      const bool edge = !std::isfinite(libm) || libm == 0 || !std::isfinite(x);
      EXPECT_TRUE(edge ? same(own, libm) : std::abs(own - libm) <= 1e-15 * std::abs(libm))
          << f.name << "(" << x << ") is " << own << ", not " << libm;
    }
    for (const double y : odd) {
      EXPECT_TRUE(same(elementary::pow(x, y), std::pow(x, y)))
          << "pow(" << x << ", " << y << ") is " << elementary::pow(x, y) << ", not "
          << std::pow(x, y);
      EXPECT_TRUE(same(elementary::atan2(x, y), std::atan2(x, y)))
          << "atan2(" << x << ", " << y << ") is " << elementary::atan2(x, y) << ", not "
          << std::atan2(x, y);
    }
  }
}

TEST(Elementary, QuartersOfATurnAreExact) {
  for (const double turn : {0.0, 360.0, -720.0, 360e9}) {
    for (const auto& [by, sine, cosine] :
         {std::array{0, 0, 1}, {90, 1, 0}, {180, 0, -1}, {-90, -1, 0}}) {
      EXPECT_EQ(sin_cos_degrees(turn + by).sin, sine) << turn + by;
      EXPECT_EQ(sin_cos_degrees(turn + by).cos, cosine) << turn + by;
    }
  }
  for (double d = -400; d < 400; d += 0.37) {
    const long double rad = d * std::numbers::pi_v<long double> / 180;
    EXPECT_NEAR(sin_cos_degrees(d).sin, static_cast<double>(std::sin(rad)), 4e-16) << d;
    EXPECT_NEAR(sin_cos_degrees(d).cos, static_cast<double>(std::cos(rad)), 4e-16) << d;
  }
}

}  // namespace
}  // namespace rastrum::test::elementary_test
