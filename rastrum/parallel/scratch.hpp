// for_each_with_scratch: a loop whose body wants memory of its own to work in. The pool outlives
// the loop, so that what grew in one frame is there in the next.
//
// Work O(n), span O(log n) beside the bodies'. At most one T per thread that ever took part.
// Source: DESIGN section 5, "work that wants a team with scratch memory": a worker thread with its
// T here, a block of threads with shared memory on a device.
#pragma once

#include <cstddef>
#include <utility>

#include <tbb/enumerable_thread_specific.h>

#include <rastrum/parallel/exec.hpp>

namespace rastrum::parallel {

/// A T for each thread that asks, made when it first does and kept until the pool ends.
template <class T>
class ScratchPool {
 public:
  /// Each T is T{}.
  ScratchPool() = default;
  /// Each T is make(), which is copied and may be called by several threads at once.
  template <class Make>
  explicit ScratchPool(Make make) : of_threads_(std::move(make)) {}

  /// The calling thread's T. Keep no reference across a loop on the same backend: a thread that
  /// waits for it may run another body of the outer loop, which has the same T.
  [[nodiscard]] T& local() { return of_threads_.local(); }

  /// Calls f(T&) for all that were made, in no particular order; not while a loop runs.
  template <class F>
  void for_each(F&& f) {
    for (T& scratch : of_threads_) f(scratch);
  }

 private:
  tbb::enumerable_thread_specific<T> of_threads_;
};

/// Calls f(i, scratch) for i in [0, n); no other body has `scratch` meanwhile. What it holds at the
/// beginning is what an earlier body left there. f must not start loops on `exec`.
template <class Exec, class T, class F>
void for_each_with_scratch(Exec& exec, std::size_t n, ScratchPool<T>& pool, F&& f) {
  for_each_index(exec, n, [&](std::size_t i) { f(i, pool.local()); });
}

}  // namespace rastrum::parallel
