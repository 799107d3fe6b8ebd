// A variant of the last stage of rasterizer.cuh, for scenes of many large triangles behind each
// other: the pairs of large pieces and tiles are sorted by tile, and a block of threads owns a
// tile, whose words lie in shared memory (32 KiB) until all its pieces are drawn. A thread owns
// every n-th sample of it, so that the maximum is a plain one, and each word goes to the device's
// memory once.
//
// Not the default: what it costs to sort, and when that pays, is to be measured on a GPU. Source:
// `tiled` of paper 1 (section 3.3), with the tile where paper 2 has its bins.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/raster/cuda/cover.cuh>

namespace rastrum::raster {

/// Shared memory of a team that owns a tile.
struct OwnedTile {
  static constexpr std::size_t kBlocks = TeamMasks::kCount;  ///< 8 × 8 of them
  std::uint64_t words[kBlocks * 64];
  std::uint64_t mask[kBlocks];
};
static_assert(kDeviceTile == 8 * kBlockSize && sizeof(OwnedTile) <= 48 * 1024);

/// Bytes of a pair while it is sorted, with its share of what sorts.
inline constexpr std::uint64_t kOwnedPairBytes = 8 * sizeof(std::uint32_t);

namespace cuda_detail {

/// The tile, row by row in the view, of pair i, and its piece.
template <class Places>
struct PairOf {
  std::span<const Piece> pieces;
  DeviceSurface surface;
  Places places;
  std::uint32_t* tile;
  std::uint32_t* piece;
  RASTRUM_HD void operator()(std::size_t i) const {
    const std::size_t k = places.segment_of(i);
    const Rect view = surface.view;
    const Rect tiles = tiles_of(surface.bounds(pieces[k]), view);
    const int j = static_cast<int>(i - places.first(k)), across = tiles.x1 - tiles.x0;
    const int columns = (view.x1 - view.x0 + kDeviceTile - 1) / kDeviceTile;
    tile[i] = static_cast<std::uint32_t>((tiles.y0 + j / across) * columns + tiles.x0 + j % across);
    piece[i] = static_cast<std::uint32_t>(k);
  }
};

struct DrawOwnedTile {
  static constexpr std::size_t kSamples = OwnedTile::kBlocks * 64;

  std::span<const Piece> pieces;
  DeviceSurface surface;
  std::span<const std::uint32_t> tile, first;  ///< each tile that is touched, and its first pair
  std::span<const std::uint32_t> piece;        ///< of each pair
  std::uint64_t* fragments;

  template <class Team>
  RASTRUM_HD void operator()(std::size_t t, OwnedTile& own, const Team& team) const {
    const Rect view = surface.view;
    const int columns = (view.x1 - view.x0 + kDeviceTile - 1) / kDeviceTile;
    const int x0 = view.x0 + static_cast<int>(tile[t]) % columns * kDeviceTile;
    const int y0 = view.y0 + static_cast<int>(tile[t]) / columns * kDeviceTile;
    const Rect in_view = common_of(view, {x0, y0, x0 + kDeviceTile, y0 + kDeviceTile});
    std::uint64_t mine = 0;
    for (int s = 0; s < surface.samples.count; ++s)
      mine += draw(t, in_view, x0 / kBlockSize, y0 / kBlockSize, s, own, team);
    if (mine > 0) parallel::atomic_add(*fragments, mine);
  }

 private:
  /// One sample; returns the fragments of a member.
  template <class Team>
  RASTRUM_HD std::uint64_t draw(std::size_t t, Rect in_view, int bx0, int by0, int s,
                                OwnedTile& own, const Team& team) const {
    for (std::size_t k = team.rank(); k < kSamples; k += team.size()) own.words[k] = 0;
    std::uint64_t mine = 0;
    const std::size_t end = t + 1 < first.size() ? first[t + 1] : piece.size();
    for (std::size_t pair = first[t]; pair < end; ++pair) {
      const Piece p = moved(pieces[piece[pair]], surface.samples.at[s]);
      const Rect box = piece_bounds(p, in_view);
      const Edges edges = edges_of(p);
      for (std::size_t k = team.rank(); k < OwnedTile::kBlocks; k += team.size()) {
        const int bx = bx0 + static_cast<int>(k % 8), by = by0 + static_cast<int>(k / 8);
        own.mask[k] = cover_box(edges, box, bx, by);
        mine += static_cast<std::uint64_t>(parallel::popcount(own.mask[k]));
      }
      team.sync();
      for (std::size_t k = team.rank(); k < kSamples; k += team.size()) {
        const int i = static_cast<int>(k % 64);
        if ((own.mask[k / 64] >> i & 1) == 0) continue;
        const int bx = bx0 + static_cast<int>(k / 64 % 8), by = by0 + static_cast<int>(k / 512);
        const std::uint64_t word = surface.word(p, bx, by, i);
        if (word > own.words[k]) own.words[k] = word;
      }
      team.sync();
    }
    for (std::size_t k = team.rank(); k < kSamples; k += team.size())
      if (own.words[k] != 0) {
        const int bx = bx0 + static_cast<int>(k / 64 % 8), by = by0 + static_cast<int>(k / 512);
        parallel::atomic_maximum(surface.plane_of(s)[surface.words.index(bx, by) * 64 + k % 64],
                                 own.words[k]);
      }
    return mine;
  }
};

}  // namespace cuda_detail

/// Draws the pairs of `places`, an expansion of `pieces` to the tiles of the view that they touch.
/// Overdraw is not counted. Work O(pairs · (log + samples of a tile)); memory kOwnedPairBytes a
/// pair.
template <class Exec, class Places>
void draw_owned_tiles(Exec& exec, std::span<const Piece> pieces, const Places& places,
                      const DeviceSurface& surface, std::uint64_t* fragments) {
  if (places.size() == 0) return;
  auto tile = parallel::make_buffer<std::uint32_t>(exec, places.size());
  auto piece = parallel::make_buffer<std::uint32_t>(exec, places.size());
  parallel::for_each_index(exec, places.size(),
                           cuda_detail::PairOf<decltype(places.view())>{
                               pieces, surface, places.view(), tile.data(), piece.data()});
  const std::uint64_t tiles = area_of(tiles_of(surface.view, surface.view));
  parallel::sort_by_key(exec, tile, piece, static_cast<int>(std::bit_width(tiles)));
  const auto pairs =
      parallel::reduce_by_key(exec, tile, parallel::constant(places.size(), std::uint32_t{1}));
  auto first = parallel::make_buffer<std::uint32_t>(exec, pairs.keys.size());
  parallel::exclusive_scan(exec, pairs.values, first, std::uint32_t{0});
  parallel::for_each_team<OwnedTile, 128>(
      exec, first.size(),
      cuda_detail::DrawOwnedTile{pieces, surface, parallel::view_of(pairs.keys),
                                 parallel::view_of(std::as_const(first)),
                                 parallel::view_of(std::as_const(piece)), fragments});
}

}  // namespace rastrum::raster
