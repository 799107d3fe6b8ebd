// SPDX-License-Identifier: BSD-3-Clause
// A work queue that grows: many producers, many consumers, and no capacity that could be exceeded.
// Items come out in chunks, so that a lock is paid per chunk; in which order is not specified.
//
// O(1) amortized per item. Memory: the items and what consumers' chunks had grown to.
// Source: the bin queues of paper 2, section on large triangles, where they are arrays with a fixed
// size that may overflow. oneTBB's concurrent_queue is larger (over a kilobyte when empty, and a
// frame wants one per bin), and hands out single items.
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
  /// Chunks have at most `per_chunk` > 0 items; smaller ones only where there are no more.
  /// Items lie in `memory`, or on the heap where there is none.
  explicit WorkQueue(std::size_t per_chunk = 32, std::shared_ptr<Arena> memory = nullptr)
      : items_(ArenaAllocator<T>(std::move(memory))), per_chunk_(per_chunk) {}

  void push(std::span<const T> items) {
    const std::lock_guard lock(mutex_);
    items_.insert(items_.end(), items.begin(), items.end());
  }
  void push(const T& item) { push(std::span(&item, 1)); }

  /// Replaces `chunk` by items that nobody else gets; false where there are none at the moment.
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
