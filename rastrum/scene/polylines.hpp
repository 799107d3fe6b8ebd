// SPDX-License-Identifier: BSD-3-Clause
// Segments of polylines that lie one after another in an array, each where `offsets` says.
#pragma once

#include <cstddef>

#include <rastrum/array.hpp>

namespace rastrum::polylines {

/// Segments of the polylines before the i-th, where each has one corner at least.
inline std::size_t segments_before(const IndexView& offsets, std::size_t i) {
  return static_cast<std::size_t>(offsets.wide(i) - offsets.wide(0)) - i;
}

/// The corner that `segment` begins with.
inline std::size_t begin_of(const IndexView& offsets, std::size_t segment) {
  // The last polyline that has at most `segment` segments before it.
  std::size_t low = 0, high = offsets.size() - 1;
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (segments_before(offsets, middle) <= segment ? low : high) = middle;
  }
  return segment + static_cast<std::size_t>(offsets.wide(0)) + low;
}

}  // namespace rastrum::polylines
