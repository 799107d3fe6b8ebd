// SPDX-License-Identifier: BSD-3-Clause
// The length of a device's loop: a number from the host, or a counter on the device that is read
// when the loop begins, so that the host need not wait for it.
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/config.hpp>

namespace rastrum::parallel {

struct LoopCount {
  std::size_t most = 0;                  ///< the limit, whatever the counter says
  const std::uint64_t* count = nullptr;  ///< on the device; null: `most`

  LoopCount(std::size_t n) : most(n) {}  // NOLINT(google-explicit-constructor): a number is one
  LoopCount(std::size_t room, const std::uint64_t* on_device) : most(room), count(on_device) {}
  [[nodiscard]] RASTRUM_HD std::size_t get() const {
    return count != nullptr && *count < most ? static_cast<std::size_t>(*count) : most;
  }
};

}  // namespace rastrum::parallel
