// SPDX-License-Identifier: BSD-3-Clause
// Requests a stop at one of many calls and counts the calls that begin after it, from any thread.
// It does not compare call numbers, because the requesting thread may sleep before its request. The
// request counts once request_stop() has returned.
#pragma once

#include <atomic>
#include <cstdint>
#include <stop_token>

namespace rastrum::test {

class StopTrigger {
 public:
  /// `at`: the call that requests the stop, from 0; none if negative.
  explicit StopTrigger(std::int64_t at = -1) : at_(at) {}

  /// Before the first call.
  void stop_at(std::int64_t call) { at_ = call; }
  void call() {
    if (asked_.load(std::memory_order_acquire)) {
      after_.fetch_add(1, std::memory_order_relaxed);
    } else if (before_.fetch_add(1, std::memory_order_relaxed) == at_) {
      source_.request_stop();
      asked_.store(true, std::memory_order_release);
    }
  }
  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }
  /// Calls in all.
  [[nodiscard]] std::int64_t calls() const { return before_ + after_; }
  [[nodiscard]] std::int64_t after() const { return after_; }

 private:
  std::int64_t at_;
  std::atomic<std::int64_t> before_ = 0, after_ = 0;
  std::atomic<bool> asked_ = false;
  std::stop_source source_;
};

}  // namespace rastrum::test
