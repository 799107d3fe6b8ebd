// SPDX-License-Identifier: BSD-3-Clause
// Interleaved timing, A B C A B C …: changes of the machine (frequency, neighbours) hit all
// contenders alike. Only ratios within a run are worth quoting.
#pragma once

#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/image.hpp>

namespace rastrum {
struct FrameStats;
}

namespace rastrum::bench {

struct Contender {
  std::string name;
  std::function<void()> frame;  ///< what is timed
};

struct Plan {
  int rounds = 9;
  double turn_ms = 30;  ///< a contender draws frames until this has passed, at least one
};

/// One contender's times: a sample per round, the median of the round's frames.
struct Timing {
  std::string name;
  std::vector<double> samples_ms;
  /// CPU time per frame of all the process's threads, for each round. It is steadier than the clock
  /// on a busy machine, but includes threads that spin while they wait.
  std::vector<double> cpu_samples_ms = {};

  [[nodiscard]] double median_ms() const;
  /// Half the interquartile range over the median.
  [[nodiscard]] double spread() const;
};

/// Each turn begins with an uncounted frame, which wakes threads and warms the caches, unless a
/// frame takes longer than four turns.
[[nodiscard]] std::vector<Timing> measure_interleaved(std::span<const Contender> contenders,
                                                      const Plan& plan);

[[nodiscard]] double timed_ms(const std::function<void()>& f);
/// The times of a frame's stages; equal names are added up.
[[nodiscard]] std::map<std::string, double> stages_ms(const FrameStats& stats);
/// The counter of that name, or 0.
[[nodiscard]] std::uint64_t counter(const FrameStats& stats, std::string_view name);

template <class Pixel>
[[nodiscard]] bool same_bits(const Image<Pixel>& a, const Image<Pixel>& b) {
  return std::memcmp(a.pixels().data(), b.pixels().data(), a.pixels().size_bytes()) == 0;
}

/// The median of `values`; 0 if there are none.
[[nodiscard]] double median(std::vector<double> values);
/// The median over rounds of a's time over b's of the same round.
[[nodiscard]] double median_ratio(const Timing& a, const Timing& b);

}  // namespace rastrum::bench
