// Floating point as the library computes, whatever the calling thread has set: rounding to nearest,
// subnormal numbers as they are, no traps. Simulations run with traps enabled (-ffpe-trap), numeric
// libraries flush subnormals; neither may change a picture or end in SIGFPE.
#pragma once

#include <cstdint>

namespace rastrum {

/// While it lives, the calling thread computes so; then it is as before, its flags of what has
/// happened (overflow, …) too. Stands in each function of the interface that computes, and around
/// what threads take of a loop. Cost: a few nanoseconds.
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
