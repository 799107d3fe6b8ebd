// SPDX-License-Identifier: BSD-3-Clause
#include "measure.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>

#include <rastrum/render.hpp>

namespace rastrum::bench {
namespace {

/// Linear interpolation between order statistics; `sorted` is not empty.
double quantile(const std::vector<double>& sorted, double q) {
  const double position = q * static_cast<double>(sorted.size() - 1);
  const auto i = static_cast<std::size_t>(position);
  const std::size_t j = std::min(i + 1, sorted.size() - 1);
  return sorted[i] + (sorted[j] - sorted[i]) * (position - static_cast<double>(i));
}

/// CPU time of the process so far.
double cpu_ms() {
  return static_cast<double>(std::clock()) * 1000 / CLOCKS_PER_SEC;
}

}  // namespace

double timed_ms(const std::function<void()>& f) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  f();
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

std::map<std::string, double> stages_ms(const FrameStats& stats) {
  std::map<std::string, double> ms;
  for (const StageTime& s : stats.stages) ms[s.name] += s.end_ms - s.begin_ms;
  return ms;
}

std::uint64_t counter(const FrameStats& stats, std::string_view name) {
  const auto found = std::ranges::find(
      stats.counters, name, [](const auto& of_name) -> const auto& { return of_name.first; });
  return found == stats.counters.end() ? 0 : found->second;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return quantile(values, 0.5);
}

double Timing::median_ms() const {
  return median(samples_ms);
}

double Timing::spread() const {
  if (samples_ms.empty()) return 0;
  std::vector<double> sorted = samples_ms;
  std::ranges::sort(sorted);
  return (quantile(sorted, 0.75) - quantile(sorted, 0.25)) / 2 / quantile(sorted, 0.5);
}

double median_ratio(const Timing& a, const Timing& b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(a.samples_ms.size(), b.samples_ms.size()); ++i)
    ratios.push_back(a.samples_ms[i] / b.samples_ms[i]);
  return median(std::move(ratios));
}

std::vector<Timing> measure_interleaved(std::span<const Contender> contenders, const Plan& plan) {
  std::vector<Timing> timings;
  std::vector<double> last_ms;
  for (const Contender& c : contenders) {
    timings.push_back({c.name, {}, {}});
    last_ms.push_back(timed_ms(c.frame));
  }
  for (int round = 0; round < plan.rounds; ++round)
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      if (last_ms[i] < 4 * plan.turn_ms) contenders[i].frame();
      std::vector<double> frames_ms;
      double turn_ms = 0;
      const double cpu_begin_ms = cpu_ms();
      do {
        frames_ms.push_back(timed_ms(contenders[i].frame));
        turn_ms += frames_ms.back();
      } while (turn_ms < plan.turn_ms);
      timings[i].cpu_samples_ms.push_back((cpu_ms() - cpu_begin_ms) /
                                          static_cast<double>(frames_ms.size()));
      last_ms[i] = median(std::move(frames_ms));
      timings[i].samples_ms.push_back(last_ms[i]);
    }
  return timings;
}

}  // namespace rastrum::bench
