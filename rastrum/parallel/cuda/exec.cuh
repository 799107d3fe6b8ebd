// SPDX-License-Identifier: BSD-3-Clause
// The execution context of a CUDA device: a stream, and memory that is pooled for it.
//
// Words are overloads on Cuda of those in rastrum/parallel, with the same names and arguments.
// - What they read and write is memory of the device: DeviceBuffer, std::span over device pointers,
//   or anything small with a size and an operator[] that the device can call (range.hpp). Views are
//   copied into kernels. Nothing is moved between host and device but where it is asked for.
// - Functors carry RASTRUM_HD, are copied, and may refer to memory of the device only. Give them
//   names: nvcc takes no lambda of a host function.
// - Work goes to the stream in order. A word that returns a number waits for it; a sum that a scan
//   returns waits when it is asked for (Pending); the others return at once.
// - Memory comes from an arena that keeps all blocks until trim(), so that a frame like the one
//   before allocates nothing. A block that was given back is used again by later work of the same
//   stream alone, so no one waits.
// - The results are the CPU's, bit for bit. Where the order of operands could change a bit (floats,
//   functions of the caller's) they are folded in the same cut as there, by a thread a block of
//   kBlock; else by Thrust's trees (kAnyOrder).
//
// For translation units of nvcc; or of a C++ compiler, on the CPU (system.cuh). Sources: CCCL
// (Thrust, CUB); docs/decisions/0014.
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
  /// A stream of its own on the current device. Memory that words take is accounted to `account`,
  /// which must outlive the context and the words' results. Throws Error{no_device}; whether there
  /// is a device says cuda_status() (status.hpp).
  explicit Cuda(MemoryAccount* account = nullptr)
      : owned_(true),
        device_(cuda_system::current_device()),
        stream_(cuda_system::make_stream()),
        memory_(make_arena(account, cuda_system::memory_source())),
        pinned_(make_arena(nullptr, cuda_system::pinned_source())) {}
  /// On a stream of the caller's, of the current device, which must outlive it and its results.
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
  /// Host memory into which copies from the device go without waiting (pinned_buffer). Not
  /// accounted: it is as large as the memory that the caller must have for the result anyway.
  [[nodiscard]] const std::shared_ptr<Arena>& pinned() const { return pinned_; }
  [[nodiscard]] cuda_system::Stream stream() const { return stream_; }
  /// The device that was current where the context was made. It must be current where words are
  /// called: on_device_of().
  [[nodiscard]] int device() const { return device_; }
  /// Waits until all work that was given to the stream is done. Throws Error{no_device} for what
  /// went wrong there.
  void wait() const {
    cuda_system::wait(stream_);
    staged_.clear();
  }
  /// The same after an error: the stream no longer reads or writes memory that the host frees.
  void settle() const noexcept {
    try {
      wait();
    } catch (...) {
      // The error is known already, and a device that failed does nothing more.
    }
  }
  /// Keeps `source` until the stream was waited for.
  void keep(std::shared_ptr<const void> source) { staged_.push_back(std::move(source)); }

  /// Thrust's, for algorithms beside the words: does not wait, and takes its scratch from memory().
  [[nodiscard]] auto policy() { return cuda_system::policy(scratch_, stream_); }

 private:
  /// As Thrust wants it.
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

/// f() where the context's device is current, whatever is current for the caller; all that fails is
/// an Error. Around what others call of the device's code.
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

/// Calls f(i, local) for i in [0, n), by as many threads as the device holds at once, each of which
/// has a Local of its own, empty at first, and at last calls f.end(local): for sums, which then go
/// to memory once a thread. `n` may lie on the device. Work O(n).
template <class Local, class F>
void for_each_strided(Cuda& exec, LoopCount n, F f) {
  cuda_system::launch_strided<Local>(exec.stream(), n, f);
}

/// Calls f(i, local, T& scratch, team) as for_each_team, by as many teams as the device holds at
/// once, each member with a Local of its own as for_each_strided has them.
template <class Local, class T, int kThreads = 32, class F>
void for_each_team_strided(Cuda& exec, LoopCount n, const F& f) {
  static_assert(std::is_trivially_default_constructible_v<T>);
  cuda_system::launch_strided_teams<Local, T, kThreads>(exec.stream(), n, f);
}

/// Calls f(i, T& scratch, team) for i in [0, n) by all members of a team together: a block of
/// kThreads threads, with `scratch` in shared memory, uninitialized and theirs alone. A member has
/// team.rank() < team.size() and meets the others at team.sync(), which all must reach. A body is
/// right for any size of team: shares of work are strides of it. kResident: teams that a
/// multiprocessor is to hold at least, which leaves a thread fewer registers; 0: as the compiler
/// likes.
template <class T, int kThreads = 128, int kResident = 0, class F>
void for_each_team(Cuda& exec, LoopCount n, F&& f) {
  static_assert(std::is_trivially_default_constructible_v<T>);
  cuda_system::launch_teams<T, kThreads, kResident, std::decay_t<F>>(exec.stream(), n, f);
}

}  // namespace rastrum::parallel
