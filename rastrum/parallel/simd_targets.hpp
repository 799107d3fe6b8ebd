// For which of Highway's targets kernels are compiled: SSE4, AVX2, AVX-512 and NEON. Include it
// before Highway in a source that includes itself once a target.
#pragma once

// SSSE3 adds nothing over the scalar build that SSE4 does not, and AVX3_DL nothing that our kernels
// use. Vectors of SVE have no size, so that no struct of ours could hold them.
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
