// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/terrain_light.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/number_text.hpp>
#include <rastrum/error.hpp>
#include <rastrum/terrain/function_values.hpp>

namespace rastrum::terrain {
namespace {

constexpr std::array<FunctionInfo, 6> kNamed{{
    {"cosines", "cos x · sin y (paper 3, figure 6.1), 256 cells a wave", 0, 100},
    {"squares", "a chessboard of high and low squares of 64 cells", 5, 40},
    {"expo", "one hump exp(-r²) at (512, 512)", 0, 140},
    {"expo2", "humps of two heights, 256 cells apart", 0, 90},
    {"wavy", "waves across waves", 0, 80},
    {"noise", "fractal noise of 8 octaves", 0, 160},
}};

}  // namespace

const std::vector<FunctionInfo>& named_functions() {
  static const std::vector<FunctionInfo> infos(kNamed.begin(), kNamed.end());
  return infos;
}

HeightFunction named_function(std::string_view name) {
  std::string known;
  for (std::size_t i = 0; i < kNamed.size(); ++i) {
    if (kNamed[i].name == name) return NamedHeights{static_cast<NamedFunction>(i)};
    known.append(known.empty() ? "" : ", ").append(kNamed[i].name);
  }
  throw Error(Errc::not_found,
              text_of("there is no terrain function '", name, "'; there are ", known));
}

HeightRange sampled_range(const HeightFunction& function) {
  const FloatScope floats;
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
