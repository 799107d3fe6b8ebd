// SPDX-License-Identifier: BSD-3-Clause
// Threads of our own, for machines that have no oneTBB. A loop is a counter of its ranges: threads
// claim the next one until none is left. The caller claims, too. At the end it waits only for
// helpers that are within a range of its own loop, so loops within loops cannot wait for each
// other.
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#if defined(__linux__)
#include <sched.h>
#endif
#if defined(__unix__) || defined(__APPLE__)
#include <pthread.h>
#endif

#include <rastrum/parallel/scheduler.hpp>

namespace rastrum::parallel {
namespace {

/// Cores that the process may use.
int cores() {
#if defined(__linux__)
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(CPU_COUNT(&set), 1);
#endif
  return std::max(static_cast<int>(std::thread::hardware_concurrency()), 1);
}

/// Yields until done() or for some 50 µs: going to sleep and being woken costs as much.
template <class Done>
void spin_until(const Done& done) {
  for (int i = 0; i < 100 && !done(); ++i) std::this_thread::yield();
}

struct Loop {
  std::size_t n, grain, ranges;
  Scheduler::Body body;
  void* data;
  std::atomic<std::size_t> claimed = 0;  ///< ranges, and one more for each thread that found none
  std::atomic<bool> failed = false;
  std::exception_ptr error{};
  std::atomic<int> helpers = 0;  ///< changes under the team's mutex
  Loop* older = nullptr;

  [[nodiscard]] bool has_ranges() const { return claimed.load(std::memory_order_relaxed) < ranges; }
  [[nodiscard]] bool has_helpers() const { return helpers.load(std::memory_order_relaxed) != 0; }
  void work() {
    while (true) {
      const std::size_t range = claimed.fetch_add(1, std::memory_order_relaxed);
      if (range >= ranges) return;
      const std::size_t begin = range * grain;
      try {
        body(data, begin, begin + std::min(grain, n - begin));
      } catch (...) {
        claimed.store(ranges, std::memory_order_relaxed);
        if (!failed.exchange(true)) error = std::current_exception();
      }
    }
  }
};

/// Threads that help with the loops that are open.
class Team {
 public:
  explicit Team(int wanted) {
    try {
      workers_.reserve(static_cast<std::size_t>(wanted));
      for (int i = 0; i < wanted; ++i) workers_.emplace_back([this] { help(); });
    } catch (const std::exception&) {  // use those that have started
    }
  }
  ~Team() {
    {
      const std::scoped_lock lock(mutex_);
      ending_ = true;
    }
    wake_.notify_all();
    for (std::thread& worker : workers_) worker.join();
  }
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  void open(Loop& loop) {
    std::size_t woken = 0;
    {
      const std::scoped_lock lock(mutex_);
      loop.older = std::exchange(newest_, &loop);
      opened_.fetch_add(1, std::memory_order_relaxed);
      woken = std::min(sleeping_, loop.ranges - 1);
    }
    if (woken > 1)
      wake_.notify_all();
    else if (woken == 1)
      wake_.notify_one();
  }

  /// Returns when no helper is in the loop.
  void close(Loop& loop) {
    spin_until([&] { return !loop.has_helpers(); });
    std::unique_lock lock(mutex_);
    Loop** at = &newest_;
    while (*at != &loop) at = &(*at)->older;
    *at = loop.older;
    left_.wait(lock, [&] { return !loop.has_helpers(); });
  }

 private:
  /// The work of a helper until the team ends.
  void help() {
    std::unique_lock lock(mutex_);
    while (!ending_) {
      Loop* loop = newest_;
      while (loop != nullptr && !loop->has_ranges()) loop = loop->older;
      if (loop != nullptr) {
        loop->helpers.fetch_add(1, std::memory_order_relaxed);
        lock.unlock();
        loop->work();
        lock.lock();
        loop->helpers.fetch_sub(1, std::memory_order_relaxed);
        if (!loop->has_helpers()) left_.notify_all();
        continue;
      }
      const auto news = [this, seen = opened_.load(std::memory_order_relaxed)] {
        return opened_.load(std::memory_order_relaxed) != seen;
      };
      lock.unlock();
      spin_until(news);
      lock.lock();
      ++sleeping_;
      wake_.wait(lock, [&] { return ending_ || news(); });
      --sleeping_;
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_;      ///< workers wait for a loop
  std::condition_variable left_;      ///< callers wait for helpers
  std::atomic<unsigned> opened_ = 0;  ///< loops so far; changes under the mutex
  std::size_t sleeping_ = 0;
  bool ending_ = false;
  Loop* newest_ = nullptr;  ///< of those that are open
  std::vector<std::thread> workers_;
};

/// Starts its threads at the first loop that has work for them: many a pool is only asked how many
/// threads it has.
class PoolScheduler final : public Scheduler {
 public:
  explicit PoolScheduler(int count) : concurrency_(count > 0 ? count : cores()) {}
  ~PoolScheduler() override {
    // A copy has nobody to join, and cannot destroy what they waited for.
    if (is_copy()) static_cast<void>(team_.release());
  }
  PoolScheduler(const PoolScheduler&) = delete;
  PoolScheduler& operator=(const PoolScheduler&) = delete;

  [[nodiscard]] int concurrency() const override { return concurrency_; }

  void run(std::size_t n, std::size_t grain, Body body, void* data) override {
    if (n == 0) return;
    Loop loop{n, grain, (n - 1) / grain + 1, body, data};
    if (loop.ranges == 1 || concurrency_ == 1 || is_copy()) {
      loop.work();
    } else {
      std::call_once(start_, [this] { team_ = std::make_unique<Team>(concurrency_ - 1); });
      team_->open(loop);
      loop.work();
      team_->close(loop);
    }
    if (loop.error) std::rethrow_exception(loop.error);
  }

 private:
  /// Whether a fork has made this one, which has no threads then.
  [[nodiscard]] bool is_copy() const { return generation_ != generation(); }

  const int generation_ = generation();
  const int concurrency_;
  std::once_flag start_;
  std::unique_ptr<Team> team_;
};

}  // namespace

int generation() {
  static std::atomic<int> forks = 0;
#if defined(__unix__) || defined(__APPLE__)
  static const int registered = pthread_atfork(nullptr, nullptr, [] { ++forks; });
  static_cast<void>(registered);
#endif
  return forks.load(std::memory_order_relaxed);
}

std::unique_ptr<Scheduler> make_pool_scheduler(int count) {
  return std::make_unique<PoolScheduler>(count);
}

}  // namespace rastrum::parallel
