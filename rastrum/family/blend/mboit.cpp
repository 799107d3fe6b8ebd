// Moment-based transparency (Münstermann et al., I3D 2018): a first pass sums power moments of the
// absorbance −ln(1 − α) over depth, a second weights each fragment with the transmittance at its
// depth that the moments imply. With 2 n power moments this is the truncated Hamburger moment
// problem (Peters and Klein, "Moment Shadow Mapping", 2015): the measure with these moments that
// puts mass at depth z and at n other depths, the roots of the kernel polynomial; the absorbance in
// front of z is the mass of those before it, and a quarter of the one at z itself (the paper's
// overestimation).
//
// Deviations: float64 instead of the paper's 32 bits, so that what is seen is the method's error;
// depths are warped logarithmically to [−1, 1] over the range of the block's fragments (a pass of
// its own) rather than of the frame.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include <rastrum/core/elementary.hpp>
#include <rastrum/family/blend/approximations.hpp>
#include <rastrum/raster/setup/piece.hpp>

namespace rastrum::family {
namespace {

using raster::BlockColors;

constexpr double kOverestimation = 0.25;
/// The paper's for 32-bit moments: moves them into the inside of those that a measure can have.
constexpr double kBias4 = 5e-7, kBias6 = 5e-6;

/// Alpha beyond which −ln(1 − α) is cut: the background is then seen through by 10^-6.
constexpr double kMostAlpha = 1 - 1e-6;

/// The real roots of c[0] + c[1] x + c[2] x² = 0, where there are two.
void solve(const std::array<double, 3>& c, std::array<double, 2>& roots) {
  const double p = c[1] / (2 * c[2]), q = c[0] / c[2];
  const double r = std::sqrt(std::max(p * p - q, 0.0));
  roots = {-p - r, -p + r};
}

/// … and of a cubic that has three (Viète).
void solve(const std::array<double, 4>& c, std::array<double, 3>& roots) {
  const double a = c[2] / c[3] / 3, b = c[1] / c[3], d = c[0] / c[3];
  const double p = a * a - b / 3;
  const double q = a * (a * a - b / 2) + d / 2;
  const double r = std::sqrt(std::max(p, 0.0));
  const double angle = elementary::acos(std::clamp(r > 0 ? q / (r * r * r) : 1.0, -1.0, 1.0)) / 3;
  for (int k = 0; k < 3; ++k)
    roots[static_cast<std::size_t>(k)] =
        -2 * r * elementary::cos(angle + 2 * std::numbers::pi * k / 3) - a;
}

/// How much of the absorbance lies before depth z, by `moments` b[0] = 1, b[1] … b[2 n].
template <std::size_t n>
double absorbance_before(const std::array<double, 2 * n + 1>& b, double z) {
  // Cholesky: the Hankel matrix H(i, j) = b[i + j] = L Lᵀ; then H c = (1, z, …, zⁿ).
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

  // Newton's interpolation of the step at z through (z, overestimation) and the roots.
  std::array<double, n + 1> at{z}, f{kOverestimation};
  for (std::size_t i = 0; i < n; ++i) {
    at[i + 1] = roots[i];
    f[i + 1] = roots[i] < z ? 1 : 0;
  }
  for (std::size_t step = 1; step <= n; ++step)
    for (std::size_t i = n; i >= step; --i) {
      const double width = at[i] - at[i - step];
      f[i] = (f[i] - f[i - 1]) / (width != 0 ? width : 1e-30);
    }
  // From Newton's form to powers, whose means are the moments.
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

/// n: half the moments.
template <std::size_t n>
class MomentBased final : public LayerBlend {
 public:
  [[nodiscard]] int passes() const override { return 3; }
  void begin(const BlockColors& behind) override {
    behind_ = &behind;
    nearest_ = 0;
    farthest_ = 1;
    for (auto& pixel : sums_) pixel = {};
    for (auto& pixel : colors_) pixel = {};
  }
  void begin_pass(int pass) override {
    pass_ = pass;
    if (pass == 1) range_ = elementary::log(nearest_ / farthest_);
  }

  std::uint64_t layer(const Layer& l) override {
    for (std::uint64_t m = l.mask; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      const double d = depth(l.keys[i]);
      if (pass_ == 0) {
        nearest_ = std::max(nearest_, d);
        farthest_ = std::min(farthest_, d);
      } else if (pass_ == 1) {
        double term = -elementary::log1p(-std::min<double>(l.colors.a[i], kMostAlpha));
        for (double& sum : sums_[i]) {
          sum += term;
          term *= warped(d);
        }
      } else {
        const double weight = transmittance(sums_[i], warped(d));
        colors_[i][0] += weight * static_cast<double>(l.colors.r[i]);
        colors_[i][1] += weight * static_cast<double>(l.colors.g[i]);
        colors_[i][2] += weight * static_cast<double>(l.colors.b[i]);
        colors_[i][3] += weight * static_cast<double>(l.colors.a[i]);
      }
    }
    return 0;
  }
  void finish(BlockColors& out) override {
    for (int i = 0; i < 64; ++i) {
      const double through = elementary::exp(-sums_[i][0]);
      const double scale = colors_[i][3] > 0 ? (1 - through) / colors_[i][3] : 0.0;
      const auto mix = [&](int c, float behind) {
        return static_cast<float>(colors_[i][static_cast<std::size_t>(c)] * scale +
                                  through * static_cast<double>(behind));
      };
      out.set(i, {mix(0, behind_->r[i]), mix(1, behind_->g[i]), mix(2, behind_->b[i]),
                  static_cast<float>(1 - through * (1 - static_cast<double>(behind_->a[i])))});
    }
  }

 private:
  using Moments = std::array<double, 2 * n + 1>;

  static double depth(std::uint64_t key) {
    const auto d = std::bit_cast<float>(static_cast<std::uint32_t>(key >> raster::kIdBits));
    return std::max(static_cast<double>(d), 1e-30);
  }
  /// −1 near, 1 far.
  [[nodiscard]] double warped(double d) const {
    return range_ > 0 ? 2 * elementary::log(nearest_ / d) / range_ - 1 : 0.0;
  }
  static double transmittance(const Moments& sums, double z) {
    if (!(sums[0] > 0)) return 1;
    // Towards the moments of a measure that is spread out (the paper's supplement, table 1).
    constexpr double kTowards4[5] = {1, 0, 0.375, 0, 0.375};
    constexpr double kTowards6[7] = {1, 0, 0.48, 0, 0.451, 0, 0.45};
    constexpr double kBias = n == 2 ? kBias4 : kBias6;
    Moments b;
    for (std::size_t k = 0; k < b.size(); ++k)
      b[k] = (1 - kBias) * (sums[k] / sums[0]) + kBias * (n == 2 ? kTowards4 : kTowards6)[k];
    return elementary::exp(-sums[0] * absorbance_before<n>(b, z));
  }

  const BlockColors* behind_ = nullptr;
  int pass_ = 0;
  double nearest_ = 0, farthest_ = 1;
  double range_ = 0;  ///< log(nearest_ / farthest_)
  Moments sums_[64];
  std::array<double, 4> colors_[64];
};

}  // namespace

std::unique_ptr<LayerBlend> make_mboit(int moments) {
  if (moments == 4) return std::make_unique<MomentBased<2>>();
  return std::make_unique<MomentBased<3>>();
}

}  // namespace rastrum::family
