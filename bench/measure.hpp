// SPDX-License-Identifier: BSD-3-Clause
// Interleaved timing: A B C A B C …, so that what the machine does meanwhile (frequency,
// neighbours) falls on all alike. Only ratios within a run are worth quoting.
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
  double turn_ms = 30;  ///< a contender's turn: frames until this has passed, one at least
};

/// Times of one contender: a sample per round, the median of the round's frames.
struct Timing {
  std::string name;
  std::vector<double> samples_ms;
  /// CPU time of all the process's threads a frame, of each round: steadier than the clock on a
  /// busy machine, but it counts threads that spin while they wait.
  std::vector<double> cpu_samples_ms = {};

  [[nodiscard]] double median_ms() const;
  /// Half the distance of the quartiles over the median.
  [[nodiscard]] double spread() const;
};

/// Each turn begins with a frame that is not counted (it wakes threads and brings the contender's
/// own data into the caches), except where a frame takes longer than four turns.
[[nodiscard]] std::vector<Timing> measure_interleaved(std::span<const Contender> contenders,
                                                      const Plan& plan);

/// The wall-clock time of a call.
[[nodiscard]] double timed_ms(const std::function<void()>& f);
/// The times of a frame's stages; those of one name are added up.
[[nodiscard]] std::map<std::string, double> stages_ms(const FrameStats& stats);
/// The counter of that name, or 0.
[[nodiscard]] std::uint64_t counter(const FrameStats& stats, std::string_view name);

/// Whether two pictures of one size have the same bits.
template <class Pixel>
[[nodiscard]] bool same_bits(const Image<Pixel>& a, const Image<Pixel>& b) {
  return std::memcmp(a.pixels().data(), b.pixels().data(), a.pixels().size_bytes()) == 0;
}

/// The median of `values`; 0 where there are none.
[[nodiscard]] double median(std::vector<double> values);
/// The median over rounds of a's time over b's of the same round.
[[nodiscard]] double median_ratio(const Timing& a, const Timing& b);

}  // namespace rastrum::bench
