// What every other header needs to know about the compiler.
#pragma once

/// Marks a function that also compiles for the device. The CPU build needs no CUDA header.
#if defined(__CUDACC__)
#define RASTRUM_HD __host__ __device__
#else
#define RASTRUM_HD
#endif
