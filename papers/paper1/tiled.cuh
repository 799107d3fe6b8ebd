// SPDX-License-Identifier: BSD-3-Clause
// tiled on a device: pieces are expanded to bins and tiles, and the (tile, piece) pairs are sorted
// by tile (paper 1, section 3.3).
//
// Deviation: no thread owns a tile, since a turn's blocks are in memory for any visibility. The
// sort still pays: neighbouring threads draw the same tile and find its keys in the cache.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include <papers/axes/small.cuh>
#include <papers/paper1/tiles.cuh>

namespace rastrum::family {

template <class Plan>
struct WriteTilePair {
  Plan plan;
  std::span<const BinPair> bins;
  Tiles tiles;
  std::uint32_t* tile;
  std::uint32_t* piece;
  RASTRUM_HD void operator()(std::size_t k) const {
    plan.walk(bins, k, k + 1, [&](const BinPair& pair, std::size_t j) {
      tile[k] = tiles.tile_id(tiles.tile(pair.bin, j));
      piece[k] = pair.piece;
    });
  }
};
/// Block k % parts of pair k / parts.
struct BlockOfPair {
  Tiles tiles;
  std::span<const std::uint32_t> tile, piece;
  std::size_t parts;
  RASTRUM_HD Block operator()(std::size_t k) const {
    const std::size_t pair = k / parts;
    return block_of_tile(tiles, piece[pair], tiles.tiles.rect(tile[pair]), k % parts);
  }
};

/// Work O(pieces + bins · tiles a bin + pairs · digits + blocks). Counters: "bins", "tile pairs".
template <class Exec>
void draw_sorted_tiles(FamilyFrame<Exec>& frame, std::span<const Piece> pieces,
                       std::span<const std::uint32_t> which) {
  using parallel::view_of;
  // Tile and piece, twice while they are sorted, and a share of the sort's scratch.
  constexpr std::uint64_t kPairBytes = 20;
  const Tiles tiles = tiles_of_frame(frame, pieces);
  const std::size_t parts = blocks_per_tile(tiles.sizes);
  each_turn_of_bins(
      frame, tiles, which, kPairBytes, [&](std::span<const BinPair> bins, const auto& masked) {
        auto tile = parallel::make_buffer<std::uint32_t>(frame.exec, masked.size());
        auto piece = parallel::make_buffer<std::uint32_t>(frame.exec, masked.size());
        parallel::for_each_index(frame.exec, masked.size(),
                                 WriteTilePair<decltype(masked.view())>{masked.view(), bins, tiles,
                                                                        tile.data(), piece.data()});
        parallel::sort_by_key(frame.exec, tile, piece,
                              static_cast<int>(std::bit_width(tiles.tiles.count() - 1)));
        tabulate_in_turns(
            frame.exec, masked.size() * parts,
            BlockOfPair{tiles, view_of(std::as_const(tile)), view_of(std::as_const(piece)), parts},
            frame.most(kBlockBytes),
            [&](std::span<const Block> blocks) { frame.emit(pieces, blocks); });
      });
}

template <class Exec>
void draw_tiled(FamilyFrame<Exec>& frame, std::span<const Piece> pieces) {
  const auto which = all_pieces(frame, pieces);
  draw_sorted_tiles(frame, pieces, parallel::view_of(which));
}

}  // namespace rastrum::family
