// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/surface/seen_bin.hpp>

namespace rastrum::raster {

bool is_fine(const BinSurface& bin) noexcept {
  // Counts blocks in which two distant pixels see different triangles.
  int pairs = 0, differ = 0;
  for (int row = 0; row < block_rows(bin.rect); ++row)
    for (int column = 0; column < block_columns(bin.rect); ++column) {
      const std::uint64_t* const keys = bin.block(column, row);
      const std::uint64_t a = keys[8 * 1 + 1], b = keys[8 * 6 + 6];
      if (a == 0 || b == 0) continue;
      ++pairs;
      differ += ((a ^ b) & kIdMask) != 0 ? 1 : 0;
    }
  return differ >= 4 && differ * 4 >= pairs * 3;
}

}  // namespace rastrum::raster
