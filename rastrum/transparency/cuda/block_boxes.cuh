// SPDX-License-Identifier: BSD-3-Clause
// The 8 × 8 blocks in which a translucent piece may be visible.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/cuda/sample_pattern.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/raster/rules/make_piece.hpp>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/raster/rules/surface_view.hpp>

namespace rastrum::transparency::cuda {

/// The smallest key of a block at any sample: what lies behind it is hidden.
struct FarthestOfBlock {
  raster::Rect view;
  std::size_t columns;
  const std::uint64_t* keys;
  std::size_t plane;
  int samples;
  RASTRUM_HD std::uint64_t operator()(std::size_t b) const {
    const raster::BlockPlace place(b, columns);
    const int bx = view.x0 / raster::kBlockSize + static_cast<int>(place.column);
    const int by = view.y0 / raster::kBlockSize + static_cast<int>(place.row);
    std::uint64_t farthest = ~std::uint64_t{0};
    for (int s = 0; s < samples; ++s)
      for (std::uint64_t m = raster::samples_inside(view, bx, by); m != 0; m &= m - 1) {
        const std::uint64_t key = keys[static_cast<std::size_t>(s) * plane + b * 64 +
                                       static_cast<std::size_t>(parallel::lowest_bit(m))];
        if (key < farthest) farthest = key;
      }
    return farthest;
  }
};

/// The blocks of a piece's box in `view`; none for an opaque piece.
struct BlocksOfPiece {
  std::span<const raster::Piece> pieces;
  std::span<const std::uint64_t> farthest;
  std::size_t columns;  ///< of blocks
  int bx0, by0;         ///< the first block
  raster::Rect view;
  raster::SamplePattern samples;

  RASTRUM_HD raster::Rect box(std::uint32_t piece) const {
    const raster::Rect px = raster::sampled_bounds(pieces[piece], view, samples);
    if (px.empty()) return {};
    return {px.x0 / raster::kBlockSize, px.y0 / raster::kBlockSize,
            (px.x1 - 1) / raster::kBlockSize + 1, (px.y1 - 1) / raster::kBlockSize + 1};
  }
  RASTRUM_HD std::size_t operator()(std::uint32_t piece) const {
    if ((pieces[piece].flags & kTranslucent) == 0) return 0;
    const raster::Rect b = box(piece);
    return static_cast<std::size_t>(b.x1 - b.x0) * static_cast<std::size_t>(b.y1 - b.y0);
  }
  RASTRUM_HD std::size_t number(const raster::Block& b) const {
    return static_cast<std::size_t>(b.by - by0) * columns + static_cast<std::size_t>(b.bx - bx0);
  }
  /// The j-th block, with the pixels of which a sample is covered; none if the piece is hidden.
  RASTRUM_HD raster::Block block(std::uint32_t piece, std::size_t j) const {
    const raster::Rect b = box(piece);
    const raster::BlockPlace place(j, static_cast<std::size_t>(b.x1 - b.x0));
    const int bx = b.x0 + static_cast<int>(place.column), by = b.y0 + static_cast<int>(place.row);
    raster::Block out{piece, static_cast<std::uint16_t>(bx), static_cast<std::uint16_t>(by), 0};
    const int x0 = bx * raster::kBlockSize, y0 = by * raster::kBlockSize;
    const raster::Rect px{x0, y0, x0 + raster::kBlockSize, y0 + raster::kBlockSize};
    for (int s = 0; s < samples.count; ++s) {
      const raster::Piece p = raster::moved(pieces[piece], samples.at[s]);
      const raster::Edges edges = raster::edges_of(p);
      if (!raster::may_touch(edges, px)) continue;
      if (raster::has_depth_bounds(p) &&
          raster::make_key(raster::highest_depth(p, px), p.low) <= farthest[number(out)])
        continue;
      out.mask |= raster::cover_8x8(edges, bx, by);
    }
    out.mask &= raster::samples_inside(view, bx, by);
    return out;
  }
};

}  // namespace rastrum::transparency::cuda
