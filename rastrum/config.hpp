// What every other header needs to know about the compiler.
#pragma once

/// Marks a function that also compiles for the device. The CPU build needs no CUDA header.
#if defined(__CUDACC__)
#define RASTRUM_HD __host__ __device__
#else
#define RASTRUM_HD
#endif

/// The same for what loops over lanes must take in whole, whatever instruction set they have.
#define RASTRUM_HD_LEAF RASTRUM_HD inline __attribute__((always_inline))
