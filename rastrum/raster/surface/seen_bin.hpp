// SPDX-License-Identifier: BSD-3-Clause
// A bin's triangles, set up for shaders before its blocks are shaded (see_bin): each once, however
// many blocks see it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include <rastrum/config.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/rules/color.hpp>
#include <rastrum/raster/rules/surface_view.hpp>

namespace rastrum::raster {

/// The surface of a bin or a part of it, in whole blocks, at most 64 × 64 px.
struct BinSurface {
  SurfaceView keys;
  Rect rect;  ///< the part that is shaded; starts at a block's first pixel

  [[nodiscard]] const std::uint64_t* block(int column, int row) const {
    return keys.block(rect.x0 / kBlockSize + column, rect.y0 / kBlockSize + row);
  }
};

/// Set-up triangles of a bin, for one thread.
struct alignas(64) SeenBin {
  /// Triangles at once; a row of blocks sees up to kOfRow.
  static constexpr std::size_t kRoom = 2048, kOfRow = 512;
  static constexpr std::size_t kQuads = 8, kPairs = 6;

  /// By number, four floats each. Rows of a multiple of 4096 bytes would compete for the same cache
  /// sets. For the lit shaders rows 0 to 2 are the weights (x0, y0, p1, q1, p2, q2, inv_w of
  /// LitTriangle, with 1 before the last two floats where they are exact, else 0), rows up to 4 the
  /// normals, and 5 to 7 the colours, by corner. For materials 0 to 2 are the normals of face and
  /// corners, 3 and 4 texture coordinates and whether there are normals and colours, and 5 to 7 the
  /// colours.
  float quads[kQuads][kRoom * 4 + 16];
  /// For materials, two each: MaterialLanes::planes.
  double pairs[kPairs][kRoom * 2 + 8];
  std::uint32_t material[kRoom];  ///< for materials: its number
  /// For materials: whether some or all triangles have them.
  bool some_normals, all_normals, some_colors, all_colors;
  std::uint64_t low[kRoom + 1];  ///< of the keys, by number
  std::uint64_t table[2048];     ///< by bits of the low part: low << 16 | number
  /// The number of each covered pixel's triangle, by block; others have any. Written in runs of 8.
  std::uint16_t places[kBlocksPerBin][64 + 8];
  int end_row;  ///< rows of blocks from this one on are not set

  [[nodiscard]] const std::uint16_t* places_of(int x0, int y0) const {
    const int mask = kBlocksPerBinRow - 1;
    return places[(y0 / kBlockSize & mask) * kBlocksPerBinRow + (x0 / kBlockSize & mask)];
  }
  [[nodiscard]] std::uint16_t* places_of(int x0, int y0) {
    return const_cast<std::uint16_t*>(std::as_const(*this).places_of(x0, y0));
  }
};

/// Whether triangles are so small that a block sees many.
[[nodiscard]] bool is_fine(const BinSurface& bin) noexcept;

}  // namespace rastrum::raster
