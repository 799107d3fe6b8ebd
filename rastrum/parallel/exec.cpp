// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/parallel/exec.hpp>

#include <algorithm>
#include <atomic>
#include <vector>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/parallel/recording.hpp>
#include <rastrum/parallel/scheduler.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::parallel {
namespace {

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

std::unique_ptr<Scheduler> make_scheduler(int count) {
#if defined(RASTRUM_TBB)
  // A forked child has oneTBB's locks as they were, perhaps held by threads that it has not: one
  // that goes to sleep holds some. It would wait for them for ever.
  if (generation() == 0) return make_tbb_scheduler(count);
#endif
  return make_pool_scheduler(count);
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

Threads::Threads(int count, MemoryAccount* account) : Threads(make_scheduler(count), account) {}
Threads::Threads(std::unique_ptr<Scheduler> scheduler, MemoryAccount* account)
    : scheduler_(std::move(scheduler)), memory_(std::make_shared<Arena>(account)) {}
Threads::~Threads() = default;

int Threads::concurrency() const {
  return pretended_workers > 0 ? pretended_workers : scheduler_->concurrency();
}

/// Calls share(begin, end, stopped) for ranges of at most `grain` indices.
template <class Share>
void Threads::loop(std::size_t n, std::size_t grain, const Share& share) {
  const StopToken* const stop = StopScope::current();
  const auto stopped = [stop] { return stop != nullptr && stop->stop_requested(); };
  auto range = [&](std::size_t begin, std::size_t end) {
    const FloatScope floats;  // a worker inherits the mode of the thread that started it
    if (stopped()) return;
    const StopScope scope(stop);
    share(begin, end, stopped);
  };
  scheduler_->run(
      n, grain,
      [](void* data, std::size_t begin, std::size_t end) {
        (*static_cast<decltype(&range)>(data))(begin, end);
      },
      &range);
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
  const auto workers = static_cast<std::size_t>(scheduler_->concurrency());
  loop(std::min(n, workers), 1, [&](std::size_t, std::size_t, const auto& stopped) {
    while (!stopped()) {
      const std::size_t i = next.fetch_add(1, std::memory_order_relaxed);
      if (i >= n) return;
      body(data, i, i + 1);
    }
  });
}

}  // namespace rastrum::parallel
