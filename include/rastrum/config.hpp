// Macros that tell the other headers about the compiler.
#pragma once

/// Marks a function that also compiles for the device. The CPU build needs no CUDA header.
#if defined(__CUDACC__)
#define RASTRUM_HD __host__ __device__
#else
#define RASTRUM_HD
#endif

/// The same for functions that loops over lanes must inline, whatever their instruction set.
#define RASTRUM_HD_LEAF RASTRUM_HD inline __attribute__((always_inline))

/// Marks namespaces whose declarations a shared library shows.
#if defined(__CUDACC__)
#define RASTRUM_API
#else
#define RASTRUM_API [[gnu::visibility("default")]]
#endif
