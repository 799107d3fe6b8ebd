// SPDX-License-Identifier: BSD-3-Clause
// The hierarchy of paper 1 (section 3.1.3) as functors for host and device: a piece to the bins
// that its box touches, a bin to the tiles that pass an edge test.
//
// Deviation: the test takes the largest value of each edge function over the samples in tile and
// box, in exact integers.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include <papers/axes/names.hpp>
#include <papers/axes/order.hpp>
#include <rastrum/raster/bin/tile_grid.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/tuning.hpp>

namespace rastrum::family {

/// A piece in a bin that its box touches.
struct BinPair {
  std::uint32_t piece, bin;
};

/// Sizes of bins and tiles: powers of two, so that divisions are shifts. The defaults are paper
/// 1's.
struct BinSizes {
  int bin_log2 = 5, tile_log2 = 3;

  [[nodiscard]] RASTRUM_HD int bin_px() const { return 1 << bin_log2; }
  [[nodiscard]] RASTRUM_HD int tile_px() const { return 1 << tile_log2; }
  /// Tiles side by side in a bin, and also one below the other.
  [[nodiscard]] RASTRUM_HD int tiles_across() const { return 1 << (bin_log2 - tile_log2); }
  [[nodiscard]] RASTRUM_HD int tiles_per_bin() const { return tiles_across() * tiles_across(); }
  /// Tile t of a bin, numbered row by row.
  [[nodiscard]] RASTRUM_HD Cell tile_cell(int t) const {
    return {t & (tiles_across() - 1), t >> (bin_log2 - tile_log2)};
  }
};

/// The sizes of paper 2.
inline constexpr BinSizes kPaper2Sizes{6, 3};
inline constexpr int kMaxBinPx = 128, kMaxTilesAcross = 16;

/// The sizes that a valid tuning asks for; `paper` where it asks for none.
[[nodiscard]] inline BinSizes sizes_of(const Tuning& tuning, BinSizes paper) {
  const auto log2_of = [](int px) { return std::countr_zero(static_cast<unsigned>(px)); };
  if (tuning.bin_px != 0) paper.bin_log2 = log2_of(tuning.bin_px);
  if (tuning.tile_px != 0) paper.tile_log2 = log2_of(tuning.tile_px);
  return paper;
}

/// A view in bins with tiles, both numbered row by row.
struct Tiles {
  const Piece* pieces;
  BinSizes sizes;
  TileGrid bins, tiles;
  BlockOrder order;  ///< of the walk over bins and tiles

  Tiles(BinSizes s, const Piece* p, Rect view, BlockOrder o)
      : pieces(p), sizes(s), bins{view, s.bin_px()}, tiles{view, s.tile_px()}, order(o) {}

  /// The bins that the box of a piece touches, as columns and rows of the view's grid.
  [[nodiscard]] RASTRUM_HD Rect bins_of(std::uint32_t piece) const {
    const Rect view = bins.view;
    const Rect box = piece_bounds(pieces[piece], view);
    if (box.empty()) return {};
    const int by = sizes.bin_log2;
    return {(box.x0 - view.x0) >> by, (box.y0 - view.y0) >> by, ((box.x1 - 1 - view.x0) >> by) + 1,
            ((box.y1 - 1 - view.y0) >> by) + 1};
  }
  [[nodiscard]] RASTRUM_HD std::size_t bin_count(std::uint32_t piece) const {
    const Rect r = bins_of(piece);
    return static_cast<std::size_t>(r.x1 - r.x0) * static_cast<std::size_t>(r.y1 - r.y0);
  }
  [[nodiscard]] RASTRUM_HD BinPair bin(std::uint32_t piece, std::size_t j) const {
    const Rect r = bins_of(piece);
    const Cell cell = cell_at(order, j, r.x1 - r.x0, r.y1 - r.y0);
    return {piece,
            static_cast<std::uint32_t>((r.y0 + cell.row) * bins.columns() + r.x0 + cell.column)};
  }

  /// The j-th tile of a bin in walking order, cut to the view; empty if it lies outside.
  [[nodiscard]] RASTRUM_HD Rect tile(std::uint32_t bin, std::size_t j) const {
    const Rect b = bins.rect(bin);
    const int px = sizes.tile_px(), across = sizes.tiles_across();
    const Cell cell = order == BlockOrder::row_major ? sizes.tile_cell(static_cast<int>(j))
                                                     : cell_at(order, j, across, across);
    const int x0 = b.x0 + cell.column * px, y0 = b.y0 + cell.row * px;
    return intersection(b, {x0, y0, x0 + px, y0 + px});
  }
  /// Whether the piece may cover a sample of tile j of its bin.
  [[nodiscard]] RASTRUM_HD bool touches(const BinPair& pair, std::size_t j) const {
    const Piece& piece = pieces[pair.piece];
    const Rect box = piece_bounds(piece, tile(pair.bin, j));
    return !box.empty() && may_touch(edges_of(piece), box);
  }
  [[nodiscard]] RASTRUM_HD std::uint32_t tile_id(Rect tile) const {
    const Rect view = tiles.view;
    const int by = sizes.tile_log2;
    return static_cast<std::uint32_t>(((tile.y0 - view.y0) >> by) * tiles.columns() +
                                      ((tile.x0 - view.x0) >> by));
  }
};

/// Bin expansion: how many bins a piece has …
struct BinCount {
  Tiles tiles;
  RASTRUM_HD std::size_t operator()(std::uint32_t piece) const { return tiles.bin_count(piece); }
};
/// … and bin j.
struct MakeBin {
  Tiles tiles;
  RASTRUM_HD BinPair operator()(std::uint32_t piece, std::size_t j) const {
    return tiles.bin(piece, j);
  }
};
/// Tile expansion, masked: how many tiles a bin has …
struct TileCount {
  Tiles tiles;
  RASTRUM_HD std::size_t operator()(const BinPair&) const {
    return static_cast<std::size_t>(tiles.sizes.tiles_per_bin());
  }
};
/// … and which of them the piece may touch.
struct TouchesTile {
  Tiles tiles;
  RASTRUM_HD bool operator()(const BinPair& pair, std::size_t j) const {
    return tiles.touches(pair, j);
  }
};

}  // namespace rastrum::family
