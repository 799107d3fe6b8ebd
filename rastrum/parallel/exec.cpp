// The one place that calls oneTBB's scheduler. The thread sanitizer does not see into libtbb, which
// Debian builds without it, and would report every hand-over of work as a race. So this file is
// compiled without the sanitizer (CMakeLists.txt) and tells it what the scheduler guarantees: what
// the caller did happens before the bodies, and these before what the caller does next. Races
// between bodies are still found.
#include <rastrum/parallel/exec.hpp>

#include <optional>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <rastrum/stop.hpp>

#if defined(RASTRUM_TSAN)
extern "C" void __tsan_acquire(void* address);
extern "C" void __tsan_release(void* address);
#endif

namespace rastrum::parallel {
namespace {

#if defined(RASTRUM_TSAN)
/// An edge of happens-before: everything before a `leave` precedes everything after an `enter`.
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

/// Takes work over for one range, and hands it back even when the body throws.
class WithinLoop {
 public:
  WithinLoop(HandOver& fork, HandOver& join) : join_(join) { fork.enter(); }
  ~WithinLoop() { join_.leave(); }
  WithinLoop(const WithinLoop&) = delete;
  WithinLoop& operator=(const WithinLoop&) = delete;

 private:
  HandOver& join_;
};

/// The caller's side: forks at the beginning, has joined at the end, also of an error's way out.
class AroundLoop {
 public:
  AroundLoop(HandOver& fork, HandOver& join) : join_(join) { fork.leave(); }
  ~AroundLoop() { join_.enter(); }
  AroundLoop(const AroundLoop&) = delete;
  AroundLoop& operator=(const AroundLoop&) = delete;

 private:
  HandOver& join_;
};

}  // namespace

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
    : scheduler_(std::make_unique<Scheduler>(count)), memory_(std::make_shared<Arena>(account)) {}
Threads::~Threads() = default;

int Threads::concurrency() const {
  return scheduler_->arena.max_concurrency();
}

void Threads::for_each_range(std::size_t n, std::size_t grain,
                             void (*body)(void* data, std::size_t begin, std::size_t end),
                             void* data) {
  const std::stop_token* const stop = StopScope::current();
  const auto stopped = [stop] { return stop != nullptr && stop->stop_requested(); };
  {
    HandOver fork, join;
    const AroundLoop around(fork, join);
    scheduler_->arena.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, n, grain),
          [&](const tbb::blocked_range<std::size_t>& range) {
            const WithinLoop within(fork, join);
            if (stopped()) return;
            const StopScope scope(stop);
            body(data, range.begin(), range.end());
          },
          tbb::simple_partitioner{});
    });
  }
  // Ranges may have been left out: nothing that follows is to see their results.
  if (stopped()) throw Stopped{};
}

}  // namespace rastrum::parallel
