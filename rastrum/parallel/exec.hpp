// Backends of the data-parallel words. A word is a function template whose first argument is the
// backend; `Serial` implements each in the plainest loop and is the reference of the others.
#pragma once

#include <cstddef>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace rastrum::parallel {

/// One thread, plain loops.
struct Serial {
  [[nodiscard]] static int concurrency() { return 1; }
};

/// oneTBB in an arena of its own. Copyable handle-free object; keep it alive between frames,
/// starting threads costs more than a small frame.
class Threads {
 public:
  /// `count` threads, the caller's included; 0 takes what the machine has.
  explicit Threads(int count = 0) : arena_(count > 0 ? count : tbb::task_arena::automatic) {
    arena_.initialize();
  }
  [[nodiscard]] int concurrency() const { return arena_.max_concurrency(); }
  [[nodiscard]] tbb::task_arena& arena() { return arena_; }

 private:
  tbb::task_arena arena_;
};

/// Calls f(i) for i in [0, n). Work O(n), span O(1) on serial's terms, O(log n) with threads.
template <class F>
void for_each_index(Serial&, std::size_t n, F&& f) {
  for (std::size_t i = 0; i < n; ++i) f(i);
}

/// The same; `grain` indices at least are handed out at a time.
template <class F>
void for_each_index(Threads& exec, std::size_t n, F&& f, std::size_t grain = 1) {
  exec.arena().execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, n, grain),
        [&](const tbb::blocked_range<std::size_t>& r) {
          for (std::size_t i = r.begin(); i != r.end(); ++i) f(i);
        },
        tbb::simple_partitioner{});
  });
}

}  // namespace rastrum::parallel
