// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include <rastrum/image.hpp>
#include <rastrum/raster/context/request.hpp>

namespace rastrum::raster {

/// Stores the `touched` ones of a block's 64 values, and prefetches the lines of the block to the
/// right, which mostly comes next: rows are too far apart for hardware prefetching.
template <class T>
void store_block(const ImageView<T>& target, const T* values, std::uint64_t touched, int x0,
                 int y0) {
  for (; touched != 0; touched >>= kBlockSize, values += kBlockSize, ++y0) {
    if (touched % 256 == 255) {
      T* const to = target.row(y0) + x0;
      std::copy_n(values, kBlockSize, to);
      if (x0 + 2 * kBlockSize > target.width) continue;
      __builtin_prefetch(to + kBlockSize, 1);
      __builtin_prefetch(to + 2 * kBlockSize - 1, 1);
      continue;
    }
    for (std::uint64_t m = touched % 256; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      target(x0 + i, y0) = values[i];
    }
  }
}

/// Stores the wanted targets at the `touched` pixels; normals come from `block.lit`.
void store_surfaces(const FrameRequest& request, const FrameGeometry& frame,
                    const VisibleBlock& block, std::uint64_t touched) noexcept;

}  // namespace rastrum::raster
