// SPDX-License-Identifier: BSD-3-Clause
// The memory of the words. Blocks that a frame returns serve the next one, which saves fresh pages.
// Measured (Linux in a virtual machine): 80 MiB of fresh 4 KiB pages cost 43 ms, of 2 MiB pages 6.5
// ms, of kept ones nothing; sorting 10 M pairs in them takes about 40 ms.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <new>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

#include <rastrum/core/memory.hpp>

namespace rastrum::parallel {

/// Where an arena's blocks come from. Both functions are thread-safe.
struct MemorySource {
  /// Null where there is no memory; throws Error for other failures.
  void* (*allocate)(std::size_t bytes);
  void (*release)(void* block) noexcept;
  const char* name;  ///< of the memory, in messages
  /// Asking for a block stops the device, so the arena keeps all blocks until memory runs out.
  bool keeps_all = false;
};
/// The heap; large blocks in large pages.
[[nodiscard]] MemorySource host_memory();

/// Hands out blocks and keeps returned ones for reuse. Unless the source keeps all, it holds at
/// most what was out at one time. Thread-safe. Shared by its backend and its buffers.
class Arena {
 public:
  /// `account`, if any, counts all blocks that the arena holds. It must outlive the arena.
  explicit Arena(MemoryAccount* account = nullptr, MemorySource source = host_memory())
      : account_(account), source_(source) {}
  ~Arena() { trim(); }
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  /// Returns at least `bytes`, 64-byte aligned, uninitialized; large blocks in large pages where
  /// possible. Rounds up by at most a quarter, or to at most twice the size if the source keeps
  /// all, so that similar frames reuse blocks. Throws Error{out_of_memory}, and what the source
  /// throws.
  [[nodiscard]] void* allocate(std::size_t bytes);
  /// Takes back what allocate(bytes) returned.
  void release(void* block, std::size_t bytes) noexcept;

  void trim() noexcept;

  /// Bytes handed out.
  [[nodiscard]] std::uint64_t in_use() const;
  /// Bytes of all blocks, and the most that were handed out at one time.
  [[nodiscard]] std::uint64_t held() const;
  [[nodiscard]] std::uint64_t peak() const;

 private:
  struct Block {
    void* data;
    std::size_t bytes;
  };
  [[nodiscard]] std::size_t block_bytes(std::size_t bytes) const;
  [[nodiscard]] std::size_t fitting(std::size_t size) const;
  void lend(Block block);
  void drop_oldest() noexcept;

  MemoryAccount* account_;
  MemorySource source_;
  mutable std::mutex mutex_;
  std::vector<Block> kept_;  ///< oldest first
  std::unordered_map<void*, std::size_t>
      lent_;  ///< bytes; only if the source keeps all, where a block may be larger than asked for
  std::uint64_t kept_bytes_ = 0, in_use_ = 0, peak_ = 0;
};

/// Gives a std::vector memory of an arena, or of the heap. Elements without a constructor stay
/// uninitialized, because filling costs as much as the write that follows.
template <class T>
class ArenaAllocator {
 public:
  using value_type = T;
  using propagate_on_container_move_assignment = std::true_type;
  using propagate_on_container_copy_assignment = std::true_type;
  using propagate_on_container_swap = std::true_type;

  ArenaAllocator() noexcept = default;
  explicit ArenaAllocator(std::shared_ptr<Arena> arena) noexcept : arena_(std::move(arena)) {}
  template <class U>
  ArenaAllocator(const ArenaAllocator<U>& other) noexcept : arena_(other.arena()) {}

  [[nodiscard]] T* allocate(std::size_t n) {
    if (arena_) return static_cast<T*>(arena_->allocate(n * sizeof(T)));
    return std::allocator<T>().allocate(n);
  }
  void deallocate(T* p, std::size_t n) noexcept {
    if (arena_) return arena_->release(p, n * sizeof(T));
    std::allocator<T>().deallocate(p, n);
  }
  template <class U>
  void construct(U* p) noexcept(std::is_nothrow_default_constructible_v<U>) {
    ::new (static_cast<void*>(p)) U;
  }
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
  }
  [[nodiscard]] const std::shared_ptr<Arena>& arena() const noexcept { return arena_; }
  template <class U>
  [[nodiscard]] bool operator==(const ArenaAllocator<U>& other) const noexcept {
    return arena_ == other.arena();
  }

 private:
  std::shared_ptr<Arena> arena_;
};

/// The array that words allocate and return; elements without a constructor are uninitialized.
/// vector<bool> is not allowed, because threads write neighbouring elements: use bytes.
template <class T>
requires(!std::same_as<T, bool>) using Buffer = std::vector<T, ArenaAllocator<T>>;

/// `n` uninitialized elements in the memory of a backend.
template <class T, class Exec>
[[nodiscard]] Buffer<T> make_buffer(const Exec& exec, std::size_t n = 0) {
  return Buffer<T>(n, ArenaAllocator<T>(exec.memory()));
}

}  // namespace rastrum::parallel
