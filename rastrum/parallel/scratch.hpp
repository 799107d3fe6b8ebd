// SPDX-License-Identifier: BSD-3-Clause
// for_each_with_scratch: a loop whose body wants memory of its own to work in. The pool outlives
// the loop, so that what grew in one frame is there in the next.
//
// Work O(n), span O(log n) beside the bodies'. At most one T per thread that ever took part.
// A worker thread with its T is here what a block of threads with shared memory is on a device
// (for_each_team, cuda/exec.cuh).
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <type_traits>
#include <utility>

#include <rastrum/parallel/exec.hpp>

namespace rastrum::parallel {

/// A pointer for each thread that asks, null at first.
class ThreadSlots {
 public:
  ThreadSlots();
  ThreadSlots(ThreadSlots&&) noexcept;
  ThreadSlots& operator=(ThreadSlots&&) noexcept;
  ~ThreadSlots();
  [[nodiscard]] void*& local();
  /// f(slot, data) for all that are not null; not while a loop runs.
  void for_each(void (*f)(void* slot, void* data), void* data);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A T for each thread that asks, made when it first does and kept until the pool ends.
template <class T>
class ScratchPool {
 public:
  /// Each T is T{}.
  ScratchPool() : ScratchPool([] { return T{}; }) {}
  /// Each T is make(), which is copied and may be called by several threads at once.
  template <class Make>
  requires(!std::is_same_v<Make, ScratchPool>) explicit ScratchPool(Make make)
      : make_([make] { return new T(make()); }) {}
  ScratchPool(ScratchPool&&) noexcept = default;
  ScratchPool& operator=(ScratchPool&& other) noexcept {
    std::swap(make_, other.make_);
    std::swap(slots_, other.slots_);
    return *this;
  }
  ~ScratchPool() {
    slots_.for_each([](void* slot, void*) { delete static_cast<T*>(slot); }, nullptr);
  }

  /// The calling thread's T. Keep no reference across a loop on the same backend: a thread that
  /// waits for it may run another body of the outer loop, which has the same T.
  [[nodiscard]] T& local() {
    void*& slot = slots_.local();
    if (slot == nullptr) slot = make_();
    return *static_cast<T*>(slot);
  }

  /// Calls f(T&) for all that were made, in no particular order; not while a loop runs.
  template <class F>
  void for_each(F&& f) {
    slots_.for_each(
        [](void* slot, void* data) {
          (*static_cast<std::remove_reference_t<F>*>(data))(*static_cast<T*>(slot));
        },
        &f);
  }

 private:
  std::function<T*()> make_;
  ThreadSlots slots_;
};

/// Calls f(i, scratch) for i in [0, n); no other body has `scratch` meanwhile. At first it holds
/// what an earlier body left there. f must not start loops on `exec`.
template <class Exec, class T, class F>
void for_each_with_scratch(Exec& exec, std::size_t n, ScratchPool<T>& pool, F&& f) {
  for_each_index(exec, n, [&](std::size_t i) { f(i, pool.local()); });
}

}  // namespace rastrum::parallel
