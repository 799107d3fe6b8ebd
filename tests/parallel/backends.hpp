// SPDX-License-Identifier: BSD-3-Clause
// Compares every word with its definition on every backend, at sizes around those where the
// implementations switch methods. With RASTRUM_TEST_DEVICE_WORDS the backend is that of
// rastrum/parallel/cuda, on the CPU (system.cuh).
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/parallel/words.hpp>
#if defined(RASTRUM_TEST_DEVICE_WORDS)
#include <rastrum/parallel/cuda/words.cuh>
#endif

#include "tests/support/test_share.hpp"

namespace rastrum::parallel::test {

#if defined(RASTRUM_TEST_DEVICE_WORDS)
template <class F>
void on_every_backend(F&& f) {
  SCOPED_TRACE("cuda on the CPU");
  Cuda exec;
  f(exec);
}
template <class T>
std::vector<T> as_vector(const DeviceBuffer<T>& buffer) {
  Cuda exec;
  return to_host(exec, buffer);
}
#else

/// Calls f(backend) for serial and for 1, 2 and 8 threads.
template <class F>
void on_every_backend(F&& f) {
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
#endif

inline const std::vector<std::size_t> kSizes = {
    0,          1,      2,
    63,         64,     65,
    kBlock - 1, kBlock, kBlock + 1,
    3 * kBlock, 50021,  static_cast<std::size_t>(rastrum::test::share_of(300007, 70001))};

/// Makes a word's result comparable with an expected vector.
template <class T>
std::vector<T> as_vector(const Buffer<T>& buffer) {
  return {buffer.begin(), buffer.end()};
}

/// Expects that compute(backend), floats, has Serial's bits on all backends.
template <class Compute>
void expect_one_result(const Compute& compute) {
  Serial serial;
  const std::vector<float> expected = compute(serial);
  on_every_backend([&](auto& exec) {
    const std::vector<float> got = compute(exec);
    ASSERT_EQ(got.size(), expected.size());
    EXPECT_TRUE(got.empty() ||
                std::memcmp(got.data(), expected.data(), got.size() * sizeof(float)) == 0);
  });
}

template <class T>
std::vector<T> random_values(std::size_t n, std::uint64_t limit, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed + n);
  std::vector<T> values(n);
  for (T& v : values) v = static_cast<T>(random() % limit);
  return values;
}

/// Segment sizes of several kinds; the last ones defeat simple load balancing.
inline std::vector<std::vector<std::uint32_t>> segment_sizes() {
  std::vector<std::vector<std::uint32_t>> all = {{}, {0}, {1}, {0, 0, 0}, {100000}};
  for (const std::size_t n : {2U, 64U, 5000U}) all.push_back(random_values<std::uint32_t>(n, 40));
  std::vector<std::uint32_t> huge = random_values<std::uint32_t>(5000, 3);
  huge[1234] = 150001;
  all.push_back(huge);
  std::vector<std::uint32_t> empty_ends(20000, 0);
  empty_ends[10000] = 9000;
  all.push_back(empty_ends);
  std::vector<std::uint32_t> around_masks;
  for (std::uint32_t bits = 8; bits <= 256; bits *= 2)
    around_masks.insert(around_masks.end(), {bits - 1, bits, bits + 1, 2 * bits, 0});
  all.push_back(around_masks);
  return all;
}

/// Associative but not commutative: composition of x ↦ a x + b modulo 2³².
struct Affine {
  std::uint32_t a = 1, b = 0;
  friend bool operator==(const Affine&, const Affine&) = default;
};
inline Affine then(Affine f, Affine g) {
  return {f.a * g.a, g.a * f.b + g.b};
}
inline std::vector<Affine> random_maps(std::size_t n) {
  std::mt19937 random(static_cast<std::uint32_t>(n));
  std::vector<Affine> maps(n);
  for (Affine& m : maps)
    m = {static_cast<std::uint32_t>(random()) | 1U, static_cast<std::uint32_t>(random())};
  return maps;
}

inline std::vector<float> random_floats(std::size_t n) {
  std::mt19937 random(static_cast<std::uint32_t>(n));
  std::vector<float> values(n);
  for (float& v : values)
    v = std::ldexp(static_cast<float>(static_cast<std::int32_t>(random())),
                   -static_cast<int>(random() % 40));
  return values;
}

}  // namespace rastrum::parallel::test
