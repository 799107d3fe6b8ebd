// SPDX-License-Identifier: BSD-3-Clause
// A device's stream on the CPU, for tests: it can work late as a GPU does, and fail on request
// where a driver may.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

#include <rastrum/parallel/cuda/host_walls.hpp>

namespace rastrum::parallel::cuda_system {

/// Makes one call of a device fail, among those that a driver may refuse: memory, copies, launches,
/// waits, Thrust's algorithms. Counted per thread.
struct DeviceFaults {
  std::uint64_t calls = 0;
  std::uint64_t fails_at = 0;  ///< 0: none

  /// Counts a call; true if this is the one that fails.
  [[nodiscard]] static bool strikes() {
    DeviceFaults& faults = of_thread();
    return ++faults.calls == faults.fails_at;
  }
  [[nodiscard]] static DeviceFaults& of_thread() {
    thread_local DeviceFaults faults;
    return faults;
  }
};

/// Work in order. A late stream works only when the host waits, so that a result read too early or
/// a source freed too soon is wrong in every run.
class HostStream {
 public:
  /// For all streams; must not be called while one has work.
  static void be_late(bool late) { late_ = late; }

  HostStream() {
    const std::lock_guard lock(all_mutex_);
    all_.push_back(this);
  }
  ~HostStream() {
    const std::lock_guard lock(all_mutex_);
    all_.erase(std::find(all_.begin(), all_.end(), this));
  }
  HostStream(const HostStream&) = delete;
  HostStream& operator=(const HostStream&) = delete;

  template <class F>
  void add(F work) {
    if (!late_) return work();
    const std::lock_guard lock(mutex_);
    work_.emplace_back(std::move(work));
  }
  void run() {
    const std::lock_guard lock(mutex_);
    if (work_.empty()) return;
    const Walls::Device open;
    for (const auto& work : work_) work();
    work_.clear();
  }
  /// A failed device does nothing of what is pending.
  void drop() {
    const std::lock_guard lock(mutex_);
    work_.clear();
  }
  /// Freeing memory waits for all work of the device.
  static void run_all() {
    const std::lock_guard lock(all_mutex_);
    for (HostStream* const stream : all_) stream->run();
  }

 private:
  static inline bool late_ = false;
  static inline std::mutex all_mutex_;
  static inline std::vector<HostStream*> all_;
  std::mutex mutex_;
  std::vector<std::function<void()>> work_;
};

}  // namespace rastrum::parallel::cuda_system
