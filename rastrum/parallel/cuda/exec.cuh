// SPDX-License-Identifier: BSD-3-Clause
// The execution context of a CUDA device: a stream and its memory pool.
//
// Each word of rastrum/parallel has an overload on Cuda with the same name and arguments.
// - Words read and write device memory: DeviceBuffer, std::span over device pointers, or anything
//   small with a size and an operator[] that the device can call (range.hpp). Only explicit copies
//   move data between host and device.
// - Functors carry RASTRUM_HD, are copied, and refer to device memory only. They are named types,
//   because nvcc takes no lambda of a host function.
// - Work goes to the stream in order. A word that returns a number waits for it; the sum of a scan
//   waits when it is read (Pending); the others return at once.
// - An arena keeps all blocks until trim(), so that a similar frame allocates nothing. Returned
//   blocks serve only later work of the same stream, so nothing waits.
// - The results are the CPU's, bit for bit. If the order of operands could change a bit (floats,
//   callers' functions), a thread folds each block of kBlock as the CPU does; otherwise Thrust's
//   trees do (kAnyOrder).
//
// For nvcc, or for a C++ compiler on the CPU (system.cuh). Sources: CCCL (Thrust, CUB);
// docs/decisions/0014.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <rastrum/parallel/cuda/loop_count.hpp>
#include <rastrum/parallel/cuda/system.cuh>
#include <rastrum/parallel/exec.hpp>

namespace rastrum::parallel {

inline namespace RASTRUM_DEVICE_SYSTEM {

class Cuda {
 public:
  /// Makes a stream on the current device. `account` counts the words' memory; it must outlive the
  /// context and the words' results. Throws Error{no_device}; ask cuda_status() (status.hpp)
  /// before.
  explicit Cuda(MemoryAccount* account = nullptr)
      : owned_(true),
        device_(cuda_system::current_device()),
        stream_(cuda_system::make_stream()),
        memory_(make_arena(account, cuda_system::memory_source())),
        pinned_(make_arena(nullptr, cuda_system::pinned_source())) {}
  /// Uses the caller's stream on the current device. It must outlive the context and its results.
  explicit Cuda(cuda_system::Stream stream, MemoryAccount* account = nullptr)
      : owned_(false),
        device_(cuda_system::current_device()),
        stream_(stream),
        memory_(make_arena(account, cuda_system::memory_source())),
        pinned_(make_arena(nullptr, cuda_system::pinned_source())) {}
  ~Cuda() {
    if (owned_) cuda_system::destroy_stream(stream_);
  }
  Cuda(const Cuda&) = delete;
  Cuda& operator=(const Cuda&) = delete;

  [[nodiscard]] const std::shared_ptr<Arena>& memory() const { return memory_; }
  /// Host memory to which the device copies without waiting (pinned_buffer). Not accounted: it is
  /// no larger than the caller's memory for the result.
  [[nodiscard]] const std::shared_ptr<Arena>& pinned() const { return pinned_; }
  [[nodiscard]] cuda_system::Stream stream() const { return stream_; }
  /// The device that was current when the context was made. Words need it current: on_device_of().
  [[nodiscard]] int device() const { return device_; }
  /// Waits until all work of the stream is done. Throws Error{no_device} if that failed.
  void wait() const {
    cuda_system::wait(stream_);
    staged_.clear();
  }
  /// The same after an error, so that the stream no longer uses memory that the host frees.
  void settle() const noexcept {
    try {
      wait();
    } catch (...) {
      // The error is already known, and a failed device does nothing more.
    }
  }
  /// Keeps `source` until the stream was waited for.
  void keep(std::shared_ptr<const void> source) { staged_.push_back(std::move(source)); }

  /// Thrust's policy, for algorithms beside the words. Does not wait; scratch comes from memory().
  [[nodiscard]] auto policy() { return cuda_system::policy(scratch_, stream_); }

 private:
  /// An allocator for Thrust.
  struct Scratch {
    using value_type = char;
    Arena* arena;
    [[nodiscard]] char* allocate(std::ptrdiff_t n) {
      return static_cast<char*>(arena->allocate(static_cast<std::size_t>(n)));
    }
    void deallocate(char* p, std::size_t n) noexcept { arena->release(p, n); }
  };
  static std::shared_ptr<Arena> make_arena(MemoryAccount* account, MemorySource source) {
    return std::make_shared<Arena>(account, source);
  }

  mutable std::vector<std::shared_ptr<const void>> staged_;  ///< sources of copies under way
  bool owned_;
  int device_;
  cuda_system::Stream stream_;
  std::shared_ptr<Arena> memory_, pinned_;
  Scratch scratch_{memory_.get()};
};

}  // namespace RASTRUM_DEVICE_SYSTEM

/// Returns f() with the context's device current; every failure is an Error. For entry points of
/// device code.
template <class F>
decltype(auto) on_device_of(const Cuda& exec, F&& f) {
  const cuda_system::DeviceScope scope(exec.device());
  try {
    return cuda_system::with_errors(std::forward<F>(f));
  } catch (...) {
    exec.settle();
    throw;
  }
}

/// Calls f(i) for i in [0, n). Work O(n), span O(1).
template <class F>
void for_each_index(Cuda& exec, std::size_t n, F f) {
  cuda_system::launch_indices(exec.stream(), n, f);
}

/// Calls f(i, local) for i in [0, n) on as many threads as the device holds at once. Each has its
/// own Local{}, and calls f.end(local) last: for sums that go to memory once per thread. `n` may
/// lie on the device. Work O(n).
template <class Local, class F>
void for_each_strided(Cuda& exec, LoopCount n, F f) {
  cuda_system::launch_strided<Local>(exec.stream(), n, f);
}

/// Calls f(i, local, T& scratch, team) as for_each_team does, on as many teams as the device holds
/// at once. Each member has its own Local as in for_each_strided.
template <class Local, class T, int kThreads = 32, class F>
void for_each_team_strided(Cuda& exec, LoopCount n, const F& f) {
  static_assert(std::is_trivially_default_constructible_v<T>);
  cuda_system::launch_strided_teams<Local, T, kThreads>(exec.stream(), n, f);
}

/// Calls f(i, T& scratch, team) for i in [0, n) on a team: a block of kThreads threads that share
/// `scratch`, uninitialized, in shared memory. All members must reach each team.sync(). A body must
/// be right for any team.size(): members take strides of the work. kResident: the fewest teams that
/// a multiprocessor holds, which limits registers; 0: the compiler's choice.
template <class T, int kThreads = 128, int kResident = 0, class F>
void for_each_team(Cuda& exec, LoopCount n, F&& f) {
  static_assert(std::is_trivially_default_constructible_v<T>);
  cuda_system::launch_teams<T, kThreads, kResident, std::decay_t<F>>(exec.stream(), n, f);
}

}  // namespace rastrum::parallel
