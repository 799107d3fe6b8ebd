// SPDX-License-Identifier: BSD-3-Clause
// The different triangles of up to 64 pixels, and which one each sees.
#pragma once

#include <cstddef>
#include <cstdint>

namespace rastrum::raster {

/// All 0: none. A triangle may be listed twice, which costs only time.
struct SeenTriangles {
  std::size_t count;
  /// By some bits of the low part: low << 8 | number of one that has them. It holds the low part so
  /// that nothing is loaded that the run before has just stored.
  std::uint64_t table[128];
  std::uint64_t low[64 + 1];  ///< their keys' low parts, in the order in which they are met
  /// The number of each covered pixel's triangle; written in runs of 8.
  alignas(64) std::uint8_t place[64 + 8];
};

}  // namespace rastrum::raster
