// Every word is held against its definition on every backend, with sizes around those at which the
// implementations change their way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <rastrum/parallel/words.hpp>

namespace rastrum::parallel::test {

/// Calls f(backend) for serial and for 1, 2 and 8 threads.
template <class F>
void on_every_backend(F&& f) {
  // Without it oneTBB starts no more threads than there are cores, and 8 would be tested nowhere.
  const tbb::global_control eight(tbb::global_control::max_allowed_parallelism, 8);
  {
    SCOPED_TRACE("serial");
    Serial exec;
    f(exec);
  }
  for (const int count : {1, 2, 8}) {
    SCOPED_TRACE("threads " + std::to_string(count));
    Threads exec(count);
    f(exec);
  }
}

inline const std::vector<std::size_t> kSizes = {
    0, 1, 2, 63, 64, 65, kBlock - 1, kBlock, kBlock + 1, 3 * kBlock, 50021, 300007};

template <class T>
std::vector<T> random_values(std::size_t n, std::uint64_t limit, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed + n);
  std::vector<T> values(n);
  for (T& v : values) v = static_cast<T>(random() % limit);
  return values;
}

}  // namespace rastrum::parallel::test
