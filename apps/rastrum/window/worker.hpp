// SPDX-License-Identifier: BSD-3-Clause
// One thread beside the window's: frames are drawn and files are read there, so that the window
// answers meanwhile.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace rastrum::cli::window {

class Worker {
 public:
  /// The rest of a job, to be done on the window's thread.
  using Done = std::function<void()>;
  using Job = std::function<Done()>;

  Worker() : thread_([this] { run(); }) {}
  /// Waits for a job that runs, and drops what it leaves.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Whether a job runs or its end has not been polled.
  [[nodiscard]] bool busy() const { return busy_; }
  /// Requires !busy(). `job` must not throw.
  void submit(Job job);
  /// Does what an ended job has left; says whether there was one.
  bool poll();
  /// Polls once the job that runs has ended; nothing where none runs.
  void wait();

 private:
  void run();

  bool busy_ = false;  ///< of the window's thread alone
  std::mutex mutex_;
  std::condition_variable changed_;
  Job job_;
  Done done_;
  bool stop_ = false;
  std::thread thread_;  ///< last: it uses all of the above
};

}  // namespace rastrum::cli::window
