// SPDX-License-Identifier: BSD-3-Clause
// Records what the loops of a backend do, and when, to find what keeps a frame from using more
// threads (`rastrum bench replay`).
//
// Cost: none without a scope but a look at a thread-local pointer a loop; with one two readings of
// the clock a body, and 32 bytes.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace rastrum::parallel {

/// The loops that a thread began on Threads within a RecordScope, in order. A loop within a body is
/// part of it. Times are in ns of the steady clock.
struct Recording {
  struct Task {
    std::size_t begin, end;  ///< indices that one body was called for
    std::int64_t begin_ns, end_ns;
  };
  struct Loop {
    std::int64_t begin_ns, end_ns;  ///< on the thread that began it
    std::size_t n, grain;
    bool in_order;            ///< by for_each_in_order: whoever is free takes the next index
    std::vector<Task> tasks;  ///< in the order in which they began; together they are [0, n)
  };
  std::vector<Loop> loops;
  /// Threads::concurrency returns this within the scope, so that a run on one thread cuts its work
  /// as one on so many would; 0: the true number.
  int workers = 0;

  [[nodiscard]] static std::int64_t now_ns() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }
};

/// While it lives, the loops that this thread begins are recorded.
class RecordScope {
 public:
  /// `recording` must outlive the scope.
  explicit RecordScope(Recording& recording) noexcept
      : RecordScope(&recording, recording.workers) {}
  /// Null: nothing is recorded.
  RecordScope(Recording* recording, int workers) noexcept;
  ~RecordScope();
  RecordScope(const RecordScope&) = delete;
  RecordScope& operator=(const RecordScope&) = delete;

  /// That of the calling thread, or null: none, or the thread is within a recorded body.
  [[nodiscard]] static Recording* current() noexcept;

 private:
  Recording* outer_;
  int outer_workers_;
};

}  // namespace rastrum::parallel
