// SPDX-License-Identifier: BSD-3-Clause
// A random generator whose numbers are the same with every standard library (SplitMix64).
#pragma once

#include <cstdint>

namespace rastrum::test {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    state_ += 0x9E3779B97F4A7C15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
  }
  /// Uniform in [a, b).
  double real(double a, double b) {
    return a + (b - a) * static_cast<double>(bits() >> 11) * 0x1p-53;
  }
  float real32(double a, double b) { return static_cast<float>(real(a, b)); }
  /// Uniform in [a, b].
  int integer(int a, int b) {
    return a + static_cast<int>(bits() % static_cast<std::uint64_t>(b - a + 1));
  }
  bool chance(double p) { return real(0, 1) < p; }

 private:
  std::uint64_t state_;
};

}  // namespace rastrum::test
