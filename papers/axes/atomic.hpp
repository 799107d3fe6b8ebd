// SPDX-License-Identifier: BSD-3-Clause
// atomic: keeps the maximum of the 64-bit keys of all fragments and shades later (paper 1, section
// 3.2.3). A region that one thread owns takes a plain maximum over SIMD lanes.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include <papers/axes/region.hpp>

namespace rastrum::family {

/// Work O(fragments); no scratch beside the surface.
[[nodiscard]] std::unique_ptr<Region> make_atomic(Sharing sharing, MemoryAccount& memory);

/// Raises `key` to at least `value`, while other threads do the same.
template <class T>
void raise_atomically(T& key, T value) {
  const std::atomic_ref<T> shared(key);
  T seen = shared.load(std::memory_order_relaxed);
  while (seen < value && !shared.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
  }
}

}  // namespace rastrum::family
