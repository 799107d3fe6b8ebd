// SPDX-License-Identifier: BSD-3-Clause
// Macros that tell the other headers about the compiler.
#pragma once

/// Marks a function that also compiles for the device. The CPU build needs no CUDA header.
#if defined(__CUDACC__)
#define RASTRUM_HD __host__ __device__
#else
#define RASTRUM_HD
#endif

/// Marks such a function if loops over SIMD lanes must inline it, whatever their instruction set.
#define RASTRUM_HD_LEAF RASTRUM_HD inline __attribute__((always_inline))

/// A shared library exports what namespaces with RASTRUM_API declare, but not the classes with
/// RASTRUM_INSIDE, which a header declares and does not define.
#if defined(__CUDACC__)
#define RASTRUM_API
#define RASTRUM_INSIDE
#else
#define RASTRUM_API [[gnu::visibility("default")]]
#define RASTRUM_INSIDE [[gnu::visibility("hidden")]]
#endif
