// The hierarchy of bins and tiles (bins.hpp) on the host's threads. Bin and tile sizes are compiled
// in, since a bin's tiles are the bits of a mask.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <rastrum/error.hpp>
#include <rastrum/family/coverage/bins.hpp>
#include <rastrum/family/coverage/coverage.hpp>
#include <rastrum/family/coverage/expand_in_turns.hpp>
#include <rastrum/family/frame.hpp>
#include <rastrum/frame.hpp>
#include <rastrum/parallel/masked_expansion.hpp>
#include <rastrum/tuning.hpp>

namespace rastrum::family {

template <class C>
[[nodiscard]] std::unique_ptr<Coverage> make_coverage(const Tuning& tuning, MemoryAccount& memory) {
  return std::make_unique<C>(tuning, memory);
}

/// A view in bins of kBin px with tiles of kTile px.
template <int kBin, int kTile>
struct Tiles : BasicTiles<FixedSizes<kBin, kTile>> {
  using Sizes = FixedSizes<kBin, kTile>;
  static constexpr int kTilesPerBin = kBin / kTile * (kBin / kTile);

  Tiles(const Frame& frame, const Piece* p)
      : BasicTiles<Sizes>(Sizes{}, p, frame.view, frame.tuning.order) {}

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
        frame, which, BinCount<Sizes>{*this}, MakeBin<Sizes>{*this},
        kBinBytes + kTilesPerBin * tile_bytes, [&](const parallel::Buffer<BinPair>& in) {
          const parallel::MaskedExpansion<kTilesPerBin> expansion(
              frame.exec, in, TileCount<Sizes>{*this}, TouchesTile<Sizes>{*this}, tiles_per_chunk);
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

}  // namespace rastrum::family
