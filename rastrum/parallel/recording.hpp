// SPDX-License-Identifier: BSD-3-Clause
// Records what a backend's loops do and when, to find what limits a frame's use of threads
// (`rastrum bench replay`).
//
// Cost: without a scope one read of a thread-local pointer per loop; with one, two clock readings
// and 32 bytes per body.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace rastrum::parallel {

/// The loops that a thread began on Threads within a RecordScope, in order. Inner loops count as
/// part of a body. Times are in ns of the steady clock.
struct Recording {
  struct Task {
    std::size_t begin, end;  ///< indices of one call of the body
    std::int64_t begin_ns, end_ns;
  };
  struct Loop {
    std::int64_t begin_ns, end_ns;  ///< on the thread that began it
    std::size_t n, grain;
    bool in_order;            ///< by for_each_in_order
    std::vector<Task> tasks;  ///< by begin_ns; together they are [0, n)
  };
  std::vector<Loop> loops;
  /// Threads::concurrency returns this within the scope, so that one thread cuts its work as this
  /// many would; 0: the true number.
  int workers = 0;

  [[nodiscard]] static std::int64_t now_ns() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }
};

/// While it lives, this thread's loops are recorded.
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

  /// The calling thread's recording; null without a scope or within a recorded body.
  [[nodiscard]] static Recording* current() noexcept;

 private:
  Recording* outer_;
  int outer_workers_;
};

}  // namespace rastrum::parallel
