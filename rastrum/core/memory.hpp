// SPDX-License-Identifier: BSD-3-Clause
// Scratch memory that frames reuse and an account counts, so that a render can report its peak.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include <rastrum/core/aligned_memory.hpp>
#include <rastrum/error.hpp>

namespace rastrum {

/// Bytes held now, and the most since the last `restart_peak`. Thread-safe.
class MemoryAccount {
 public:
  void add(std::size_t bytes) noexcept {
    const std::uint64_t now = held_.fetch_add(bytes, std::memory_order_relaxed) + bytes;
    std::uint64_t peak = peak_.load(std::memory_order_relaxed);
    while (now > peak && !peak_.compare_exchange_weak(peak, now, std::memory_order_relaxed)) {
    }
  }
  void remove(std::size_t bytes) noexcept { held_.fetch_sub(bytes, std::memory_order_relaxed); }
  void restart_peak() noexcept { peak_ = held_.load(); }
  [[nodiscard]] std::uint64_t peak() const noexcept { return peak_; }
  [[nodiscard]] std::uint64_t held() const noexcept { return held_; }

 private:
  std::atomic<std::uint64_t> held_ = 0, peak_ = 0;
};

/// A growing array of trivial elements, uninitialized, which never shrinks. 64-byte aligned. The
/// account must outlive it.
template <class T>
class ScratchBuffer {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  explicit ScratchBuffer(MemoryAccount& account) noexcept : account_(&account) {}
  ScratchBuffer(ScratchBuffer&& other) noexcept
      : account_(other.account_),
        data_(std::move(other.data_)),
        capacity_(std::exchange(other.capacity_, 0)) {}
  ScratchBuffer& operator=(ScratchBuffer&&) = delete;
  ~ScratchBuffer() { release(); }

  /// Makes room for `count` elements; the first `keep` survive. Throws Error{out_of_memory} with
  /// the size asked for.
  void reserve(std::size_t count, std::size_t keep = 0) {
    if (count <= capacity_) return;
    if (count > (std::numeric_limits<std::size_t>::max() - 63) / sizeof(T)) fail(count);
    // Without survivors the old memory goes first, so that both are never held at once.
    if (keep == 0) release();
    const std::size_t bytes = (count * sizeof(T) + 63) / 64 * 64;
    std::unique_ptr<T[], Free> grown(static_cast<T*>(aligned_allocate(64, bytes)));
    if (!grown) fail(count);
    std::copy_n(data_.get(), keep, grown.get());
    account_->add(count * sizeof(T));
    release();
    data_ = std::move(grown);
    capacity_ = count;
  }
  /// Like reserve, but at least doubles: for appending, amortized O(1) per element.
  void grow(std::size_t count, std::size_t keep) {
    if (count > capacity_) reserve(std::max(count, capacity_ * 2), keep);
  }
  [[nodiscard]] T* data() noexcept { return data_.get(); }
  [[nodiscard]] const T* data() const noexcept { return data_.get(); }
  [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }
  [[nodiscard]] T& operator[](std::size_t i) noexcept { return data_[i]; }
  [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return data_[i]; }

 private:
  struct Free {
    void operator()(T* p) const noexcept { aligned_free(p); }
  };
  void release() noexcept {
    data_.reset();
    account_->remove(std::exchange(capacity_, 0) * sizeof(T));
  }
  [[noreturn]] static void fail(std::size_t count) {
    throw Error(Errc::out_of_memory, "out of memory: " + std::to_string(count) + " elements of " +
                                         std::to_string(sizeof(T)) + " bytes were asked for");
  }
  MemoryAccount* account_;
  std::unique_ptr<T[], Free> data_;
  std::size_t capacity_ = 0;
};

}  // namespace rastrum
