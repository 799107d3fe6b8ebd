// SPDX-License-Identifier: BSD-3-Clause
// In its own file, because compilers move no arithmetic past calls that they cannot see into.
#include <rastrum/core/float_scope.hpp>

#if defined(__x86_64__)
#include <xmmintrin.h>
#elif !defined(__aarch64__) && !defined(__wasm__)
#error "FloatScope: say how this processor's floating point is set"
#endif

namespace rastrum {

#if defined(__x86_64__)

// One register has both control and flags.
FloatScope::FloatScope() noexcept : callers_control_(_mm_getcsr()), callers_flags_(0) {
  constexpr unsigned kAllMasked = 0x1f80;
  _mm_setcsr(kAllMasked);
}
FloatScope::~FloatScope() {
  _mm_setcsr(static_cast<unsigned>(callers_control_));
}

#elif defined(__wasm__)

// It has this mode alone, and no flags.
FloatScope::FloatScope() noexcept : callers_control_(0), callers_flags_(0) {}
FloatScope::~FloatScope() = default;

#else

FloatScope::FloatScope() noexcept {
  asm volatile("mrs %0, fpcr" : "=r"(callers_control_));
  asm volatile("mrs %0, fpsr" : "=r"(callers_flags_));
  asm volatile("msr fpcr, %0" : : "r"(std::uint64_t{0}));
}
FloatScope::~FloatScope() {
  asm volatile("msr fpcr, %0" : : "r"(callers_control_));
  asm volatile("msr fpsr, %0" : : "r"(callers_flags_));
}

#endif

}  // namespace rastrum
