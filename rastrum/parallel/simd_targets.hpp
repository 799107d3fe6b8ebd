// SPDX-License-Identifier: BSD-3-Clause
// For which of Highway's targets kernels are compiled: SSE4, AVX2, AVX-512 and NEON. Include it
// before Highway in a source that includes itself once a target.
#pragma once

// SSSE3 adds nothing over the scalar build that SSE4 does not, and AVX3_DL nothing that our kernels
// use. Vectors of SVE have no size, so that no struct of ours could hold them.
#define RASTRUM_USELESS_TARGETS \
  (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#ifdef RASTRUM_ONE_SIMD_TARGET
// The sanitizers' builds: what threads do, and where memory ends, differs little between them.
#define HWY_DISABLED_TARGETS (RASTRUM_USELESS_TARGETS | HWY_SSE4 | HWY_AVX3)
#else
#define HWY_DISABLED_TARGETS RASTRUM_USELESS_TARGETS
#endif
