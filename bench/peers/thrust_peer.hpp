// SPDX-License-Identifier: BSD-3-Clause
// Thrust's sort_by_key on the CPU (CCCL of the CUDA toolkit, or Debian's libthrust-dev), compiled
// as host code: the peer of our sort.
#pragma once

#include <cstdint>
#include <span>

namespace rastrum::bench {

/// Thrust's version, such as 300102; 0 if this build lacks it.
[[nodiscard]] int thrust_version();

/// Sorts pairs by all bits of the key, on `threads` threads of oneTBB or on one thread. Requires
/// thrust_version() ≠ 0.
void thrust_sort_tbb(std::span<std::uint32_t> keys, std::span<std::uint32_t> values, int threads);
void thrust_sort_serial(std::span<std::uint32_t> keys, std::span<std::uint32_t> values);

}  // namespace rastrum::bench
