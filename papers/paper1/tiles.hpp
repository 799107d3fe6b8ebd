// SPDX-License-Identifier: BSD-3-Clause
// The hierarchy of bins and tiles (bins.hpp) on the host's threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <papers/axes/expand_in_turns.hpp>
#include <papers/axes/frame.hpp>
#include <papers/paper1/bins.hpp>
#include <rastrum/parallel/masked_expansion.hpp>
#include <rastrum/tuning.hpp>

namespace rastrum::family {

/// sizes_of for the rasterizer `name`. Throws Error{invalid_argument}, which lists the valid sizes,
/// for sizes that Tuning does not allow and for tiles below `least_tile_px`.
[[nodiscard]] BinSizes checked_sizes(std::string_view name, const Tuning& tuning, BinSizes paper,
                                     int least_tile_px);

/// Calls f(bins, tiles) with the bins of the pieces and the masked expansion of their tiles, turn
/// by turn. f needs `tile_bytes` for a tile. Counts "bins" and "tile pairs".
template <class F>
void expand_tiles(Frame& frame, const Tiles& tiles, std::span<const std::uint32_t> which,
                  std::size_t tiles_per_chunk, std::uint64_t tile_bytes, F&& f) {
  constexpr int kBits = 64;
  const auto per_bin = static_cast<std::uint64_t>(tiles.sizes.tiles_per_bin());
  // The bin, its place among the masks, its masks, and all tiles that it may have.
  const std::uint64_t bin_bytes = sizeof(BinPair) + sizeof(std::size_t) +
                                  (per_bin + kBits - 1) / kBits * sizeof(parallel::Mask<kBits>) +
                                  per_bin * tile_bytes;
  std::uint64_t pairs = 0;
  const std::uint64_t bins =
      expand_in_turns(frame, which, BinCount{tiles}, MakeBin{tiles}, bin_bytes,
                      [&](const parallel::Buffer<BinPair>& in) {
                        const parallel::MaskedExpansion<kBits> expansion(
                            frame.exec, in, TileCount{tiles}, TouchesTile{tiles}, tiles_per_chunk);
                        pairs += expansion.size();
                        f(in, expansion);
                      });
  frame.count("bins", bins);
  frame.count("tile pairs", pairs);
}

/// Adds the samples of `tile` that the piece covers: a quarter of a block (4 px), a block, or the
/// blocks of a larger tile.
inline void add_tile(const Frame& frame, const Tiles& tiles, std::uint32_t piece, Rect tile,
                     Emitter& emitter) {
  const int bx0 = tile.x0 / kBlockSize, by0 = tile.y0 / kBlockSize;
  if (tiles.sizes.tile_px() < kBlockSize) {
    Block block{piece, static_cast<std::uint16_t>(bx0), static_cast<std::uint16_t>(by0), 0};
    frame.kernel.masks(tiles.pieces, &block, 1);
    block.mask &= samples_inside(tile, bx0, by0);
    emitter.add(block);
    return;
  }
  for (int by = by0; by <= (tile.y1 - 1) / kBlockSize; ++by)
    for (int bx = bx0; bx <= (tile.x1 - 1) / kBlockSize; ++bx) emitter.add_uncovered(piece, bx, by);
}

}  // namespace rastrum::family
