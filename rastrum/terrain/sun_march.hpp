// SPDX-License-Identifier: BSD-3-Clause
// Shadows of a terrain that is a function, by samples along the way to the sun (paper 3's
// generate_shadowmap with a function).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include <rastrum/core/elementary.hpp>
#include <rastrum/terrain/function_light.hpp>
#include <rastrum/terrain_light.hpp>

namespace rastrum::terrain {

class SunMarch {
 public:
  SunMarch() = default;
  SunMarch(const Sun& sun, const March& march) {
    const auto azimuth = elementary::sin_cos(sun.azimuth_deg * (std::numbers::pi / 180));
    const auto elevation = elementary::sin_cos(sun.elevation_deg * (std::numbers::pi / 180));
    for (int k = 1; k < march.steps; ++k) {
      const double t = march.distance * k / march.steps;
      steps_.push_back(
          {t * azimuth.sin * elevation.cos, -t * azimuth.cos * elevation.cos, t * elevation.sin});
    }
  }

  [[nodiscard]] std::span<const FunctionStep> steps() const { return steps_; }

  /// How many samples hide the sun; with `one_is_enough` it may stop at one.
  [[nodiscard]] int hidden(const HeightFunction& function, double x, double y, float own,
                           bool one_is_enough) const {
    constexpr std::size_t kBatch = 64;
    std::array<double, kBatch> xs{}, ys{};
    std::array<float, kBatch> h{};
    int hidden = 0;
    for (std::size_t at = 0; at < steps_.size(); at += kBatch) {
      const std::size_t n = std::min(kBatch, steps_.size() - at);
      for (std::size_t k = 0; k < n; ++k) {
        xs[k] = x + steps_[at + k].x;
        ys[k] = y + steps_[at + k].y;
      }
      function(xs.data(), ys.data(), n, h.data());
      for (std::size_t k = 0; k < n; ++k)
        hidden += FunctionLight::hides(h[k], own, steps_[at + k]) ? 1 : 0;
      if (one_is_enough && hidden != 0) break;
    }
    return hidden;
  }

 private:
  std::vector<FunctionStep> steps_;
};

}  // namespace rastrum::terrain
