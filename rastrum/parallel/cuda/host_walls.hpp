// SPDX-License-Identifier: BSD-3-Clause
// Separates host and device memory where the CPU stands in for a device, under clang's address
// sanitizer. The device's blocks are poisoned except while kernels, copies and algorithms run; the
// host's heap is poisoned while kernels run. So host code that reads device memory, and functors
// that refer to host memory, are reported. Without that sanitizer this does nothing.
#pragma once

#include <cstddef>

#if defined(__SANITIZE_ADDRESS__)
#define RASTRUM_ADDRESS_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define RASTRUM_ADDRESS_SANITIZER 1
#endif
#endif
// clang only: GCC lacks the header of the hooks.
#if defined(RASTRUM_ADDRESS_SANITIZER) && __has_include(<sanitizer/allocator_interface.h>)
#define RASTRUM_WALLS 1
#endif

#if defined(RASTRUM_WALLS)
#include <sanitizer/allocator_interface.h>
#include <sanitizer/asan_interface.h>

#include <mutex>
#include <unordered_map>
#endif

namespace rastrum::parallel::cuda_system {

#if defined(RASTRUM_WALLS)

class Walls {
 public:
  static constexpr bool kCanStand = true;

  /// Turns the separation on for later allocations. The program must keep both memories apart, and
  /// its other threads must rest while a kernel runs.
  static void stand() {
    State& s = state();
    const std::lock_guard lock(s.mutex);
    if (s.stand) return;
    s.stand = true;
    __sanitizer_install_malloc_and_free_hooks(on_malloc, on_free);
  }
  /// While one lives, allocations do not count as the host's: those of this class, and stacks of
  /// kernels.
  struct Unseen {
    Unseen() { ++depth(); }
    ~Unseen() { --depth(); }
    Unseen(const Unseen&) = delete;
    Unseen& operator=(const Unseen&) = delete;
    static int& depth() {
      thread_local int depth = 0;
      return depth;
    }
  };
  /// Marks a block as the device's (add) or as the heap's again (remove).
  static void add(void* block, std::size_t bytes) {
    State& s = state();
    const Unseen unseen;
    const std::lock_guard lock(s.mutex);
    if (!s.stand || block == nullptr) return;
    s.host.erase(block);
    s.device[block] = bytes;
    if (s.inside == 0) ASAN_POISON_MEMORY_REGION(block, bytes);
  }
  static void remove(void* block) noexcept {
    State& s = state();
    const Unseen unseen;
    const std::lock_guard lock(s.mutex);
    const auto at = s.device.find(block);
    if (at == s.device.end()) return;
    ASAN_UNPOISON_MEMORY_REGION(block, at->second);
    s.device.erase(at);
  }

  /// While one lives, device memory is accessible: for copies, and for algorithms, whose scratch
  /// comes from the host's arena.
  class Device {
   public:
    Device() { enter(); }
    Device(const Device&) : Device() {}
    Device& operator=(const Device&) = default;
    ~Device() {
      State& s = state();
      const std::lock_guard lock(s.mutex);
      if (--s.inside > 0) return;
      for (const auto& [block, bytes] : s.device) ASAN_POISON_MEMORY_REGION(block, bytes);
    }

   private:
    static void enter() {
      State& s = state();
      const std::lock_guard lock(s.mutex);
      if (s.inside++ > 0) return;
      for (const auto& [block, bytes] : s.device) ASAN_UNPOISON_MEMORY_REGION(block, bytes);
    }
  };
  /// While one lives, the host's heap is poisoned too, except blocks below kLeast and new ones.
  class Kernel {
   public:
    Kernel() {
      State& s = state();
      const std::lock_guard lock(s.mutex);
      if (s.in_kernels++ > 0) return;
      for (const auto& [block, bytes] : s.host) ASAN_POISON_MEMORY_REGION(block, bytes);
    }
    Kernel(const Kernel&) = delete;
    Kernel& operator=(const Kernel&) = delete;
    ~Kernel() {
      State& s = state();
      const std::lock_guard lock(s.mutex);
      if (--s.in_kernels > 0) return;
      for (const auto& [block, bytes] : s.host) ASAN_UNPOISON_MEMORY_REGION(block, bytes);
    }

   private:
    Device device_;
  };

 private:
  /// There are too many smaller blocks.
  static constexpr std::size_t kLeast = 256;
  struct State {
    std::mutex mutex;
    bool stand = false;
    int inside = 0, in_kernels = 0;
    std::unordered_map<void*, std::size_t> device, host;
  };
  /// Never destroyed, because the hooks outlive everything else.
  static State& state() {
    static State* const state = new State;
    return *state;
  }
  static void on_malloc(const volatile void* block, std::size_t bytes) {
    if (Unseen::depth() > 0 || bytes < kLeast || block == nullptr) return;
    const Unseen unseen;
    State& s = state();
    const std::lock_guard lock(s.mutex);
    s.host[const_cast<void*>(block)] = bytes;
  }
  static void on_free(const volatile void* block) {
    if (Unseen::depth() > 0 || block == nullptr || __sanitizer_get_allocated_size(block) < kLeast)
      return;
    const Unseen unseen;
    State& s = state();
    const std::lock_guard lock(s.mutex);
    s.host.erase(const_cast<void*>(block));
  }
};

#else

struct Walls {
  static constexpr bool kCanStand = false;
  static void stand() {}
  static void add(void*, std::size_t) {}
  static void remove(void*) noexcept {}
  struct Unseen {
    Unseen() {}  // avoids warnings about unused variables
  };
  struct Device {
    Device() {}
  };
  struct Kernel {
    Kernel() {}
  };
};

#endif

}  // namespace rastrum::parallel::cuda_system
