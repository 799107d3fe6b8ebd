// SPDX-License-Identifier: BSD-3-Clause
// The hierarchy of bins and tiles (bins.hpp) on a device: expands pieces to bins and, by
// expand_masked, bins to tiles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <papers/axes/frame.cuh>
#include <papers/axes/turns.cuh>
#include <papers/paper1/bins.hpp>

namespace rastrum::family {

/// The sizes of the tuning, which the host has checked, or else `paper`.
template <class Exec>
[[nodiscard]] Tiles tiles_of_frame(const FamilyFrame<Exec>& frame, std::span<const Piece> pieces,
                                   BinSizes paper = {}) {
  return {sizes_of(frame.tuning, paper), pieces.data(), frame.surface.view, frame.tuning.order};
}

/// The number of blocks that a tile touches.
[[nodiscard]] RASTRUM_HD inline std::size_t blocks_per_tile(BinSizes sizes) {
  const int across = (sizes.tile_px() + kBlockSize - 1) / kBlockSize;
  return static_cast<std::size_t>(across) * static_cast<std::size_t>(across);
}
/// The samples of block `part` of a tile that a piece covers; may be none. The view may have cut
/// the tile.
[[nodiscard]] RASTRUM_HD inline Block block_of_tile(const Tiles& tiles, std::uint32_t piece,
                                                    Rect tile, std::size_t part) {
  const auto across =
      static_cast<std::size_t>((tiles.sizes.tile_px() + kBlockSize - 1) / kBlockSize);
  const int bx = tile.x0 / kBlockSize + static_cast<int>(part % across);
  const int by = tile.y0 / kBlockSize + static_cast<int>(part / across);
  return {piece, static_cast<std::uint16_t>(bx), static_cast<std::uint16_t>(by),
          cover_box(edges_of(tiles.pieces[piece]), tile, bx, by)};
}

/// Calls f(bins, tiles) with the bins of the pieces and the masked expansion of their tiles, turn
/// by turn. f needs `tile_bytes` for a tile. Counts "bins" and "tile pairs".
template <class Exec, class F>
void each_turn_of_bins(FamilyFrame<Exec>& frame, const Tiles& tiles,
                       std::span<const std::uint32_t> which, std::uint64_t tile_bytes, F&& f) {
  // The bin, its place among the masks, and its masks with the places of their results.
  const auto per_bin = static_cast<std::uint64_t>(tiles.sizes.tiles_per_bin());
  const std::uint64_t bin_bytes = sizeof(BinPair) + sizeof(std::size_t) +
                                  (per_bin + 63) / 64 * 2 * sizeof(std::uint64_t) +
                                  per_bin * tile_bytes;
  std::uint64_t pairs = 0;
  const std::uint64_t bins =
      expand_in_turns(frame.exec, which, BinCount{tiles}, MakeBin{tiles}, frame.most(bin_bytes),
                      [&](std::span<const BinPair> some) {
                        const auto masked = parallel::make_masked_expansion<64>(
                            frame.exec, some, TileCount{tiles}, TouchesTile{tiles});
                        pairs += masked.size();
                        f(some, masked);
                      });
  frame.count("bins", bins);
  frame.count("tile pairs", pairs);
}

}  // namespace rastrum::family
