// SPDX-License-Identifier: BSD-3-Clause
// The rows of the coverage axis.
#include <array>

#include <papers/axes/coverage.hpp>
#include <papers/paper1/hybrid.hpp>
#include <papers/paper1/pineda.hpp>
#include <papers/paper1/scanline.hpp>
#include <papers/paper1/tiled.hpp>
#include <papers/paper2/binned.hpp>
#include <papers/table/grouped.hpp>

namespace rastrum::family {
namespace {

/// Bytes per piece that a coverage on a PieceArray takes: the piece twice (48 each, in its group
/// and in the array), its index as filtered and as partitioned (4 each), its place in one expansion
/// at a time (8).
constexpr int kIndexedPiece = 2 * 48 + 2 * 4 + 8;

}  // namespace

std::span<const CoverageRow> coverages() noexcept {
  static constexpr std::array kTable{
      CoverageRow{
          "grouped",
          "(bin, piece) pairs sorted in groups of triangles; a thread owns a bin and shades "
          "it in cache",
          true, true, 160, make_grouped},
      CoverageRow{"scanline", "triangles expanded to rows, rows to columns, at once into the frame",
                  false, true, kIndexedPiece, make_scanline},
      CoverageRow{"pineda",
                  "bins and tiles by edge functions and masks, small triangles apart, at once into "
                  "the frame",
                  false, true, kIndexedPiece, make_pineda},
      CoverageRow{"tiled",
                  "(tile, triangle) pairs sorted by tile; a thread owns a tile and shades it in "
                  "cache",
                  true, true, kIndexedPiece, make_tiled},
      CoverageRow{"hybrid",
                  "small triangles at once into the frame, the others sorted by tile onto it",
                  false, true, kIndexedPiece, make_hybrid},
      CoverageRow{
          "binned",
          "batches of 32 triangles; large ones go through a queue of bins, whose tiles are dealt "
          "out in equal shares or whose bins belong to workers (paper 2)",
          false, true, 128, make_binned},
  };
  return kTable;
}

}  // namespace rastrum::family
