// SPDX-License-Identifier: BSD-3-Clause
#include "thrust_peer.hpp"

#include <tbb/task_arena.h>
#include <thrust/sort.h>
#include <thrust/system/cpp/execution_policy.h>
#include <thrust/system/tbb/execution_policy.h>
#include <thrust/version.h>

namespace rastrum::bench {

int thrust_version() {
  return THRUST_VERSION;
}

void thrust_sort_tbb(std::span<std::uint32_t> keys, std::span<std::uint32_t> values, int threads) {
  tbb::task_arena arena(threads);
  arena.execute([&] {
    thrust::stable_sort_by_key(thrust::tbb::par, keys.data(), keys.data() + keys.size(),
                               values.data());
  });
}

void thrust_sort_serial(std::span<std::uint32_t> keys, std::span<std::uint32_t> values) {
  thrust::stable_sort_by_key(thrust::cpp::par, keys.data(), keys.data() + keys.size(),
                             values.data());
}

}  // namespace rastrum::bench
