// SPDX-License-Identifier: BSD-3-Clause
// Backends of the data-parallel words. A word is a function template whose first argument is the
// backend; `Serial` implements each in the plainest loop and is the reference of the others.
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

#include <rastrum/parallel/arena.hpp>

namespace rastrum::parallel {

/// One thread, plain loops.
class Serial {
 public:
  /// Words take their memory from an arena that is accounted to `account`, which must outlive the
  /// backend and the words' results.
  explicit Serial(MemoryAccount* account = nullptr) : memory_(std::make_shared<Arena>(account)) {}
  /// Within a loop of another backend: words take their memory from its arena.
  explicit Serial(std::shared_ptr<Arena> memory) : memory_(std::move(memory)) {}
  [[nodiscard]] static int concurrency() { return 1; }
  [[nodiscard]] const std::shared_ptr<Arena>& memory() const { return memory_; }

 private:
  std::shared_ptr<Arena> memory_;
};

/// oneTBB in an arena of its own. Keep it alive between frames: starting threads costs more than a
/// small frame.
class Threads {
 public:
  /// `count` threads, the caller's included; 0 takes what the machine has.
  /// More threads than cores are had as well: oneTBB would cap them. Memory as in Serial.
  explicit Threads(int count = 0, MemoryAccount* account = nullptr);
  ~Threads();
  [[nodiscard]] int concurrency() const;
  [[nodiscard]] const std::shared_ptr<Arena>& memory() const { return memory_; }

  /// The function that a loop calls for the indices [begin, end).
  using Body = void (*)(void* data, std::size_t begin, std::size_t end);
  /// Calls body(data, begin, end) for ranges that make up [0, n), of at most `grain` indices each;
  /// what the bodies wrote is visible to the caller afterwards. The loop behind for_each_index.
  void for_each_range(std::size_t n, std::size_t grain, Body body, void* data);
  /// The same for single indices: a thread that is free takes the next one. The loop behind
  /// for_each_in_order.
  void for_each_next(std::size_t n, Body body, void* data);

 private:
  template <class Share>
  void loop(std::size_t n, std::size_t grain, const Share& share);
  struct Scheduler;  // oneTBB's headers, twice what most sources parse else, stay in exec.cpp
  std::unique_ptr<Scheduler> scheduler_;
  std::shared_ptr<Arena> memory_;
};

/// Calls f(i) for i in [0, n). Work O(n), span O(1) on serial's terms, O(log n) with threads.
template <class F>
void for_each_index(Serial&, std::size_t n, F&& f) {
  for (std::size_t i = 0; i < n; ++i) f(i);
}

/// The same; at most `grain` indices are handed out at a time.
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

/// The same by the threads that there are; null: by the caller alone.
template <class F>
void for_each_index(Threads* exec, std::size_t n, F&& f, std::size_t grain = 1) {
  if (exec != nullptr) return for_each_index(*exec, n, f, grain);
  for (std::size_t i = 0; i < n; ++i) f(i);
}

/// The same, and indices are begun in increasing order by whoever is free, so that the largest
/// tasks can come first: list scheduling, whose longest thread then takes at most 4/3 of the
/// shortest possible (Graham, 1969). oneTBB's own order is by halves of the range.
template <class F>
void for_each_in_order(Threads& exec, std::size_t n, F&& f) {
  using Body = std::remove_reference_t<F>;
  Body* body = &f;
  exec.for_each_next(
      n, [](void* data, std::size_t begin, std::size_t) { (**static_cast<Body**>(data))(begin); },
      &body);
}

}  // namespace rastrum::parallel
