// SPDX-License-Identifier: BSD-3-Clause
// The threads behind a loop. oneTBB has them where CMake finds it (tbb_scheduler.cpp); elsewhere a
// pool of our own does (pool_scheduler.cpp), which needs nothing but the standard library.
#pragma once

#include <cstddef>
#include <memory>

namespace rastrum::parallel {

class Scheduler {
 public:
  using Body = void (*)(void* data, std::size_t begin, std::size_t end);

  Scheduler() = default;
  Scheduler(const Scheduler&) = delete;
  Scheduler& operator=(const Scheduler&) = delete;
  virtual ~Scheduler() = default;

  /// How many threads work at once, the caller's included; fewer if the system refuses to start so
  /// many.
  [[nodiscard]] virtual int concurrency() const = 0;
  /// Calls body(data, begin, end) for ranges that make up [0, n), of at most `grain` > 0 indices
  /// each; what the bodies wrote is visible to the caller afterwards. A body may call run() itself,
  /// and several threads may at once. If a body throws, ranges that have not begun are left out and
  /// the exception, or one of several, reaches the caller.
  virtual void run(std::size_t n, std::size_t grain, Body body, void* data) = 0;
};

/// How many forks lie between the process that first asked and this one. A fork copies a scheduler
/// without its threads, and a mutex perhaps while one of them holds it.
[[nodiscard]] int generation();

/// `count` threads, 0 for as many as the process may run on.
[[nodiscard]] std::unique_ptr<Scheduler> make_pool_scheduler(int count);
[[nodiscard]] std::unique_ptr<Scheduler> make_tbb_scheduler(int count);  ///< with RASTRUM_TBB

}  // namespace rastrum::parallel
