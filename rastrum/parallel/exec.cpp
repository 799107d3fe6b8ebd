// SPDX-License-Identifier: BSD-3-Clause
// The one place that calls oneTBB's scheduler. Debian builds libtbb without the thread sanitizer,
// which would report every hand-over of work as a race. So this file is compiled without it
// (CMakeLists.txt) and states what the scheduler guarantees: the caller's writes precede the
// bodies, and these precede what the caller does next. Races between bodies are still found.
#include <rastrum/parallel/exec.hpp>

#include <algorithm>
#include <atomic>
#include <exception>
#include <optional>
#include <thread>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/parallel/recording.hpp>
#include <rastrum/stop.hpp>

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

thread_local Recording* recording_in_force = nullptr;
thread_local int pretended_workers = 0;

/// Wraps a loop's body with one that records, if the calling thread records.
class RecordedLoop {
 public:
  RecordedLoop(std::size_t n, std::size_t grain, bool in_order, Threads::Body& body, void*& data)
      : recording_(recording_in_force) {
    if (recording_ == nullptr) return;
    body_ = std::exchange(body, &RecordedLoop::call);
    data_ = std::exchange(data, this);
    loop_ = {Recording::now_ns(), 0, n, grain, in_order, {}};
    tasks_.resize(n);  // before the clock is read again; at most one task per index
    loop_.begin_ns = Recording::now_ns();
  }
  ~RecordedLoop() {
    if (recording_ == nullptr) return;
    loop_.end_ns = Recording::now_ns();
    tasks_.resize(count_);
    std::ranges::sort(tasks_, {}, &Recording::Task::begin_ns);
    loop_.tasks = std::move(tasks_);
    recording_->loops.push_back(std::move(loop_));
  }
  RecordedLoop(const RecordedLoop&) = delete;
  RecordedLoop& operator=(const RecordedLoop&) = delete;

 private:
  static void call(void* data, std::size_t begin, std::size_t end) {
    RecordedLoop& self = *static_cast<RecordedLoop*>(data);
    // Nothing is recorded within a body, even if it throws.
    const RecordScope within(nullptr, self.recording_->workers);
    const std::int64_t from = Recording::now_ns();
    self.body_(self.data_, begin, end);
    const std::int64_t to = Recording::now_ns();
    self.tasks_[self.count_.fetch_add(1, std::memory_order_relaxed)] = {begin, end, from, to};
  }

  Recording* recording_;
  Threads::Body body_ = nullptr;
  void* data_ = nullptr;
  Recording::Loop loop_{};
  std::vector<Recording::Task> tasks_;
  std::atomic<std::size_t> count_ = 0;
};

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

}  // namespace

RecordScope::RecordScope(Recording* recording, int workers) noexcept
    : outer_(std::exchange(recording_in_force, recording)),
      outer_workers_(std::exchange(pretended_workers, workers)) {}
RecordScope::~RecordScope() {
  recording_in_force = outer_;
  pretended_workers = outer_workers_;
}
Recording* RecordScope::current() noexcept {
  return recording_in_force;
}

struct Threads::Scheduler {
  explicit Scheduler(int count) : arena(count > 0 ? count : tbb::task_arena::automatic) {
    if (count > tbb::this_task_arena::max_concurrency())
      more_than_cores.emplace(tbb::global_control::max_allowed_parallelism,
                              static_cast<std::size_t>(count));
    arena.initialize();
  }
  std::optional<tbb::global_control> more_than_cores;
  tbb::task_arena arena;
};

Threads::Threads(int count, MemoryAccount* account)
    : scheduler_(std::make_unique<Scheduler>(limited(count))),
      memory_(std::make_shared<Arena>(account)) {}
Threads::~Threads() = default;

int Threads::concurrency() const {
  return pretended_workers > 0 ? pretended_workers : scheduler_->arena.max_concurrency();
}

/// Calls share(begin, end, stopped) for ranges of at most `grain` indices.
template <class Share>
void Threads::loop(std::size_t n, std::size_t grain, const Share& share) {
  const StopToken* const stop = StopScope::current();
  const auto stopped = [stop] { return stop != nullptr && stop->stop_requested(); };
  {
    HandOver fork, join;
    const AroundLoop around(fork, join);
    scheduler_->arena.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, n, grain),
          [&](const tbb::blocked_range<std::size_t>& range) {
            const WithinLoop within(fork, join);
            const FloatScope floats;  // a worker inherits the mode of the thread that started it
            if (stopped()) return;
            const StopScope scope(stop);
            share(range.begin(), range.end(), stopped);
          },
          tbb::simple_partitioner{});
    });
  }
  // Some ranges may have been skipped, so nobody may see the results.
  if (stopped()) throw Stopped{};
}

void Threads::for_each_range(std::size_t n, std::size_t grain, Body body, void* data) {
  RecordedLoop recorded(n, grain, false, body, data);
  loop(n, grain,
       [body, data](std::size_t begin, std::size_t end, const auto&) { body(data, begin, end); });
}

void Threads::for_each_next(std::size_t n, Body body, void* data) {
  RecordedLoop recorded(n, 1, true, body, data);
  std::atomic<std::size_t> next = 0;
  // A worker that comes late finds nothing left.
  const auto workers = static_cast<std::size_t>(scheduler_->arena.max_concurrency());
  loop(std::min(n, workers), 1, [&](std::size_t, std::size_t, const auto& stopped) {
    while (!stopped()) {
      const std::size_t i = next.fetch_add(1, std::memory_order_relaxed);
      if (i >= n) return;
      body(data, i, i + 1);
    }
  });
}

}  // namespace rastrum::parallel
