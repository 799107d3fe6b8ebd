// SPDX-License-Identifier: BSD-3-Clause
// The memory of the words: blocks that go back to an arena and come out of it again, so that a
// frame does not pay for pages that the frame before had. Measured here (Linux in a virtual
// machine): 80 MiB of fresh 4 KiB pages cost 43 ms, of 2 MiB pages 6.5 ms, of kept ones nothing;
// sorting 10 M pairs in them takes about 40.
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
  /// Null where there is none; throws Error for what else goes wrong.
  void* (*allocate)(std::size_t bytes);
  void (*release)(void* block) noexcept;
  const char* name;  ///< of the memory, in messages
  /// Asking for a block stops the device: all of any size are kept, and go back only to be asked
  /// for again in another size.
  bool keeps_all = false;
};
/// The heap; large blocks in large pages.
[[nodiscard]] MemorySource host_memory();

/// Hands out blocks, and keeps those that come back, up to the most that was out at one time: what
/// it holds never exceeds that, unless the source is to be asked as seldom as can be. Thread-safe.
/// Shared by its backend and by the buffers that came from it, whichever lives longest.
class Arena {
 public:
  /// Blocks are accounted to `account`, where there is one, while the arena holds them, handed out
  /// or not; it must outlive the arena.
  explicit Arena(MemoryAccount* account = nullptr, MemorySource source = host_memory())
      : account_(account), source_(source) {}
  ~Arena() { trim(); }
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  /// At least `bytes`, 64-byte aligned, uninitialized; large ones in large pages where the system
  /// has them. Sizes are rounded up by at most a quarter, so that frames of about one size fit into
  /// each other's blocks; where all blocks are kept, one of up to twice the size may come. Throws
  /// Error{out_of_memory} with what was asked for, and as the source.
  [[nodiscard]] void* allocate(std::size_t bytes);
  /// Takes back what allocate(bytes) returned.
  void release(void* block, std::size_t bytes) noexcept;

  /// Gives all kept blocks back to the system.
  void trim() noexcept;

  /// Bytes of the blocks that are handed out.
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
      lent_;  ///< bytes; where a block may be larger than asked for
  std::uint64_t kept_bytes_ = 0, in_use_ = 0, peak_ = 0;
};

/// Gives a std::vector memory of an arena, or of the heap where there is none, and leaves elements
/// without a constructor uninitialized: filling what is about to be written costs as much again.
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

/// The array that words allocate and return: a std::vector whose elements are not initialized
/// unless they have a constructor. Different threads write neighbouring elements, so these must be
/// distinct memory; vector<bool>'s are not: return bytes instead.
template <class T>
requires(!std::same_as<T, bool>) using Buffer = std::vector<T, ArenaAllocator<T>>;

/// `n` uninitialized elements in the memory of a backend.
template <class T, class Exec>
[[nodiscard]] Buffer<T> make_buffer(const Exec& exec, std::size_t n = 0) {
  return Buffer<T>(n, ArenaAllocator<T>(exec.memory()));
}

}  // namespace rastrum::parallel
