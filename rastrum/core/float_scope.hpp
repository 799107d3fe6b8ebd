// SPDX-License-Identifier: BSD-3-Clause
// Sets the library's floating-point mode, whatever the calling thread has set: rounding to nearest,
// subnormal numbers kept, no traps. Simulations run with traps enabled (-ffpe-trap), and numeric
// libraries flush subnormals; neither may change a picture or end in SIGFPE.
#pragma once

#include <cstdint>

namespace rastrum {

/// Sets the mode of the calling thread. The destructor restores it, and the flags (overflow, …).
/// Each public function that computes has one, and so does each range of a loop that a thread
/// takes. Cost: a few nanoseconds.
class FloatScope {
 public:
  FloatScope() noexcept;
  ~FloatScope();
  FloatScope(const FloatScope&) = delete;
  FloatScope& operator=(const FloatScope&) = delete;

 private:
  std::uint64_t callers_control_, callers_flags_;
};

}  // namespace rastrum
