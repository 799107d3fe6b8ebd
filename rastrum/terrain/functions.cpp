// The named functions. Sine and exponential are short polynomials of our own: float64 operations in
// one written order, unlike the C library's, which differ from machine to machine.
#include <rastrum/terrain/functions.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <rastrum/core/error.hpp>

namespace rastrum::terrain {
namespace {

/// sin(2π·turns), to about 1e-9.
double sine(double turns) {
  const double whole = std::floor(turns + 0.5);
  double t = turns - whole;  // [-1/2, 1/2)
  if (t > 0.25) t = 0.5 - t;
  if (t < -0.25) t = -0.5 - t;
  const double x = t * 6.283185307179586, x2 = x * x;
  return x * (1 + x2 * (-1.0 / 6 +
                        x2 * (1.0 / 120 +
                              x2 * (-1.0 / 5040 + x2 * (1.0 / 362880 + x2 * (-1.0 / 39916800))))));
}
double cosine(double turns) {
  return sine(turns + 0.25);
}

/// exp(−x) for x ≥ 0: (1 − x/256 + …)^256, to about 1e-7.
double decay(double x) {
  if (!(x < 80)) return 0;
  const double y = x / 256;
  double r = 1 - y * (1 - y / 2 * (1 - y / 3 * (1 - y / 4 * (1 - y / 5))));
  for (int i = 0; i < 8; ++i) r *= r;
  return r;
}

double hump(double dx, double dy, double width) {
  return decay((dx * dx + dy * dy) / (width * width));
}

double cosines(double x, double y) {
  return 50 + 50 * cosine(x / 256) * sine(y / 256);
}
double squares(double x, double y) {
  const double u = std::floor(x / 64), v = std::floor(y / 64);
  const double sum = (u + v) / 2;
  return sum == std::floor(sum) ? 40 : 5;
}
double expo(double x, double y) {
  return 140 * hump(x - 512, y - 512, 150);
}
/// The hump again and again, of two heights.
double expo2(double x, double y) {
  const double u = std::floor(x / 256), v = std::floor(y / 256), odd = (u + v) / 2;
  const double height = odd == std::floor(odd) ? 90 : 50;
  return height * hump(x - u * 256 - 128, y - v * 256 - 128, 60);
}
double wavy(double x, double y) {
  return 40 + 25 * sine(x / 300 + 0.2 * sine(y / 410)) + 15 * sine(y / 130 + 0.3 * sine(x / 220));
}

/// A value in [0, 1) for each corner of the lattice.
double corner(std::int64_t x, std::int64_t y, std::uint64_t octave) {
  std::uint64_t z = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15U +
                    static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FU +
                    octave * 0x165667B19E3779F9U;
  z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9U;
  z = (z ^ z >> 27) * 0x94D049BB133111EBU;
  return static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53;
}
double value_noise(double x, double y, std::uint64_t octave) {
  const double fx = std::floor(x), fy = std::floor(y);
  // Beyond 2⁵² there is no lattice to tell apart.
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
/// Fractal Brownian motion (Musgrave) of value noise: 8 octaves of half the height each.
double noise(double x, double y) {
  double sum = 0, amplitude = 0.5, scale = 1.0 / 256;
  for (std::uint64_t octave = 0; octave < 8; ++octave) {
    sum += amplitude * value_noise(x * scale, y * scale, octave);
    amplitude /= 2;
    scale *= 2;
  }
  return 160 * sum;
}

struct Named {
  FunctionInfo info;
  double (*height)(double x, double y);
};
constexpr std::array<Named, 6> kNamed{{
    {{"cosines", "cos x · sin y (paper 3, figure 6.1), 256 cells a wave", 0, 100}, cosines},
    {{"squares", "a chessboard of high and low squares of 64 cells", 5, 40}, squares},
    {{"expo", "one hump exp(-r²) at (512, 512)", 0, 140}, expo},
    {{"expo2", "humps of two heights, 256 cells apart", 0, 90}, expo2},
    {{"wavy", "waves across waves", 0, 80}, wavy},
    {{"noise", "fractal noise of 8 octaves", 0, 160}, noise},
}};

}  // namespace

const std::vector<FunctionInfo>& named_functions() {
  static const std::vector<FunctionInfo> infos = [] {
    std::vector<FunctionInfo> all;
    for (const Named& n : kNamed) all.push_back(n.info);
    return all;
  }();
  return infos;
}

HeightFunction named_function(std::string_view name) {
  std::string known;
  for (const Named& n : kNamed) {
    if (n.info.name == name)
      return [height = n.height](const double* x, const double* y, std::size_t count, float* out) {
        for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<float>(height(x[i], y[i]));
      };
    known.append(known.empty() ? "" : ", ").append(n.info.name);
  }
  throw Error(Errc::not_found,
              "there is no terrain function '" + std::string(name) + "'; there are " + known);
}

HeightRange sampled_range(const HeightFunction& function) {
  constexpr std::size_t kSide = 128;
  std::array<double, kSide> x{}, y{};
  std::array<float, kSide> h{};
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t row = 0; row < kSide; ++row) {
    for (std::size_t i = 0; i < kSide; ++i) {
      x[i] = static_cast<double>(i) * 8;
      y[i] = static_cast<double>(row) * 8;
    }
    function(x.data(), y.data(), kSide, h.data());
    for (const float v : h) {
      if (!std::isfinite(v)) continue;
      low = std::fmin(low, static_cast<double>(v));
      high = std::fmax(high, static_cast<double>(v));
    }
  }
  return low <= high ? HeightRange{low, high} : HeightRange{};
}

}  // namespace rastrum::terrain
