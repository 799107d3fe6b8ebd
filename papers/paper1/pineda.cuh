// SPDX-License-Identifier: BSD-3-Clause
// pineda on a device (pineda.hpp; paper 1, section 3.1.3).
#pragma once

#include <span>

#include <papers/axes/small.cuh>
#include <papers/paper1/tiles.cuh>

namespace rastrum::family {

struct BlockOfBinTile {
  Tiles tiles;
  RASTRUM_HD Block operator()(const BinPair& pair, std::size_t j, std::size_t part) const {
    return block_of_tile(tiles, pair.piece, tiles.tile(pair.bin, j), part);
  }
};

/// Work O(pieces + bins · tiles a bin + blocks · log). Counters: "small", "large", "bins", "tile
/// pairs".
template <class Exec>
void draw_pineda(FamilyFrame<Exec>& frame, std::span<const Piece> pieces) {
  const auto parted = small_pieces_first(frame, pieces);
  const std::span<const std::uint32_t> all = parallel::view_of(parted.elements);
  draw_box_blocks(frame, pieces, all.first(parted.first_count));
  const Tiles tiles = tiles_of_frame(frame, pieces);
  const std::size_t parts = blocks_per_tile(tiles.sizes);
  each_turn_of_bins(frame, tiles, all.subspan(parted.first_count), 0,
                    [&](std::span<const BinPair> bins, const auto& masked) {
                      using Plan = decltype(masked.view());
                      tabulate_in_turns(
                          frame.exec, masked.size() * parts,
                          MaskedPartOf<Block, Plan, std::span<const BinPair>, BlockOfBinTile>{
                              masked.view(), bins, BlockOfBinTile{tiles}, parts},
                          frame.most(kBlockBytes),
                          [&](std::span<const Block> blocks) { frame.emit(pieces, blocks); });
                    });
}

}  // namespace rastrum::family
