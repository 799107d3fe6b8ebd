// SPDX-License-Identifier: BSD-3-Clause
#include "resolution.hpp"

#include <algorithm>

namespace rastrum::cli::window {
namespace {

double pixels(std::size_t step) {
  return kScales[step] * kScales[step];  // of the full picture
}

}  // namespace

void Resolution::add(std::size_t step, double ms) {
  if (ms_[newest_] && newest_ != step) other_ = newest_;
  // Averages with the past, so that one slow frame of a busy machine does not change the size.
  ms_[step] = ms_[step] ? (*ms_[step] + ms) / 2 : ms;
  newest_ = step;
}

void Resolution::forget() {
  ms_ = {};
  other_.reset();
}

double Resolution::expected_ms(std::size_t step) const {
  if (!ms_[newest_]) return 0;
  const double ms = *ms_[newest_];
  double rate = ms / pixels(newest_);
  if (other_) {
    const double slope = (ms - *ms_[*other_]) / (pixels(newest_) - pixels(*other_));
    rate = std::clamp(slope, 0.0, rate);
  }
  return std::max(ms + rate * (pixels(step) - pixels(newest_)), 0.0);
}

std::size_t Resolution::moving_step() const {
  constexpr double kWorth = 1.25;
  // One size does not tell pixels from triangles; the next one does.
  const bool one = ms_[newest_] && !other_;
  if (one && newest_ > 0 && expected_ms(0) > target_ms_) return newest_ - 1;
  const double most = std::max(target_ms_, kWorth * expected_ms(kScales.size() - 1));
  for (std::size_t step = 0; step < kScales.size(); ++step)
    if (expected_ms(step) <= most) return step;
  return kScales.size() - 1;
}

std::size_t Resolution::still_step(std::size_t last) const {
  constexpr double kLong = 1000;  // ms
  constexpr std::size_t kHalf = 2;
  // A step of twice the side first, if the full picture takes long.
  if (last > kHalf && expected_ms(0) > kLong) return last - kHalf;
  return 0;
}

}  // namespace rastrum::cli::window
