// SPDX-License-Identifier: BSD-3-Clause
// A work queue that grows: many producers, many consumers, no fixed capacity. Items come out in
// chunks, so that a lock is paid per chunk. The order is unspecified.
//
// O(1) amortized per item. Source: the bin queues of paper 2, section on large triangles, whose
// fixed size may overflow. oneTBB's concurrent_queue is larger (over a kilobyte when empty; a frame
// wants one per bin) and hands out single items.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include <rastrum/parallel/arena.hpp>

namespace rastrum::parallel {

template <class T>
class WorkQueue {
 public:
  /// Chunks have at most `per_chunk` > 0 items, and fewer only if there are no more. Items lie in
  /// `memory`, or on the heap without one.
  explicit WorkQueue(std::size_t per_chunk = 32, std::shared_ptr<Arena> memory = nullptr)
      : items_(ArenaAllocator<T>(std::move(memory))), per_chunk_(per_chunk) {}

  void push(std::span<const T> items) {
    const std::lock_guard lock(mutex_);
    items_.insert(items_.end(), items.begin(), items.end());
  }
  void push(const T& item) { push(std::span(&item, 1)); }

  /// Replaces `chunk` by items that nobody else gets; false if there are none now.
  [[nodiscard]] bool try_pop(std::vector<T>& chunk) {
    const std::lock_guard lock(mutex_);
    chunk.clear();
    if (items_.empty()) return false;
    const auto n = static_cast<std::ptrdiff_t>(std::min(per_chunk_, items_.size()));
    chunk.assign(items_.end() - n, items_.end());
    items_.erase(items_.end() - n, items_.end());
    return true;
  }

 private:
  std::mutex mutex_;
  Buffer<T> items_;
  std::size_t per_chunk_;
};

}  // namespace rastrum::parallel
