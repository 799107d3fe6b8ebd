// SPDX-License-Identifier: BSD-3-Clause
// Counts what this thread's frames ask of a device. A wait costs some 20 µs, a launch a few, so
// tests limit both (cuda_rasterizer_test).
#pragma once

#include <cstdint>

namespace rastrum::parallel::cuda_system {

struct DeviceTally {
  std::uint64_t launches = 0;    ///< our own kernels
  std::uint64_t algorithms = 0;  ///< of Thrust and CUB; each starts several kernels and may wait
  std::uint64_t copies = 0;
  std::uint64_t copied_bytes = 0;
  std::uint64_t waits = 0;   ///< of the host for a stream
  std::uint64_t blocks = 0;  ///< of memory, asked of the driver

  friend DeviceTally operator-(const DeviceTally& a, const DeviceTally& b) {
    return {a.launches - b.launches,         a.algorithms - b.algorithms, a.copies - b.copies,
            a.copied_bytes - b.copied_bytes, a.waits - b.waits,           a.blocks - b.blocks};
  }
};

[[nodiscard]] inline DeviceTally& device_tally() {
  thread_local DeviceTally tally;
  return tally;
}

inline void count_copy(std::uint64_t bytes) {
  ++device_tally().copies;
  device_tally().copied_bytes += bytes;
}

}  // namespace rastrum::parallel::cuda_system
