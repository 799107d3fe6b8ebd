// SPDX-License-Identifier: BSD-3-Clause
// Moment-based transparency: instruction sets, rows and layers have the same bits, which equal the
// paper's formulas in float64 up to float32's rounding.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <vector>

#include <rastrum/family.hpp>

#include "tests/support/random.hpp"

namespace rastrum::test::moments_test {
namespace {

using raster::BlockColors;
using transparency::packed_sort_key;

struct Fragment {
  float depth;
  Vec4 color;
};
/// The fragments of each pixel of a block, in order of submission.
struct Fragments {
  std::array<std::vector<Fragment>, 64> pixels;
  BlockColors behind{};

  [[nodiscard]] std::size_t deepest() const {
    std::size_t most = 0;
    for (const auto& pixel : pixels) most = std::max(most, pixel.size());
    return most;
  }
};

/// Up to `most` layers a pixel, at depths from 0.5 down by `spread`. With a `gap` they are in two
/// bunches, each this part of the range.
Fragments random_fragments(std::uint64_t seed, int most, double spread, double gap = 0) {
  Random random(seed);
  Fragments all;
  const auto channel = [&] { return static_cast<float>(random.real(0, 1)); };
  for (int i = 0; i < 64; ++i) {
    const float behind = random.integer(0, 2) == 0 ? 0.0F : channel();
    all.behind.set(i, {behind * channel(), behind * channel(), behind * channel(), behind});
    auto& pixel = all.pixels[static_cast<std::size_t>(i)];
    for (int k = random.integer(0, most); k > 0; --k) {
      const float a = 0.02F + 0.97F * channel();
      const double place = random.real(0, 1);
      pixel.push_back({static_cast<float>(0.5 - spread * (gap == 0     ? place
                                                          : k % 2 == 0 ? 0.3 + gap * place
                                                                       : 0.8 + gap * place)),
                       {a * channel(), a * channel(), a * channel(), a}});
    }
  }
  return all;
}

std::uint64_t sort_key(float depth, std::size_t number) {
  return packed_sort_key(std::uint64_t{std::bit_cast<std::uint32_t>(depth)} << raster::kIdBits,
                         number);
}

BlockColors by_layers(const Fragments& all, const TransparencyOptions& method, Isa isa) {
  const auto blend = transparency::make_blend(method, isa);
  blend->begin(all.behind);
  for (int pass = 0; pass < blend->passes(); ++pass) {
    blend->begin_pass(pass);
    for (std::size_t k = 0; k < all.deepest(); ++k) {
      std::array<std::uint64_t, 64> keys{};
      BlockColors colors;
      std::uint64_t mask = 0;
      for (std::size_t i = 0; i < 64; ++i) {
        // A pixel without a fragment has any values.
        constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
        colors.set(static_cast<int>(i), {kNan, kNan, kNan, i % 2 == 0 ? kNan : 0.7F});
        keys[i] = ~std::uint64_t{0} >> i % 7;
        if (k >= all.pixels[i].size()) continue;
        keys[i] = sort_key(all.pixels[i][k].depth, k);
        colors.set(static_cast<int>(i), all.pixels[i][k].color);
        mask |= std::uint64_t{1} << i;
      }
      blend->layer({keys.data(), mask, colors});
    }
  }
  BlockColors out;
  blend->finish(out);
  return out;
}

BlockColors by_rows(const Fragments& all, const TransparencyOptions& method, Isa isa) {
  std::vector<Vec4> colors(1);
  std::array<std::vector<std::uint64_t>, 8> keys;
  for (std::size_t row = 0; row < 8; ++row) {
    std::size_t layers = 0;
    for (std::size_t x = 0; x < 8; ++x) layers = std::max(layers, all.pixels[row * 8 + x].size());
    keys[row].assign(layers * 8, 0);
    for (std::size_t x = 0; x < 8; ++x)
      for (std::size_t k = 0; k < all.pixels[row * 8 + x].size(); ++k) {
        const Fragment& f = all.pixels[row * 8 + x][k];
        keys[row][k * 8 + x] = sort_key(f.depth, colors.size() - 1);
        colors.push_back(f.color);
      }
  }
  const auto blend = transparency::make_blend(method, isa);
  blend->begin(all.behind);
  for (int pass = 0; pass < blend->passes(); ++pass) {
    blend->begin_pass(pass);
    for (std::size_t row = 0; row < 8; ++row)
      EXPECT_TRUE(blend->row({keys[row].data(), keys[row].size() / 8, colors.data()}, row * 8));
  }
  BlockColors out;
  blend->finish(out);
  return out;
}

/// Red of a pixel, blended in order.
double exact(std::vector<Fragment> pixel, float behind) {
  std::ranges::stable_sort(pixel, std::ranges::greater(), &Fragment::depth);
  double red = 0, through = 1;
  for (const Fragment& f : pixel) {
    red += through * static_cast<double>(f.color.x);
    through *= 1 - static_cast<double>(f.color.w);
  }
  return red + through * static_cast<double>(behind);
}

bool same(const BlockColors& a, const BlockColors& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

const TransparencyOptions kMethods[] = {family::wboit(), family::mlab4(), family::mboit4(),
                                        family::mboit6()};

TEST(Approximations, FourLayersStayInOrderAtEqualDepths) {
  Fragments all = random_fragments(5, 4, 0.4);
  for (auto& pixel : all.pixels)
    for (std::size_t k = 0; k < pixel.size(); ++k) pixel[k].depth = k == 2 ? 0.5F : 0.25F;
  for (const Isa isa : available_isas()) {
    const BlockColors actual = by_rows(all, family::mlab4(), isa);
    for (std::size_t i = 0; i < 64; ++i) {
      const int at = static_cast<int>(i);
      EXPECT_NEAR(static_cast<double>(actual.r[at]), exact(all.pixels[i], all.behind.r[at]), 1e-6);
    }
  }
}

TEST(Approximations, RowsAndLayersHaveTheSameBitsOnEveryInstructionSet) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Fragments all =
        random_fragments(seed, static_cast<int>(seed % 20), seed % 3 == 0 ? 1e-6 : 0.49);
    // Adds fragments at infinity, opaque ones and fully transparent ones.
    if (seed % 4 == 1 && !all.pixels[9].empty()) all.pixels[9][0].depth = 0;
    if (seed % 4 == 2)
      for (auto& pixel : all.pixels)
        if (!pixel.empty()) pixel[0].color.w = pixel.size() % 2 == 0 ? 1 : 0;
    for (const TransparencyOptions& method : kMethods) {
      const BlockColors expected = by_layers(all, method, Isa::scalar);
      for (int i = 0; i < 64; ++i) EXPECT_TRUE(std::isfinite(expected.r[i])) << seed;
      for (const Isa isa : available_isas()) {
        EXPECT_TRUE(same(by_layers(all, method, isa), expected)) << seed << ", " << name(isa);
        EXPECT_TRUE(same(by_rows(all, method, isa), expected)) << seed << ", " << name(isa);
      }
    }
  }
}

/// Roots of c[0] + c[1] x + … of degree 2, then 3 (Viète).
void solve(const std::array<double, 3>& c, std::array<double, 2>& roots) {
  const double p = c[1] / (2 * c[2]), r = std::sqrt(std::max(p * p - c[0] / c[2], 0.0));
  roots = {-p - r, -p + r};
}
void solve(const std::array<double, 4>& c, std::array<double, 3>& roots) {
  const double a = c[2] / c[3] / 3, b = c[1] / c[3], d = c[0] / c[3];
  const double r = std::sqrt(std::max(a * a - b / 3, 0.0));
  const double q = a * (a * a - b / 2) + d / 2;
  const double angle = std::acos(std::clamp(r > 0 ? q / (r * r * r) : 1.0, -1.0, 1.0)) / 3;
  for (std::size_t k = 0; k < 3; ++k)
    roots[k] = -2 * r * std::cos(angle + 2 * std::numbers::pi * static_cast<double>(k) / 3) - a;
}

/// Cholesky's H = L Lᵀ of the Hankel matrix, H c = (1, z, …), the roots of c, and Newton's
/// interpolation through them of the step at z with value a quarter.
template <std::size_t n>
double absorbance_before(const std::array<double, 2 * n + 1>& b, double z) {
  std::array<std::array<double, n + 1>, n + 1> l{};
  std::array<double, n + 1> c{};
  double power = 1;
  for (std::size_t i = 0; i <= n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = b[i + j];
      for (std::size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      l[i][j] = i == j ? std::sqrt(std::max(sum, 1e-30)) : sum / l[j][j];
    }
    double sum = power;
    for (std::size_t k = 0; k < i; ++k) sum -= l[i][k] * c[k];
    c[i] = sum / l[i][i];
    power *= z;
  }
  for (std::size_t i = n + 1; i-- > 0;) {
    for (std::size_t k = i + 1; k <= n; ++k) c[i] -= l[k][i] * c[k];
    c[i] /= l[i][i];
  }
  std::array<double, n> roots{};
  solve(c, roots);
  std::array<double, n + 1> at{z}, f{0.25};
  for (std::size_t i = 0; i < n; ++i) {
    at[i + 1] = roots[i];
    f[i + 1] = roots[i] < z ? 1 : 0;
  }
  for (std::size_t step = 1; step <= n; ++step)
    for (std::size_t i = n; i >= step; --i) {
      const double width = at[i] - at[i - step];
      f[i] = (f[i] - f[i - 1]) / (width != 0 ? width : 1e-30);
    }
  std::array<double, n + 1> polynomial{};
  polynomial[0] = f[n];
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = n - i; k > 0; --k)
      polynomial[k] = polynomial[k - 1] - at[i] * polynomial[k];
    polynomial[0] = f[i] - at[i] * polynomial[0];
  }
  double mean = 0;
  for (std::size_t i = 0; i <= n; ++i) mean += polynomial[i] * b[i];
  return std::isfinite(mean) ? std::clamp(mean, 0.0, 1.0) : 1.0;
}

/// Red and alpha of each pixel.
template <std::size_t n>
std::array<std::array<double, 2>, 64> in_float64(const Fragments& all) {
  constexpr double kBias = n == 2 ? 5e-7 : 5e-6;
  constexpr double kTowards[2][7] = {{1, 0, 0.375, 0, 0.375}, {1, 0, 0.48, 0, 0.451, 0, 0.45}};
  double nearest = 0, farthest = 1;
  for (const auto& pixel : all.pixels)
    for (const Fragment& f : pixel) {
      nearest = std::max(nearest, static_cast<double>(f.depth));
      farthest = std::min(farthest, static_cast<double>(f.depth));
    }
  const double range = std::log(nearest / farthest);
  const auto warped = [&](float d) {
    return range > 0 ? 2 * std::log(nearest / static_cast<double>(d)) / range - 1 : 0;
  };
  std::array<std::array<double, 2>, 64> out{};
  for (std::size_t i = 0; i < 64; ++i) {
    std::array<double, 2 * n + 1> sums{};
    for (const Fragment& f : all.pixels[i]) {
      double term = -std::log1p(-std::min(static_cast<double>(f.color.w), 1 - 1e-6));
      for (double& sum : sums) {
        sum += term;
        term *= warped(f.depth);
      }
    }
    std::array<double, 2 * n + 1> b{};
    for (std::size_t k = 0; k < b.size(); ++k)
      b[k] = (1 - kBias) * (sums[0] > 0 ? sums[k] / sums[0] : 0) + kBias * kTowards[n - 2][k];
    double red = 0, alpha = 0;
    for (const Fragment& f : all.pixels[i]) {
      const double weight = std::exp(-sums[0] * absorbance_before<n>(b, warped(f.depth)));
      red += weight * static_cast<double>(f.color.x);
      alpha += weight * static_cast<double>(f.color.w);
    }
    const double through = std::exp(-sums[0]);
    const int at = static_cast<int>(i);
    out[i] = {(alpha > 0 ? red * (1 - through) / alpha : 0) +
                  through * static_cast<double>(all.behind.r[at]),
              1 - through * (1 - static_cast<double>(all.behind.a[at]))};
  }
  return out;
}

// float32's moments cannot separate bunches in a small part of a block's range. There the method
// itself is off by some hundredths, and float32 must not add a decibel.
TEST(Moments, AreThePapersInFloat64) {
  struct Case {
    int layers;
    double spread, gap;
    double off[2];  ///< greatest root mean square difference from float64, of 4 and 6 moments
  };
  for (const Case& c : {Case{2, 0.4, 0, {4e-5, 4e-5}}, Case{3, 0.4, 0, {1e-4, 1e-4}},
                        Case{6, 0.4, 0, {2e-4, 2e-4}}, Case{20, 0.4, 0, {1e-4, 1e-4}},
                        Case{6, 1e-3, 0, {3e-4, 1e-4}}, Case{6, 0.4, 1e-2, {3e-4, 4e-3}},
                        Case{6, 0.4, 1e-3, {3e-3, 2e-2}}, Case{6, 0.4, 1e-4, {4e-3, 4e-2}}})
    for (const TransparencyOptions& method : {family::mboit4(), family::mboit6()}) {
      const bool four = method == family::mboit4();
      double off = 0, error = 0, error_in_float64 = 0;
      for (std::uint64_t seed = 100; seed < 140; ++seed) {
        const Fragments all = random_fragments(seed, c.layers, c.spread, c.gap);
        const BlockColors actual = by_rows(all, method, available_isas().back());
        const auto expected = four ? in_float64<2>(all) : in_float64<3>(all);
        for (std::size_t i = 0; i < 64; ++i) {
          const int at = static_cast<int>(i);
          const double red = static_cast<double>(actual.r[at]);
          const double right = exact(all.pixels[i], all.behind.r[at]);
          EXPECT_NEAR(static_cast<double>(actual.a[at]), expected[i][1], 1e-6);
          off += (red - expected[i][0]) * (red - expected[i][0]);
          error += (red - right) * (red - right);
          error_in_float64 += (expected[i][0] - right) * (expected[i][0] - right);
        }
      }
      const auto where = [&] {
        return std::to_string(c.layers) + " layers over " + std::to_string(c.spread) + ", gap " +
               std::to_string(c.gap) + (four ? ", 4" : ", 6");
      };
      EXPECT_LT(std::sqrt(off / (40 * 64)), c.off[four ? 0 : 1]) << where();
      EXPECT_LT(10 * std::log10(error / error_in_float64), 1) << where();
    }
}

}  // namespace
}  // namespace rastrum::test::moments_test
