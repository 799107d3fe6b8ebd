// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace rastrum::raster {

/// All 0: none. A triangle listed twice costs only time.
struct SeenTriangles {
  std::size_t count;
  /// By some bits of the low part: low << 8 | number of a triangle with these bits. With the low
  /// part here, nothing is loaded that the run before has just stored.
  std::uint64_t table[128];
  std::uint64_t low[64 + 1];  ///< the keys' low parts, in order of appearance
  /// The number of each covered pixel's triangle; written in runs of 8.
  alignas(64) std::uint8_t place[64 + 8];
};

}  // namespace rastrum::raster
