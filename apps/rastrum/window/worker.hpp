// SPDX-License-Identifier: BSD-3-Clause
// A thread beside the window's that draws frames and reads files, so that the window stays
// responsive.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace rastrum::cli::window {

class Worker {
 public:
  /// The rest of a job, for the window's thread.
  using Done = std::function<void()>;
  using Job = std::function<Done()>;

  Worker() : thread_([this] { run(); }) {}
  /// Waits for a running job, and drops its rest.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Whether a job runs or its end has not been polled.
  [[nodiscard]] bool busy() const { return busy_; }
  /// Requires !busy(). `job` must not throw.
  void submit(Job job);
  /// Does the rest of an ended job; returns whether there was one.
  bool poll();
  /// Waits for a running job, then polls.
  void wait();

 private:
  void run();

  bool busy_ = false;  ///< of the window's thread alone
  std::mutex mutex_;
  std::condition_variable changed_;
  Job job_;
  Done done_;
  bool stop_ = false;
  std::thread thread_;  ///< last: it uses the members above
};

}  // namespace rastrum::cli::window
