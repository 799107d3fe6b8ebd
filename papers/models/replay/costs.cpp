// SPDX-License-Identifier: BSD-3-Clause
#include <papers/models/replay/costs.hpp>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include <rastrum/parallel/exec.hpp>

namespace rastrum::bench {
namespace {

using parallel::Recording;

/// ns for a core to look into another core's queue, which moves a cache line. Assumed: two workers
/// have only one other queue to look at.
constexpr double kLook = 60;

void spin(double ns) {
  const std::int64_t end = Recording::now_ns() + static_cast<std::int64_t>(ns);
  while (Recording::now_ns() < end) {
  }
}

/// The 20 % quantile, because a thread may lose its core for a while, which is not oneTBB's cost.
double usual(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 5);
  std::ranges::nth_element(values, at);
  return *at;
}

template <class Loop>
double loop_ns(int rounds, const Loop& loop) {
  std::vector<double> ns;
  for (int i = 0; i < rounds; ++i) {
    const std::int64_t begin = Recording::now_ns();
    loop();
    ns.push_back(static_cast<double>(Recording::now_ns() - begin));
  }
  return usual(std::move(ns));
}

struct Latency {
  double take = 0, join = 0;
  bool found = false;
};

/// Two tasks. The other thread is to take the second while the first waits for it. The caller is
/// alone for `gap_ns` before.
Latency latency(parallel::Threads& threads, int rounds, double gap_ns) {
  constexpr std::int64_t kPatience = 3'000'000;
  std::vector<double> take, join;
  for (int i = 0; i < rounds; ++i) {
    spin(gap_ns);
    std::atomic<std::int64_t> begun = 0;
    std::int64_t ended = 0;
    bool by_other = false;
    const std::thread::id caller = std::this_thread::get_id();
    const std::int64_t begin = Recording::now_ns();
    parallel::for_each_index(threads, 2, [&](std::size_t k) {
      if (k == 0) {
        while (begun.load(std::memory_order_acquire) == 0 &&
               Recording::now_ns() - begin < kPatience) {
        }
        return;
      }
      by_other = std::this_thread::get_id() != caller;
      begun.store(Recording::now_ns(), std::memory_order_release);
      spin(10'000);
      ended = Recording::now_ns();
    });
    const std::int64_t end = Recording::now_ns();
    if (!by_other) continue;
    take.push_back(static_cast<double>(begun - begin));
    join.push_back(static_cast<double>(end - ended));
  }
  return {usual(take), usual(join), !take.empty()};
}

}  // namespace

LoopCosts measure_costs(int rounds) {
  LoopCosts costs{.loop = 500,
                  .task = 25,
                  .take = 700,
                  .look = kLook,
                  .claim = 25,
                  .join = 500,
                  .wake = 25'000,
                  .linger = 100'000};
  constexpr std::size_t kTasks = 4096;
  parallel::Threads one(1);
  std::atomic<std::size_t> sink = 0;
  const auto count = [&](std::size_t i) { sink.store(i, std::memory_order_relaxed); };
  costs.loop = loop_ns(20 * rounds, [&] { parallel::for_each_index(one, 1, count); });
  costs.task =
      (loop_ns(rounds, [&] { parallel::for_each_index(one, kTasks, count); }) - costs.loop) /
      (2 * kTasks - 1);
  if (std::thread::hardware_concurrency() < 2) return costs;
  parallel::Threads two(2);
  costs.claim = loop_ns(rounds, [&] { parallel::for_each_in_order(two, kTasks, count); }) / kTasks;
  const Latency near = latency(two, 4 * rounds, 10'000);
  const Latency far = latency(two, rounds, 20'000'000);
  // No hand-over takes longer than this, so the threads have no cores of their own now.
  if (!near.found || !far.found || near.take > 20'000 || near.join > 20'000) return costs;
  costs.take = std::max(near.take - costs.loop, 0.0);
  costs.join = near.join;
  costs.wake = std::max(far.take - near.take, 0.0);
  costs.linger = 1e18;
  for (const double gap : {50e3, 100e3, 200e3, 500e3, 1e6, 2e6, 5e6}) {
    const Latency at = latency(two, rounds, gap);
    if (!at.found || at.take < (near.take + far.take) / 2) continue;
    costs.linger = gap;
    break;
  }
  return costs;
}

}  // namespace rastrum::bench
