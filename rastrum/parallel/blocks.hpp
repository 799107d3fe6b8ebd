// SPDX-License-Identifier: BSD-3-Clause
// How words cut an index range into blocks. The cut depends on n alone, never on the number of
// threads, so a float reduction has the same bits everywhere.
#pragma once

#include <algorithm>
#include <cstddef>

#include <rastrum/config.hpp>
#include <rastrum/parallel/exec.hpp>

namespace rastrum::parallel {

/// Even the cheapest functor takes some microseconds for a block, well above a task's cost. A
/// multiple of 64, for bit masks.
inline constexpr std::size_t kBlock = 4096;

[[nodiscard]] constexpr std::size_t block_count(std::size_t n) {
  return (n + kBlock - 1) / kBlock;
}

template <class F>
struct CallWithBlock {
  std::size_t n;
  F f;
  RASTRUM_HD void operator()(std::size_t block) const {
    const std::size_t end = (block + 1) * kBlock;
    f(block, block * kBlock, end < n ? end : n);
  }
};

/// Calls f(block, begin, end) for each block [begin, end) of [0, n).
template <class Exec, class F>
void for_each_block(Exec& exec, std::size_t n, F&& f) {
  for_each_index(exec, block_count(n), [&](std::size_t block) {
    f(block, block * kBlock, std::min(n, (block + 1) * kBlock));
  });
}

}  // namespace rastrum::parallel
