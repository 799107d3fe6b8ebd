// SPDX-License-Identifier: BSD-3-Clause
// Aligned memory of the heap. Windows has a function of its own for it.
#pragma once

#include <cstddef>
#include <cstdlib>

#if defined(_WIN32)
#include <malloc.h>
#endif

namespace rastrum {

/// `bytes`, a multiple of `alignment`, for aligned_free. Null: there is no memory.
[[nodiscard]] inline void* aligned_allocate(std::size_t alignment, std::size_t bytes) noexcept {
#if defined(_WIN32)
  return _aligned_malloc(bytes, alignment);
#else
  return std::aligned_alloc(alignment, bytes);
#endif
}

inline void aligned_free(void* block) noexcept {
#if defined(_WIN32)
  _aligned_free(block);
#else
  std::free(block);
#endif
}

}  // namespace rastrum
