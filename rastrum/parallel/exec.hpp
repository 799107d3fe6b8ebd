// SPDX-License-Identifier: BSD-3-Clause
// Backends of the data-parallel words. A word is a function template whose first argument is the
// backend. `Serial` implements each word as a plain loop and is the reference for the others.
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

#include <rastrum/parallel/arena.hpp>

namespace rastrum::parallel {

class Serial {
 public:
  /// Words take memory from an arena that `account` counts. It must outlive the backend and the
  /// words' results.
  explicit Serial(MemoryAccount* account = nullptr) : memory_(std::make_shared<Arena>(account)) {}
  /// For use within a loop of another backend, whose arena `memory` is.
  explicit Serial(std::shared_ptr<Arena> memory) : memory_(std::move(memory)) {}
  [[nodiscard]] static int concurrency() { return 1; }
  [[nodiscard]] const std::shared_ptr<Arena>& memory() const { return memory_; }

 private:
  std::shared_ptr<Arena> memory_;
};

class Scheduler;

/// Several threads (scheduler.hpp). Keep it between frames: starting threads costs more than a
/// small frame.
class Threads {
 public:
  /// `count` threads, the caller's included; 0 for as many as cores. It may exceed the cores.
  /// Memory as in Serial.
  explicit Threads(int count = 0, MemoryAccount* account = nullptr);
  explicit Threads(std::unique_ptr<Scheduler> scheduler, MemoryAccount* account = nullptr);
  ~Threads();
  [[nodiscard]] int concurrency() const;
  [[nodiscard]] const std::shared_ptr<Arena>& memory() const { return memory_; }

  using Body = void (*)(void* data, std::size_t begin, std::size_t end);
  /// Calls body(data, begin, end) for ranges that make up [0, n), each of at most `grain` indices.
  /// The caller sees what the bodies wrote. Used by for_each_index.
  void for_each_range(std::size_t n, std::size_t grain, Body body, void* data);
  /// The same for single indices: a free thread takes the next one. Used by for_each_in_order.
  void for_each_next(std::size_t n, Body body, void* data);

 private:
  template <class Share>
  void loop(std::size_t n, std::size_t grain, const Share& share);
  std::unique_ptr<Scheduler> scheduler_;
  std::shared_ptr<Arena> memory_;
};

/// Calls f(i) for i in [0, n). Work O(n), span O(1) in the serial model, O(log n) with threads.
template <class F>
void for_each_index(Serial&, std::size_t n, F&& f) {
  for (std::size_t i = 0; i < n; ++i) f(i);
}

/// The same; a task gets at most `grain` indices.
template <class F>
void for_each_index(Threads& exec, std::size_t n, F&& f, std::size_t grain = 1) {
  using Body = std::remove_reference_t<F>;
  Body* body = &f;
  exec.for_each_range(
      n, grain,
      [](void* data, std::size_t begin, std::size_t end) {
        Body& call = **static_cast<Body**>(data);
        for (std::size_t i = begin; i != end; ++i) call(i);
      },
      &body);
}

/// The same with `exec`'s threads, or on the calling thread if it is null.
template <class F>
void for_each_index(Threads* exec, std::size_t n, F&& f, std::size_t grain = 1) {
  if (exec != nullptr) return for_each_index(*exec, n, f, grain);
  for (std::size_t i = 0; i < n; ++i) f(i);
}

/// The same, begun in increasing order. With the largest tasks first this is list scheduling: at
/// most 4/3 of the shortest time (Graham, 1969). oneTBB by itself halves the range.
template <class F>
void for_each_in_order(Threads& exec, std::size_t n, F&& f) {
  using Body = std::remove_reference_t<F>;
  Body* body = &f;
  exec.for_each_next(
      n, [](void* data, std::size_t begin, std::size_t) { (**static_cast<Body**>(data))(begin); },
      &body);
}

}  // namespace rastrum::parallel
