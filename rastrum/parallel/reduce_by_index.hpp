// SPDX-License-Identifier: BSD-3-Clause
// reduce_by_index: a generalized histogram. For each i, dest[indices[i]] op= values[i].
//
// Indices outside of `dest` are ignored, as in Futhark. The operator must be associative; a bin's
// values are folded in order. The 64-bit unsigned maximum, which resolves visibility, needs no
// order: it is atomic and in place. Other operators sort the indices and reduce runs
// (reduce_by_key), so that no bin is contended.
//
// Work O(n), for other operators O(n · log dest) bit operations in the sort; span O(kBlock + n /
// threads). Allocates nothing, or for other operators 48 bytes and two values per index in range.
// Source: Futhark's reduce_by_index (paper 1, section 2.2.3); Henriksen et al., "Compiling
// generalized histograms for GPU", 2020.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <rastrum/parallel/blocks.hpp>
#include <rastrum/parallel/filter.hpp>
#include <rastrum/parallel/range.hpp>
#include <rastrum/parallel/reduce_by_key.hpp>
#include <rastrum/parallel/sort_by_key.hpp>
#include <rastrum/parallel/transform.hpp>

namespace rastrum::parallel {

struct Maximum {
  template <class T>
  [[nodiscard]] RASTRUM_HD constexpr T operator()(const T& a, const T& b) const {
    return a < b ? b : a;
  }
};

/// word = max(word, value), atomically.
RASTRUM_HD inline void atomic_maximum(std::uint64_t& word, std::uint64_t value) noexcept {
#if defined(__CUDA_ARCH__)
  static_assert(sizeof(unsigned long long) == sizeof(std::uint64_t));
  atomicMax(reinterpret_cast<unsigned long long*>(&word), value);
#else
  const std::atomic_ref<std::uint64_t> shared(word);
  std::uint64_t now = shared.load(std::memory_order_relaxed);
  while (now < value && !shared.compare_exchange_weak(now, value, std::memory_order_relaxed)) {
  }
#endif
}

/// word += value, atomically; returns the old value.
template <class T>
requires(std::same_as<T, std::uint32_t> || std::same_as<T, std::uint64_t>) RASTRUM_HD inline T
    atomic_add(T& word, T value) noexcept {
#if defined(__CUDA_ARCH__)
  using Native = std::conditional_t<sizeof(T) == 4, unsigned, unsigned long long>;
  return static_cast<T>(atomicAdd(reinterpret_cast<Native*>(&word), static_cast<Native>(value)));
#else
  return std::atomic_ref<T>(word).fetch_add(value, std::memory_order_relaxed);
#endif
}

/// sum += value, atomically, while no thread reads the sum. A warp adds up its small values, then
/// one of its threads goes to memory, because 32 atomics on one address take 32 turns.
RASTRUM_HD inline void add_to_sum(std::uint64_t& sum, std::uint64_t value) noexcept {
#if defined(__CUDA_ARCH__)
  constexpr std::uint64_t kSmall = std::uint64_t{1} << 26;  // 32 of them fit 32 bits
  if (value < kSmall) {
    const unsigned here = __activemask();
    const unsigned of_warp = __reduce_add_sync(here, static_cast<unsigned>(value));
    if (of_warp != 0 && static_cast<int>(threadIdx.x % 32) == __ffs(static_cast<int>(here)) - 1)
      atomic_add(sum, std::uint64_t{of_warp});
    return;
  }
#endif
  atomic_add(sum, value);
}

/// word = max(word, value), atomically, with one memory access per warp as in add_to_sum.
RASTRUM_HD inline void raise_maximum(std::uint64_t& word, std::uint32_t value) noexcept {
#if defined(__CUDA_ARCH__)
  const unsigned here = __activemask();
  const unsigned of_warp = __reduce_max_sync(here, value);
  if (static_cast<int>(threadIdx.x % 32) == __ffs(static_cast<int>(here)) - 1)
    atomic_maximum(word, std::uint64_t{of_warp});
#else
  atomic_maximum(word, std::uint64_t{value});
#endif
}

/// Atomically takes the next place of a queue of which `count` are taken; it may lie beyond the
/// queue's room. Threads of a warp that ask together use one atomic.
[[nodiscard]] RASTRUM_HD inline std::uint64_t take_place(std::uint64_t& count) noexcept {
#if defined(__CUDA_ARCH__)
  const unsigned here = __activemask(), lane = threadIdx.x % 32;
  const int leader = __ffs(static_cast<int>(here)) - 1;
  std::uint64_t first = 0;
  if (static_cast<int>(lane) == leader)
    first = atomic_add(count, std::uint64_t{static_cast<unsigned>(__popc(here))});
  first = __shfl_sync(here, static_cast<unsigned long long>(first), leader);
  return first + static_cast<unsigned>(__popc(here & ((1U << lane) - 1)));
#else
  return atomic_add(count, std::uint64_t{1});
#endif
}

/// `dest` is changed in place. `indices` (integers of any sign) and `values` have the same size.
template <class Exec, Writable Dest, Readable Indices, Readable Values, class Op>
void reduce_by_index(Exec& exec, Dest&& dest, const Indices& indices, const Values& values, Op op) {
  using T = std::remove_cvref_t<decltype(dest[0])>;
  assert(std::size(indices) == std::size(values));
  const std::size_t n = std::size(indices), bins = std::size(dest);
  const auto in_range = [&](std::size_t i) {
    return std::cmp_greater_equal(indices[i], 0) && std::cmp_less(indices[i], bins);
  };
  if constexpr (std::is_same_v<T, std::uint64_t> && std::is_same_v<Op, Maximum>) {
    // Prefetching distant bins helps: 108 → 63 ms for 10 M words in 8 MiB, 2 threads.
    constexpr std::size_t kAhead = 16;
    for_each_block(exec, n, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t ahead = std::min(i + kAhead, end - 1);
        if (in_range(ahead)) __builtin_prefetch(&dest[static_cast<std::size_t>(indices[ahead])], 1);
        if (in_range(i))
          atomic_maximum(dest[static_cast<std::size_t>(indices[i])],
                         static_cast<std::uint64_t>(values[i]));
      }
    });
  } else {
    auto position = filter(exec, counting(n), in_range);
    auto key = make_buffer<std::size_t>(exec, position.size());
    transform(exec, position, key,
              [&](std::size_t i) { return static_cast<std::size_t>(indices[i]); });
    sort_by_key(exec, key, position, static_cast<int>(std::bit_width(bins)));
    const auto sums =
        reduce_by_key(exec, key,
                      Computed(position.size(),
                               [&](std::size_t k) { return static_cast<T>(values[position[k]]); }),
                      op);
    for_each_block(exec, sums.keys.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        T& bin = dest[sums.keys[k]];
        bin = static_cast<T>(op(bin, sums.values[k]));
      }
    });
  }
}

}  // namespace rastrum::parallel
