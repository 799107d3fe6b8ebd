// The hierarchy of paper 1 (section 3.1.3): triangles are expanded to the bins that their boxes
// touch, bins by expand_masked to the tiles that an edge test leaves. Bin and tile sizes are
// compiled in, since a bin's tiles are the bits of a mask.
//
// Deviation: a tile is tested by the largest value of each edge function over the samples of tile
// and box, in exact integers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <rastrum/core/error.hpp>
#include <rastrum/parallel/expand_masked_each.hpp>
#include <rastrum/raster/coverage.hpp>
#include <rastrum/raster/coverage/coverage.hpp>
#include <rastrum/raster/coverage/expand_in_turns.hpp>
#include <rastrum/raster/frame.hpp>
#include <rastrum/raster/options.hpp>

namespace rastrum::raster {

RASTRUM_HD inline Rect intersection(Rect a, Rect b) {
  return {a.x0 > b.x0 ? a.x0 : b.x0, a.y0 > b.y0 ? a.y0 : b.y0, a.x1 < b.x1 ? a.x1 : b.x1,
          a.y1 < b.y1 ? a.y1 : b.y1};
}

template <class C>
[[nodiscard]] std::unique_ptr<Coverage> make_coverage(const Tuning& tuning, MemoryAccount& memory) {
  return std::make_unique<C>(tuning, memory);
}

/// A piece in a bin that its box touches.
struct BinPair {
  std::uint32_t piece, bin;
};

/// A view in bins of kBin px with tiles of kTile px, both numbered row by row.
template <int kBin, int kTile>
struct Tiles {
  static constexpr int kTilesAcross = kBin / kTile;
  static constexpr int kTilesPerBin = kTilesAcross * kTilesAcross;

  const Piece* pieces;
  TileGrid bins, tiles;

  Tiles(const Frame& frame, const Piece* p)
      : pieces(p),
        bins{frame.view, kBin, frame.request.tuning.order},
        tiles{frame.view, kTile, frame.request.tuning.order} {}

  /// The bins that the box of a piece touches, as columns and rows of the view's.
  [[nodiscard]] Rect bins_of(std::uint32_t piece) const {
    const Rect view = bins.view;
    const Rect box = piece_bounds(pieces[piece], view);
    if (box.empty()) return {};
    return {(box.x0 - view.x0) / kBin, (box.y0 - view.y0) / kBin, (box.x1 - 1 - view.x0) / kBin + 1,
            (box.y1 - 1 - view.y0) / kBin + 1};
  }
  [[nodiscard]] std::size_t bin_count(std::uint32_t piece) const {
    const Rect r = bins_of(piece);
    return static_cast<std::size_t>(r.x1 - r.x0) * static_cast<std::size_t>(r.y1 - r.y0);
  }
  /// Bin j of the piece.
  [[nodiscard]] BinPair bin(std::uint32_t piece, std::size_t j) const {
    const Rect r = bins_of(piece);
    const Cell cell = cell_at(bins.order, j, r.x1 - r.x0, r.y1 - r.y0);
    return {piece,
            static_cast<std::uint32_t>((r.y0 + cell.row) * bins.columns() + r.x0 + cell.column)};
  }

  /// Tile j of a bin in order, cut to the view; empty where it lies outside.
  [[nodiscard]] Rect tile(std::uint32_t bin, std::size_t j) const {
    const Rect b = bins.rect(bin);
    const Cell cell = cell_at(bins.order, j, kTilesAcross, kTilesAcross);
    const int x0 = b.x0 + cell.column * kTile, y0 = b.y0 + cell.row * kTile;
    return intersection(b, {x0, y0, x0 + kTile, y0 + kTile});
  }
  /// Whether the piece may cover a sample of tile j of its bin.
  [[nodiscard]] bool touches(const BinPair& pair, std::size_t j) const {
    const Piece& piece = pieces[pair.piece];
    const Rect box = piece_bounds(piece, tile(pair.bin, j));
    return !box.empty() && may_touch(edges_of(piece), box);
  }
  /// Number of a tile in the view.
  [[nodiscard]] std::uint32_t tile_id(Rect tile) const {
    const Rect view = tiles.view;
    return static_cast<std::uint32_t>((tile.y0 - view.y0) / kTile * tiles.columns() +
                                      (tile.x0 - view.x0) / kTile);
  }

  /// Hands f(bins, tiles) the pieces' bins and the masked expansion of their tiles, a turn at a
  /// time; `tile_bytes` is what f needs for a tile. Counts "bins" and "tile pairs".
  template <class F>
  void expand(Frame& frame, std::span<const std::uint32_t> which, std::size_t tiles_per_chunk,
              std::uint64_t tile_bytes, F&& f) const {
    // The bin, its place among the masks, its mask, and all tiles that it may have.
    constexpr std::uint64_t kBinBytes =
        sizeof(BinPair) + sizeof(std::size_t) + std::uint64_t{kTilesPerBin} / 8;
    std::uint64_t pairs = 0;
    const std::uint64_t bin_pairs = expand_in_turns(
        frame, which, [this](std::uint32_t piece) { return bin_count(piece); },
        [this](std::uint32_t piece, std::size_t j) { return bin(piece, j); },
        kBinBytes + kTilesPerBin * tile_bytes,
        [&](const parallel::Buffer<BinPair>& in) {
          const parallel::MaskedExpansion<kTilesPerBin> expansion(
              frame.exec, in, [](const BinPair&) { return std::size_t{kTilesPerBin}; },
              [this](const BinPair& pair, std::size_t j) { return touches(pair, j); },
              tiles_per_chunk);
          pairs += expansion.size();
          f(in, expansion);
        });
    frame.count("bins", bin_pairs);
    frame.count("tile pairs", pairs);
  }
};

/// Adds the samples of `tile` that the piece covers: a quarter of a block (4 px), a block, or the
/// blocks of a larger tile.
template <int kTile>
void add_tile(const Frame& frame, const Piece* pieces, std::uint32_t piece, Rect tile,
              Emitter& emitter) {
  const int bx0 = tile.x0 / kBlockSize, by0 = tile.y0 / kBlockSize;
  if constexpr (kTile < kBlockSize) {
    Block block{piece, static_cast<std::uint16_t>(bx0), static_cast<std::uint16_t>(by0), 0};
    frame.kernel.masks(pieces, &block, 1);
    block.mask &= samples_inside(tile, bx0, by0);
    emitter.add(block);
  } else {
    for (int by = by0; by <= (tile.y1 - 1) / kBlockSize; ++by)
      for (int bx = bx0; bx <= (tile.x1 - 1) / kBlockSize; ++bx)
        emitter.add_uncovered(piece, bx, by);
  }
}

/// A coverage C<bin, tile> of the sizes that `tuning` asks for: those of paper 1's tables 4 and 6.
/// Throws Error{invalid_argument} that lists them for any other.
template <template <int, int> class C>
[[nodiscard]] std::unique_ptr<Coverage> make_with_tiles(std::string_view name, const Tuning& tuning,
                                                        MemoryAccount& memory) {
  struct Sizes {
    int bin_px, tile_px;
    std::unique_ptr<Coverage> (*make)(const Tuning&, MemoryAccount&);
  };
  static constexpr Sizes kCompiled[] = {
      {16, 4, make_coverage<C<16, 4>>},   {32, 4, make_coverage<C<32, 4>>},
      {32, 8, make_coverage<C<32, 8>>},   {64, 4, make_coverage<C<64, 4>>},
      {64, 8, make_coverage<C<64, 8>>},   {64, 16, make_coverage<C<64, 16>>},
      {128, 8, make_coverage<C<128, 8>>}, {128, 16, make_coverage<C<128, 16>>},
  };
  const int bin_px = tuning.bin_px == 0 ? 32 : tuning.bin_px;
  const int tile_px = tuning.tile_px == 0 ? 8 : tuning.tile_px;
  std::string known;
  for (const Sizes& s : kCompiled) {
    if (s.bin_px == bin_px && s.tile_px == tile_px) return s.make(tuning, memory);
    known.append(known.empty() ? "" : ", ").append(std::to_string(s.bin_px));
    known.append("/").append(std::to_string(s.tile_px));
  }
  throw Error(Errc::invalid_argument, std::string("'")
                                          .append(name)
                                          .append("' is compiled for these bins/tiles in px: ")
                                          .append(known));
}

}  // namespace rastrum::raster
