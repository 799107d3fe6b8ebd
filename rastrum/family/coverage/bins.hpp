// The hierarchy of paper 1 (section 3.1.3) as functors, for host and device: a piece to the bins
// that its box touches, a bin to the tiles that an edge test leaves.
//
// Deviation: a tile is tested by the largest value of each edge function over the samples of tile
// and box, in exact integers.
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/family/names.hpp>
#include <rastrum/raster/bin/tile_grid.hpp>
#include <rastrum/raster/cover/rules.hpp>

namespace rastrum::family {

/// A piece in a bin that its box touches.
struct BinPair {
  std::uint32_t piece, bin;
};

/// Sizes of bins and tiles: compiled in, as the host has them …
template <int kBin, int kTile>
struct FixedSizes {
  [[nodiscard]] RASTRUM_HD static constexpr int bin_px() { return kBin; }
  [[nodiscard]] RASTRUM_HD static constexpr int tile_px() { return kTile; }
};
/// … or known when it runs, so that a device compiles one kernel for all of them.
struct RunTimeSizes {
  int bin, tile;
  [[nodiscard]] RASTRUM_HD int bin_px() const { return bin; }
  [[nodiscard]] RASTRUM_HD int tile_px() const { return tile; }
};

/// A view in bins with tiles, both numbered row by row.
template <class Sizes>
struct BasicTiles {
  const Piece* pieces;
  Sizes sizes;
  TileGrid bins, tiles;

  BasicTiles(Sizes s, const Piece* p, Rect view, BlockOrder order)
      : pieces(p), sizes(s), bins{view, s.bin_px(), order}, tiles{view, s.tile_px(), order} {}

  [[nodiscard]] RASTRUM_HD int tiles_across() const { return sizes.bin_px() / sizes.tile_px(); }
  [[nodiscard]] RASTRUM_HD std::size_t tiles_per_bin() const {
    return static_cast<std::size_t>(tiles_across()) * static_cast<std::size_t>(tiles_across());
  }

  /// The bins that the box of a piece touches, as columns and rows of the view's.
  [[nodiscard]] RASTRUM_HD Rect bins_of(std::uint32_t piece) const {
    const Rect view = bins.view;
    const Rect box = piece_bounds(pieces[piece], view);
    if (box.empty()) return {};
    const int px = sizes.bin_px();
    return {(box.x0 - view.x0) / px, (box.y0 - view.y0) / px, (box.x1 - 1 - view.x0) / px + 1,
            (box.y1 - 1 - view.y0) / px + 1};
  }
  [[nodiscard]] RASTRUM_HD std::size_t bin_count(std::uint32_t piece) const {
    const Rect r = bins_of(piece);
    return static_cast<std::size_t>(r.x1 - r.x0) * static_cast<std::size_t>(r.y1 - r.y0);
  }
  /// Bin j of the piece.
  [[nodiscard]] RASTRUM_HD BinPair bin(std::uint32_t piece, std::size_t j) const {
    const Rect r = bins_of(piece);
    const Cell cell = cell_at(bins.order, j, r.x1 - r.x0, r.y1 - r.y0);
    return {piece,
            static_cast<std::uint32_t>((r.y0 + cell.row) * bins.columns() + r.x0 + cell.column)};
  }

  /// Tile j of a bin in order, cut to the view; empty where it lies outside.
  [[nodiscard]] RASTRUM_HD Rect tile(std::uint32_t bin, std::size_t j) const {
    const Rect b = bins.rect(bin);
    const int px = sizes.tile_px();
    const Cell cell = cell_at(bins.order, j, tiles_across(), tiles_across());
    const int x0 = b.x0 + cell.column * px, y0 = b.y0 + cell.row * px;
    return intersection(b, {x0, y0, x0 + px, y0 + px});
  }
  /// Whether the piece may cover a sample of tile j of its bin.
  [[nodiscard]] RASTRUM_HD bool touches(const BinPair& pair, std::size_t j) const {
    const Piece& piece = pieces[pair.piece];
    const Rect box = piece_bounds(piece, tile(pair.bin, j));
    return !box.empty() && may_touch(edges_of(piece), box);
  }
  /// Number of a tile in the view.
  [[nodiscard]] RASTRUM_HD std::uint32_t tile_id(Rect tile) const {
    const Rect view = tiles.view;
    const int px = sizes.tile_px();
    return static_cast<std::uint32_t>((tile.y0 - view.y0) / px * tiles.columns() +
                                      (tile.x0 - view.x0) / px);
  }
};

/// Bin expansion: how many there are …
template <class Sizes>
struct BinCount {
  BasicTiles<Sizes> tiles;
  RASTRUM_HD std::size_t operator()(std::uint32_t piece) const { return tiles.bin_count(piece); }
};
/// … and bin j.
template <class Sizes>
struct MakeBin {
  BasicTiles<Sizes> tiles;
  RASTRUM_HD BinPair operator()(std::uint32_t piece, std::size_t j) const {
    return tiles.bin(piece, j);
  }
};
/// Tile expansion, masked: how many a bin has …
template <class Sizes>
struct TileCount {
  BasicTiles<Sizes> tiles;
  RASTRUM_HD std::size_t operator()(const BinPair&) const { return tiles.tiles_per_bin(); }
};
/// … and which of them are tiles of the piece.
template <class Sizes>
struct TouchesTile {
  BasicTiles<Sizes> tiles;
  RASTRUM_HD bool operator()(const BinPair& pair, std::size_t j) const {
    return tiles.touches(pair, j);
  }
};

}  // namespace rastrum::family
