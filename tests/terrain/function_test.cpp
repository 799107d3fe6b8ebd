// SPDX-License-Identifier: BSD-3-Clause
// Function terrains: their ranges, their bits, expressions and shadows by the march.
#include <cmath>
#include <cstring>
#include <numbers>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/terrain/color_map.hpp>
#include <rastrum/terrain_light.hpp>

#include "tests/support/random.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::terrain::function_test {
namespace {

float at(const HeightFunction& f, double x, double y) {
  float h = 0;
  f(&x, &y, 1, &h);
  return h;
}

TEST(NamedFunctions, StayInTheirRangeAndReachIt) {
  for (const FunctionInfo& info : named_functions()) {
    const HeightFunction f = named_function(info.name);
    test::Random random(3);
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < 200000; ++i) {
      const double h =
          static_cast<double>(at(f, random.real(-3000, 3000), random.real(-3000, 3000)));
      low = std::fmin(low, h);
      high = std::fmax(high, h);
    }
    EXPECT_GE(low, info.low) << info.name;
    EXPECT_LE(high, info.high) << info.name;
    EXPECT_GT(high - low, (info.high - info.low) / 2) << info.name;
    EXPECT_TRUE(std::isfinite(at(f, 1e300, -1e300))) << info.name;
  }
  EXPECT_THROW((void)named_function("hills"), Error);
}

TEST(NamedFunctions, AreWhatTheySay) {
  const HeightFunction c = named_function("cosines"), e = named_function("expo");
  const double tau = 2 * std::numbers::pi;
  for (int i = 0; i < 1000; ++i) {
    const double x = i * 1.7 - 800, y = i * 0.9 + 3;
    EXPECT_NEAR(at(c, x, y), 50 + 50 * std::cos(tau * x / 256) * std::sin(tau * y / 256), 1e-4);
    const double r2 = (x - 512) * (x - 512) + (y - 512) * (y - 512);
    EXPECT_NEAR(at(e, x, y), 140 * std::exp(-r2 / (150 * 150)), 1e-4);
  }
}

/// The same bits on every machine: a hash of samples.
TEST(NamedFunctions, HaveTheseBits) {
  std::uint64_t hash = 0xCBF29CE484222325U;
  for (const FunctionInfo& info : named_functions()) {
    const HeightFunction f = named_function(info.name);
    for (int i = 0; i < 1000; ++i) {
      const float h = at(f, i * 1.3 - 333, i * 2.1 - 777);
      std::uint32_t bits = 0;
      std::memcpy(&bits, &h, sizeof bits);
      hash = (hash ^ bits) * 0x100000001B3U;
    }
  }
  EXPECT_EQ(hash, 0x79632D693E493250U) << std::hex << hash;
}

TEST(Expressions, AreEvaluatedOnManyThreads) {
  HeightFunction f;
  try {
    f = expression_function("40*sin(x/30)*cos(y/50)+x^2/1000");
  } catch (const Error& e) {
    ASSERT_EQ(e.code(), Errc::unsupported) << e.what();
    EXPECT_TRUE(test::holds(e.what(), "libmuparser-dev"));
    GTEST_SKIP() << e.what();
  }
  std::vector<std::thread> threads;
  std::vector<int> wrong(4);
  for (std::size_t t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 5000; ++i) {
        const double x = i * 0.37, y = i * static_cast<double>(t);
        const double expected = 40 * std::sin(x / 30) * std::cos(y / 50) + x * x / 1000;
        wrong[t] += std::abs(static_cast<double>(at(f, x, y)) - expected) > 1e-3;
      }
    });
  for (std::thread& t : threads) t.join();
  for (const int w : wrong) EXPECT_EQ(w, 0);
  EXPECT_EQ(at(expression_function("1e300*x"), 2, 0), INFINITY);
  for (const char* bad : {"sin(x", "x +", "z*2", "", "1, 2", "x = 3 +"}) {
    test::expect_refused(bad, [&] { (void)expression_function(bad); });
  }
}

TEST(FunctionTerrain, ColoursAndShadowsByTheMarch) {
  // A wall from x = 100 to 104, 50 high; the sun in the east at 45°.
  const HeightFunction wall = [](const double* x, const double*, std::size_t n, float* out) {
    for (std::size_t i = 0; i < n; ++i) out[i] = x[i] >= 100 && x[i] < 104 ? 50.0F : 0.0F;
  };
  const Light light{.sun = {90, 45}, .shadows = Shadows::sharp, .ambient = 0.5F};
  const Terrain terrain = function_terrain(wall, 0, 50, light);
  ASSERT_FALSE(terrain.is_map());
  const auto color = [&](double x) {
    const double y = 7;
    Rgba8 c;
    terrain.surface().colors(&x, &y, 1, &c);
    return c;
  };
  const Rgba8 ground = height_color(0);
  EXPECT_EQ(color(120), ground);
  EXPECT_EQ(color(102), height_color(1));
  EXPECT_EQ(color(30), ground) << "50 high: beyond 50 cells it is light again";
  EXPECT_EQ(color(80).g, (ground.g + 1) / 2);
}

TEST(SampledRange, IgnoresWhatIsNotFinite) {
  const HeightFunction f = [](const double* x, const double*, std::size_t n, float* out) {
    for (std::size_t i = 0; i < n; ++i) out[i] = x[i] < 500 ? NAN : static_cast<float>(x[i]);
  };
  EXPECT_EQ(sampled_range(f).low, 504);
  EXPECT_EQ(sampled_range(f).high, 1016);
}

}  // namespace
}  // namespace rastrum::terrain::function_test
