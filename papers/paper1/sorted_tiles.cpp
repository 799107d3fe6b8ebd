// SPDX-License-Identifier: BSD-3-Clause
#include <papers/paper1/sorted_tiles.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <utility>

#include <rastrum/parallel/reduce_by_key.hpp>
#include <rastrum/parallel/scan.hpp>
#include <rastrum/parallel/sort_by_key.hpp>

namespace rastrum::family {
namespace {

/// Pieces sorted by tile: each tile has a segment, in order of submission. Memory grows with the
/// pairs, not with the number of tiles.
class TileSegments {
 public:
  /// Sorts by the bits that `tile_count` needs. Work O(pairs), 20 bytes a pair.
  TileSegments(parallel::Threads& exec, parallel::Buffer<std::uint32_t> tile_ids,
               parallel::Buffer<std::uint32_t> pieces, std::size_t tile_count)
      : pieces_(std::move(pieces)),
        tiles_(parallel::make_buffer<std::uint32_t>(exec)),
        begins_(parallel::make_buffer<std::size_t>(exec)) {
    parallel::sort_by_key(exec, tile_ids, pieces_,
                          static_cast<int>(std::bit_width(tile_count - 1)));
    auto segments = parallel::reduce_by_key(exec, tile_ids,
                                            parallel::constant(tile_ids.size(), std::size_t{1}));
    parallel::exclusive_scan(exec, segments.values, segments.values, std::size_t{0});
    tiles_ = std::move(segments.keys);
    begins_ = std::move(segments.values);
  }

  /// The pieces of a tile. O(log tiles that have pieces).
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t tile) const {
    const auto found = std::lower_bound(tiles_.begin(), tiles_.end(), tile);
    if (found == tiles_.end() || *found != tile) return {};
    const auto segment = static_cast<std::size_t>(found - tiles_.begin());
    const std::size_t end = segment + 1 < begins_.size() ? begins_[segment + 1] : pieces_.size();
    return std::span(pieces_).subspan(begins_[segment], end - begins_[segment]);
  }

 private:
  parallel::Buffer<std::uint32_t> pieces_;  ///< sorted by tile
  parallel::Buffer<std::uint32_t> tiles_;   ///< the tiles that have pieces, ascending
  parallel::Buffer<std::size_t> begins_;    ///< of the tiles' segments
};

/// Writes the results of a masked expansion of bins as pairs and sorts them.
TileSegments sort_by_tile(Frame& frame, const Tiles& tiles, const parallel::Buffer<BinPair>& bins,
                          const parallel::MaskedExpansion<64>& expansion) {
  auto ids = parallel::make_buffer<std::uint32_t>(frame.exec, expansion.size());
  auto pieces = parallel::make_buffer<std::uint32_t>(frame.exec, expansion.size());
  parallel::expand_chunks(frame.exec, expansion, bins, [&](const auto& chunk) {
    std::size_t k = chunk.begin();
    chunk.each([&](const BinPair& pair, std::size_t j) {
      ids[k] = tiles.tile_id(tiles.tile(pair.bin, j));
      pieces[k++] = pair.piece;
    });
  });
  return {frame.exec, std::move(ids), std::move(pieces), tiles.tiles.count()};
}

}  // namespace

void draw_sorted_tiles(Frame& frame, BinSizes sizes, const Piece* pieces,
                       std::span<const std::uint32_t> which) {
  constexpr std::uint64_t kPairBytes = 20;
  const Tiles tiles(sizes, pieces, frame.view, frame.tuning.order);
  const int px = sizes.tile_px();
  const TileGrid owners{frame.view, std::max(px, kBlockSize)};
  expand_tiles(
      frame, tiles, which, parallel::kBlock, kPairBytes,
      [&](const auto& bins, const auto& expansion) {
        const TileSegments segments = sort_by_tile(frame, tiles, bins, expansion);
        const auto each_tile = [&](std::size_t owner, auto&& f) {
          const Rect rect = owners.rect(owner);
          for (int y = rect.y0; y < rect.y1; y += px)
            for (int x = rect.x0; x < rect.x1; x += px) {
              const Rect tile = intersection(rect, {x, y, x + px, y + px});
              f(tile, segments.of(tiles.tile_id(tile)));
            }
        };
        draw_tiles(
            frame, owners,
            [&](std::size_t owner) {
              bool is_empty = true;
              each_tile(owner, [&](Rect, auto segment) { is_empty = is_empty && segment.empty(); });
              return is_empty;
            },
            [&](std::size_t owner, Emitter& emitter) {
              emitter.use(pieces);
              each_tile(owner, [&](Rect tile, auto segment) {
                for (const std::uint32_t piece : segment)
                  add_tile(frame, tiles, piece, tile, emitter);
              });
            });
      });
}

}  // namespace rastrum::family
