// A work queue that grows: many producers, many consumers, and no capacity that could be exceeded.
// Items come out in chunks, so that a lock is paid per chunk; in which order is not specified.
//
// O(1) amortized per item. Memory: the items and what consumers' chunks had grown to.
// Source: the bin queues of paper 2, section on large triangles, where they are arrays with a fixed
// size that may overflow. oneTBB's concurrent_queue is larger (over a kilobyte when empty, and a
// frame wants one per bin), hands out single items, and does not know when all work is done.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include <rastrum/parallel/arena.hpp>
#include <rastrum/parallel/exec.hpp>

namespace rastrum::parallel {

template <class T>
class WorkQueue {
 public:
  /// Chunks have at most `per_chunk` > 0 items; smaller ones only where there are no more.
  /// Items lie in `memory`, or on the heap where there is none.
  explicit WorkQueue(std::size_t per_chunk = 32, std::shared_ptr<Arena> memory = nullptr)
      : items_(ArenaAllocator<T>(std::move(memory))), per_chunk_(per_chunk) {}

  void push(std::span<const T> items) {
    {
      const std::lock_guard lock(mutex_);
      items_.insert(items_.end(), items.begin(), items.end());
    }
    changed_.notify_one();
  }
  void push(const T& item) { push(std::span(&item, 1)); }

  /// Replaces `chunk` by items that nobody else gets; false where there are none at the moment.
  [[nodiscard]] bool try_pop(std::vector<T>& chunk) {
    const std::lock_guard lock(mutex_);
    return take(chunk);
  }

  /// Items that wait at the moment.
  [[nodiscard]] std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return items_.size();
  }

  /// Calls f(worker, std::span<const T> chunk, queue) by all threads of `exec` until all work is
  /// done: the queue is empty, and nobody is at work who could push. worker < concurrency; f may
  /// push, and must not start loops on `exec`. What f throws is passed on, and items may be left.
  template <class Exec, class F>
  void work_off(Exec& exec, F&& f) {
    for_each_index(exec, static_cast<std::size_t>(exec.concurrency()), [&](std::size_t worker) {
      std::vector<T> chunk;
      while (wait_pop(chunk)) {
        const AtWork at_work(*this);
        f(worker, std::span<const T>(chunk), *this);
      }
    });
  }

 private:
  /// Between wait_pop and the end of the work on its chunk, also when that throws.
  class AtWork {
   public:
    explicit AtWork(WorkQueue& queue) : queue_(queue) {}
    ~AtWork() {
      {
        const std::lock_guard lock(queue_.mutex_);
        --queue_.at_work_;
      }
      queue_.changed_.notify_all();
    }
    AtWork(const AtWork&) = delete;
    AtWork& operator=(const AtWork&) = delete;

   private:
    WorkQueue& queue_;
  };

  bool take(std::vector<T>& chunk) {
    chunk.clear();
    if (items_.empty()) return false;
    const auto n = static_cast<std::ptrdiff_t>(std::min(per_chunk_, items_.size()));
    chunk.assign(items_.end() - n, items_.end());
    items_.erase(items_.end() - n, items_.end());
    return true;
  }
  /// Waits for items; false where there will be none.
  bool wait_pop(std::vector<T>& chunk) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !items_.empty() || at_work_ == 0; });
    if (!take(chunk)) return false;
    ++at_work_;
    return true;
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Buffer<T> items_;
  std::size_t per_chunk_;
  int at_work_ = 0;
};

}  // namespace rastrum::parallel
