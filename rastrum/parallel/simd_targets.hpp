// SPDX-License-Identifier: BSD-3-Clause
// The targets of Highway that kernels are compiled for: SSE4, AVX2, AVX-512, NEON and
// WebAssembly. Include it before Highway in a source that includes itself once per target.
#pragma once

// SSSE3 gains nothing beside SSE4, and our kernels use nothing of AVX3_DL. SVE's vectors have no
// compile-time size, so our structs cannot hold them.
#define RASTRUM_USELESS_TARGETS \
  (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#ifdef RASTRUM_ONE_SIMD_TARGET
// For sanitizer builds: targets differ little in what threads do and where memory ends.
#define HWY_DISABLED_TARGETS (RASTRUM_USELESS_TARGETS | HWY_SSE4 | HWY_AVX3)
#else
#define HWY_DISABLED_TARGETS RASTRUM_USELESS_TARGETS
#endif
