// SPDX-License-Identifier: BSD-3-Clause
// for_each_with_scratch: a loop whose bodies need scratch memory. Its pool outlives the loop, so
// that frames reuse it.
//
// Work O(n), span O(log n) beside the bodies'. At most one T per thread. A worker with its T
// corresponds to a device's block of threads with shared memory (for_each_team, cuda/exec.cuh).
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
  /// Calls f(slot, data) for all that are not null; not while a loop runs.
  void for_each(void (*f)(void* slot, void* data), void* data);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A T for each thread that asks, made on first use and kept until the pool ends.
template <class T>
class ScratchPool {
 public:
  ScratchPool() : ScratchPool([] { return T{}; }) {}
  /// Each T is make(), which several threads may call at once.
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

  /// The calling thread's T. Keep no reference across a loop on the same backend: a waiting thread
  /// may run another body of the outer loop, with the same T.
  [[nodiscard]] T& local() {
    void*& slot = slots_.local();
    if (slot == nullptr) slot = make_();
    return *static_cast<T*>(slot);
  }

  /// Calls f(T&) for all that exist, in any order; not while a loop runs.
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

/// Calls f(i, scratch) for i in [0, n). Only this body uses `scratch`, which still holds what an
/// earlier one left there. f must not start loops on `exec`.
template <class Exec, class T, class F>
void for_each_with_scratch(Exec& exec, std::size_t n, ScratchPool<T>& pool, F&& f) {
  for_each_index(exec, n, [&](std::size_t i) { f(i, pool.local()); });
}

}  // namespace rastrum::parallel
