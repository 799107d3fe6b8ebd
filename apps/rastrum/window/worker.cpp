// SPDX-License-Identifier: BSD-3-Clause
#include "worker.hpp"

#include <cassert>
#include <utility>

namespace rastrum::cli::window {

Worker::~Worker() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Worker::run() {
  for (;;) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return stop_ || job_; });
      if (stop_) return;
      job = std::exchange(job_, nullptr);
    }
    Done done = job();
    job = nullptr;  // frees its data before the window learns of the end
    {
      const std::lock_guard lock(mutex_);
      done_ = std::move(done);
    }
    changed_.notify_all();
  }
}

void Worker::submit(Job job) {
  assert(!busy_ && job);
  busy_ = true;
  {
    const std::lock_guard lock(mutex_);
    job_ = std::move(job);
  }
  changed_.notify_all();
}

bool Worker::poll() {
  Done done;
  {
    const std::lock_guard lock(mutex_);
    done = std::exchange(done_, nullptr);
  }
  if (!done) return false;
  busy_ = false;
  done();
  return true;
}

void Worker::wait() {
  if (!busy_) return;
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return static_cast<bool>(done_); });
  }
  poll();
}

}  // namespace rastrum::cli::window
