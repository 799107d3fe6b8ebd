// SPDX-License-Identifier: BSD-3-Clause
// Replaces thrust_peer.cpp if Thrust is not installed.
#include "thrust_peer.hpp"

namespace rastrum::bench {

int thrust_version() {
  return 0;
}
void thrust_sort_tbb(std::span<std::uint32_t>, std::span<std::uint32_t>, int) {}
void thrust_sort_serial(std::span<std::uint32_t>, std::span<std::uint32_t>) {}

}  // namespace rastrum::bench
