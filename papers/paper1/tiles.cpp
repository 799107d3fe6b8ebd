// SPDX-License-Identifier: BSD-3-Clause
#include <papers/paper1/tiles.hpp>

#include <string>

#include <rastrum/error.hpp>

namespace rastrum::family {

BinSizes checked_sizes(std::string_view name, const Tuning& tuning, BinSizes paper,
                       int least_tile_px) {
  const int bin_px = tuning.bin_px == 0 ? paper.bin_px() : tuning.bin_px;
  const int tile_px = tuning.tile_px == 0 ? paper.tile_px() : tuning.tile_px;
  const auto is_power = [](int px) {
    return px > 0 && std::has_single_bit(static_cast<unsigned>(px));
  };
  if (is_power(bin_px) && is_power(tile_px) && tile_px >= least_tile_px && bin_px <= kMaxBinPx &&
      bin_px >= 2 * tile_px && bin_px <= kMaxTilesAcross * tile_px)
    return sizes_of(tuning, paper);
  throw Error(Errc::invalid_argument, std::string("'")
                                          .append(name)
                                          .append("' takes powers of two: tiles from ")
                                          .append(std::to_string(least_tile_px))
                                          .append(" px, bins of 2 to ")
                                          .append(std::to_string(kMaxTilesAcross))
                                          .append(" tiles across and up to ")
                                          .append(std::to_string(kMaxBinPx))
                                          .append(" px; bins/tiles of ")
                                          .append(std::to_string(bin_px))
                                          .append("/")
                                          .append(std::to_string(tile_px))
                                          .append(" px are not"));
}

}  // namespace rastrum::family
