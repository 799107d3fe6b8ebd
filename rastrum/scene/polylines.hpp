// SPDX-License-Identifier: BSD-3-Clause
// Segments of consecutive polylines in an array, which begin where `offsets` says.
#pragma once

#include <cstddef>

#include <rastrum/array.hpp>

namespace rastrum::polylines {

/// Segments of the polylines before the i-th; each must have a corner.
inline std::size_t segments_before(const IndexView& offsets, std::size_t i) {
  return static_cast<std::size_t>(offsets.wide(i) - offsets.wide(0)) - i;
}

inline std::size_t begin_of(const IndexView& offsets, std::size_t segment) {
  // The last polyline with at most `segment` segments before it.
  std::size_t low = 0, high = offsets.size() - 1;
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (segments_before(offsets, middle) <= segment ? low : high) = middle;
  }
  return segment + static_cast<std::size_t>(offsets.wide(0)) + low;
}

}  // namespace rastrum::polylines
