// SPDX-License-Identifier: BSD-3-Clause
// The mask of the tiles of a bin that a piece covers (paper 2, section 2, "Tile coverage"), row by
// row of tiles, from the half-spaces of its edges.
//
// The paper extends the edges by half a tile, so its mask misses no tile and has some too many.
// Here the mask is exact: it has a tile if and only if one of the tile's samples is covered. An
// edge rules a tile out if even the sample farthest inside is outside. If all other edges hold all
// samples of the tile, that farthest sample is covered. Tiles that two or more edges cut, at
// corners and along slivers, are tested row by row.
#pragma once

#include <cstdint>

#include <papers/axes/names.hpp>
#include <papers/paper1/bins.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/raster/rules/piece.hpp>

namespace rastrum::family {

/// The numbers t in [0, n) with base + step · t ≥ 0. They are the first or the last ones.
RASTRUM_HD inline Span half_line(std::int64_t base, std::int64_t step, int n) {
  const bool first = base >= 0, last = base + step * (n - 1) >= 0;
  if (first && last) return {0, n};
  if (!first && !last) return {0, 0};
  if (first) return {0, static_cast<int>(base / -step) + 1};
  return {static_cast<int>(-floor_div(base, step)), n};
}

RASTRUM_HD inline bool covers_any(const Piece& piece, Rect r) {
  const Rect box = piece_bounds(piece, r);
  for (int y = box.y0; y < box.y1; ++y) {
    const Span span = row_span(piece, y, box.x0, box.x1);
    if (span.begin < span.end) return true;
  }
  return false;
}

/// The pixels of tile t of a bin, numbered row by row. They may lie beyond the bin where the view
/// cuts it.
[[nodiscard]] RASTRUM_HD inline Rect tile_of_bin(BinSizes sizes, Rect bin, int t) {
  const int px = sizes.tile_px();
  const Cell cell = sizes.tile_cell(t);
  const int x0 = bin.x0 + cell.column * px, y0 = bin.y0 + cell.row * px;
  return {x0, y0, x0 + px, y0 + px};
}

/// Calls add(t), ascending, for the tiles whose samples inside of `bin` are partly covered by
/// `piece`.
template <class Add>
RASTRUM_HD void cover_tiles(BinSizes sizes, const Piece& piece, Rect bin, Add&& add) {
  const Rect box = piece_bounds(piece, bin);
  if (box.empty()) return;
  const int px = sizes.tile_px(), by = sizes.tile_log2, across = sizes.tiles_across();
  // For tile (0, 0) and each edge: values at the sample farthest inside and at the one farthest
  // outside.
  const Edges edges = edges_of(piece);
  std::int64_t inmost[4], outmost[4], along_x[4], along_y[4];
  for (int i = 0; i < edges.count; ++i) {
    const Edge e = edges.edge[i];
    const std::int64_t corner = e.base + std::int64_t{e.a} * bin.x0 + std::int64_t{e.b} * bin.y0;
    const std::int64_t a = e.a, b = e.b;
    inmost[i] = corner + (px - 1) * ((a > 0 ? a : 0) + (b > 0 ? b : 0));
    outmost[i] = corner + (px - 1) * ((a < 0 ? a : 0) + (b < 0 ? b : 0));
    along_x[i] = a * px;
    along_y[i] = b * px;
  }
  const int first_row = (box.y0 - bin.y0) >> by, last_row = (box.y1 - 1 - bin.y0) >> by;
  for (int row = first_row; row <= last_row; ++row) {
    Span touched{(box.x0 - bin.x0) >> by, ((box.x1 - 1 - bin.x0) >> by) + 1};
    Span held[4];  // tiles whose samples are all inside the edge
    for (int i = 0; i < edges.count; ++i) {
      const Span touches = half_line(inmost[i] + along_y[i] * row, along_x[i], across);
      touched = {touched.begin > touches.begin ? touched.begin : touches.begin,
                 touched.end < touches.end ? touched.end : touches.end};
      held[i] = half_line(outmost[i] + along_y[i] * row, along_x[i], across);
    }
    for (int column = touched.begin; column < touched.end; ++column) {
      const int t = row * across + column;
      int cut = 0;
      for (int i = 0; i < edges.count; ++i) cut += column < held[i].begin || column >= held[i].end;
      const Rect r = tile_of_bin(sizes, bin, t);
      const Rect seen{r.x0, r.y0, r.x1 < bin.x1 ? r.x1 : bin.x1, r.y1 < bin.y1 ? r.y1 : bin.y1};
      const bool whole = seen.x1 == r.x1 && seen.y1 == r.y1;
      if ((whole && cut <= 1) || covers_any(piece, seen)) add(t);
    }
  }
}

}  // namespace rastrum::family
