// SPDX-License-Identifier: BSD-3-Clause
// The one place that calls oneTBB's scheduler. Debian builds libtbb without the thread sanitizer,
// which would report every hand-over of work as a race. So this file is compiled without it
// (CMakeLists.txt) and states what the scheduler guarantees: the caller's writes precede the
// bodies, and these precede what the caller does next. Races between bodies are still found.
#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <rastrum/parallel/scheduler.hpp>

#if defined(RASTRUM_TSAN)
extern "C" void __tsan_acquire(void* address);
extern "C" void __tsan_release(void* address);
#endif

namespace rastrum::parallel {
namespace {

#if defined(RASTRUM_TSAN)
/// A happens-before edge: everything before a `leave` precedes everything after an `enter`.
struct HandOver {
  char address = 0;
  void leave() { __tsan_release(&address); }
  void enter() { __tsan_acquire(&address); }
};
#else
struct HandOver {
  void leave() {}
  void enter() {}
};
#endif

/// Calls `begin` when constructed and `end` when destroyed, so also when something throws.
template <void (HandOver::*begin)(), void (HandOver::*end)()>
class Handing {
 public:
  Handing(HandOver& fork, HandOver& join) : join_(join) { (fork.*begin)(); }
  ~Handing() { (join_.*end)(); }
  Handing(const Handing&) = delete;
  Handing& operator=(const Handing&) = delete;

 private:
  HandOver& join_;
};
using AroundLoop = Handing<&HandOver::leave, &HandOver::enter>;  ///< for the caller
using WithinLoop = Handing<&HandOver::enter, &HandOver::leave>;  ///< for one range

/// How many threads the system can start, at most `wanted`. oneTBB ends the program if it cannot
/// start its workers (ulimit -u, a container's limit), so we try first. Remembers the greatest
/// number that worked.
int startable(int wanted) {
  static std::atomic<int> known = 0;
  if (wanted <= known) return wanted;
  std::atomic<bool> all_are_there = false;
  std::vector<std::jthread> started;
  try {
    while (static_cast<int>(started.size()) < wanted)
      started.emplace_back([&] { all_are_there.wait(false); });
  } catch (const std::exception&) {  // use those that have started
  }
  all_are_there = true;
  all_are_there.notify_all();
  const int count = static_cast<int>(started.size());
  if (count > known) known = count;
  return count;
}

/// `count` (0 for all cores), or fewer if the system cannot start so many.
int limited(int count) {
  const int wanted = (count > 0 ? count : tbb::this_task_arena::max_concurrency()) - 1;
  const int there = startable(wanted);
  return there < wanted ? there + 1 : count;
}

class TbbScheduler final : public Scheduler {
 public:
  explicit TbbScheduler(int count) : arena_(std::make_unique<Arena>(count)) {}
  ~TbbScheduler() override {
    // A copy's arena knows sleeping threads by what was on their stacks, which are others' now.
    if (is_copy()) static_cast<void>(arena_.release());
  }
  TbbScheduler(const TbbScheduler&) = delete;
  TbbScheduler& operator=(const TbbScheduler&) = delete;

  [[nodiscard]] int concurrency() const override { return concurrency_; }
  void run(std::size_t n, std::size_t grain, Body body, void* data) override {
    if (is_copy()) {
      for (std::size_t begin = 0; begin < n; begin += std::min(grain, n - begin))
        body(data, begin, begin + std::min(grain, n - begin));
      return;
    }
    HandOver fork, join;
    const AroundLoop around(fork, join);
    arena_->arena.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, n, grain),
          [&](const tbb::blocked_range<std::size_t>& range) {
            const WithinLoop within(fork, join);
            body(data, range.begin(), range.end());
          },
          tbb::simple_partitioner{});
    });
  }

 private:
  struct Arena {
    explicit Arena(int count) : arena(count > 0 ? count : tbb::task_arena::automatic) {
      if (count > tbb::this_task_arena::max_concurrency())
        more_than_cores.emplace(tbb::global_control::max_allowed_parallelism,
                                static_cast<std::size_t>(count));
      arena.initialize();
    }
    std::optional<tbb::global_control> more_than_cores;
    tbb::task_arena arena;
  };
  /// Whether a fork has made this one, which has no threads then.
  [[nodiscard]] bool is_copy() const { return generation_ != generation(); }

  const int generation_ = generation();
  std::unique_ptr<Arena> arena_;
  const int concurrency_ = arena_->arena.max_concurrency();
};

}  // namespace

std::unique_ptr<Scheduler> make_tbb_scheduler(int count) {
  return std::make_unique<TbbScheduler>(limited(count));
}

}  // namespace rastrum::parallel
