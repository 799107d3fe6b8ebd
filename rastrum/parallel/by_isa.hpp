// SPDX-License-Identifier: BSD-3-Clause
// RASTRUM_BY_ISA lists a function's compiled forms by instruction set. Use it at the end (HWY_ONCE)
// of a source that includes itself once per target. Each target has `name` in its own namespace;
// `otherwise` is the scalar form, also used for targets that this build lacks.
#pragma once

#include <hwy/highway.h>

#if HWY_TARGETS & HWY_SSE4
#define RASTRUM_OF_SSE4(name, otherwise) &N_SSE4::name
#else
#define RASTRUM_OF_SSE4(name, otherwise) otherwise
#endif
#if HWY_TARGETS & HWY_AVX2
#define RASTRUM_OF_AVX2(name, otherwise) &N_AVX2::name
#else
#define RASTRUM_OF_AVX2(name, otherwise) otherwise
#endif
#if HWY_TARGETS & HWY_AVX3
#define RASTRUM_OF_AVX512(name, otherwise) &N_AVX3::name
#else
#define RASTRUM_OF_AVX512(name, otherwise) otherwise
#endif
#if HWY_TARGETS & HWY_NEON
#define RASTRUM_OF_NEON(name, otherwise) &N_NEON::name
#else
#define RASTRUM_OF_NEON(name, otherwise) otherwise
#endif
#if HWY_TARGETS & HWY_WASM
#define RASTRUM_OF_WASM(name, otherwise) &N_WASM::name
#else
#define RASTRUM_OF_WASM(name, otherwise) otherwise
#endif

/// The initializer of an array of pointers, in the order of rastrum::Isa.
#define RASTRUM_BY_ISA(name, otherwise)                                            \
  {                                                                                \
    otherwise, RASTRUM_OF_SSE4(name, otherwise), RASTRUM_OF_AVX2(name, otherwise), \
        RASTRUM_OF_AVX512(name, otherwise), RASTRUM_OF_NEON(name, otherwise),      \
        RASTRUM_OF_WASM(name, otherwise)                                           \
  }
