// SPDX-License-Identifier: BSD-3-Clause
#include "key_curve.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace rastrum::cli {
namespace {

/// `before` and `after`: lengths of the segments beside the key; `slope_…`: their slopes.
double velocity(double before, double after, double slope_before, double slope_after,
                Tangent tangent) {
  if (tangent == Tangent::curve)
    return (after * slope_before + before * slope_after) / (before + after);
  if (slope_before * slope_after <= 0) return 0;
  const double a = 2 * after + before, b = after + 2 * before;
  return (a + b) / (a / slope_before + b / slope_after);
}

}  // namespace

KeyCurve::KeyCurve(std::span<const double> times, std::vector<double> values,
                   Interpolation interpolation, Tangent tangent)
    : times_(times.begin(), times.end()), values_(std::move(values)) {
  assert(!times_.empty() && times_.size() == values_.size());
  const std::size_t n = times_.size();
  if (interpolation == Interpolation::linear || n < 2) return;
  const auto length = [&](std::size_t i) { return times_[i + 1] - times_[i]; };
  const auto slope = [&](std::size_t i) { return (values_[i + 1] - values_[i]) / length(i); };
  velocities_.resize(n);
  velocities_.front() = slope(0);
  velocities_.back() = slope(n - 2);
  for (std::size_t i = 1; i + 1 < n; ++i)
    velocities_[i] = velocity(length(i - 1), length(i), slope(i - 1), slope(i), tangent);
}

double KeyCurve::at(double time) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), time);
  if (after == times_.begin()) return values_.front();
  if (after == times_.end()) return values_.back();
  const auto i = static_cast<std::size_t>(after - times_.begin()) - 1;
  const double length = times_[i + 1] - times_[i];
  const double u = (time - times_[i]) / length;
  const double a = values_[i], b = values_[i + 1];
  if (velocities_.empty()) return a + (b - a) * u;
  // The straight line, bent by the velocities; the bend is 0 at both keys.
  const double slope = (b - a) / length;
  const double bend = (velocities_[i] - slope) * (1 - u) - (velocities_[i + 1] - slope) * u;
  return a + (b - a) * u + bend * u * (1 - u) * length;
}

}  // namespace rastrum::cli
