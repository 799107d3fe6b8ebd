// SPDX-License-Identifier: BSD-3-Clause
// Sets the library's floating-point mode, whatever the caller's: rounding to nearest, subnormals
// kept, no traps. Simulations run with traps (-ffpe-trap), and numeric libraries flush subnormals;
// neither may change a picture or raise SIGFPE.
#pragma once

#include <cstdint>

namespace rastrum {

/// Sets the calling thread's mode; the destructor restores it and the flags (overflow, …). Each
/// public function that computes has one, and each range of a threaded loop. Cost: a few
/// nanoseconds.
class FloatScope {
 public:
  FloatScope() noexcept;
  ~FloatScope();
  FloatScope(const FloatScope&) = delete;
  FloatScope& operator=(const FloatScope&) = delete;

 private:
  std::uint64_t callers_control_;
  [[maybe_unused]] std::uint64_t callers_flags_;  ///< not on every processor
};

}  // namespace rastrum
