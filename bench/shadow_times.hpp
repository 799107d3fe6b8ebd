// Sharp shadows against paper 3's march, one after the other, so that what else the machine does
// hits both (issue 5: sharp takes at most 1/20 of the time of our own SIMD march).
#pragma once

#include <algorithm>
#include <chrono>
#include <vector>

#include <rastrum/terrain/shadows.hpp>

namespace rastrum::bench {

struct ShadowTimes {
  double march_ms = 0, sharp_ms = 0;  ///< medians
  double hidden = 0;                  ///< part of the cells that is in sharp shadow
};

/// `repeats` of each, interleaved; the first pair is not counted. Heights in cells.
[[nodiscard]] inline ShadowTimes time_shadows(ImageView<const float> heights,
                                              const terrain::Sun& sun, int repeats,
                                              const terrain::ShadowOptions& options = {},
                                              const terrain::March& march = {}) {
  using Clock = std::chrono::steady_clock;
  const auto ms = [](Clock::time_point a, Clock::time_point b) {
    return std::chrono::duration<double, std::milli>(b - a).count();
  };
  std::vector<double> marches, sharps;
  ShadowTimes times;
  for (int i = 0; i <= repeats; ++i) {
    const auto a = Clock::now();
    const Image<std::uint16_t> counts = terrain::hidden_samples(heights, sun, march, options);
    const auto b = Clock::now();
    const Image<std::uint8_t> dark = terrain::sharp_shadows(heights, sun, options);
    const auto c = Clock::now();
    times.hidden = static_cast<double>(std::ranges::count(dark.pixels(), std::uint8_t{1})) /
                   static_cast<double>(counts.pixels().size());
    if (i == 0) continue;
    marches.push_back(ms(a, b));
    sharps.push_back(ms(b, c));
  }
  std::ranges::sort(marches);
  std::ranges::sort(sharps);
  times.march_ms = marches[marches.size() / 2];
  times.sharp_ms = sharps[sharps.size() / 2];
  return times;
}

}  // namespace rastrum::bench
