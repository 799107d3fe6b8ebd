// What the lit shaders keep while they shade the surface of a bin in one go (Shading::shade_bin).
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/config.hpp>
#include <rastrum/raster/resolve/surface.hpp>
#include <rastrum/raster/shade/color.hpp>
#include <rastrum/raster/shade/shading.hpp>

namespace rastrum::raster {

/// The surface of a bin, or of a part of one: of whole blocks, at most 64 × 64 px.
struct BinSurface {
  SurfaceView keys;
  Rect rect;  ///< what is shaded of it; its first pixel is the first of a block

  [[nodiscard]] const std::uint64_t* block(int column, int row) const {
    return keys.block(rect.x0 / kBlockSize + column, rect.y0 / kBlockSize + row);
  }
};

/// Of a thread. Pixels have the numbers 64 · block + 8 · row + column, blocks 8 · row + column.
struct alignas(64) LitBin {
  static constexpr std::size_t kBlocks = 64, kPixels = kBlocks * 64;
  /// Triangles are set up so many at once, or more.
  static constexpr std::size_t kLeastOfGroup = 4, kMostGroups = kPixels / kLeastOfGroup;

  /// By block; alpha is 1 from begin() on. The last one takes what is no pixel's.
  BlockColors colors[kBlocks + 1];
  std::uint64_t low[kPixels + 1];  ///< of the triangles, in the order in which they are met
  /// Runs of pixels of a row that see the same triangle: pixel | triangle << 12 | (length − 1)
  /// << 24.
  std::uint32_t runs[kPixels];
  std::uint16_t table[2048];  ///< by some bits of the low part: the number of one that has them
  std::uint32_t begin_of[kMostGroups], end_of[kMostGroups];
  /// The pixels of each group of triangles, from begin_of to end_of: pixel | lane << 12. Each
  /// begins at a full vector and has room for a run beyond its end.
  alignas(64) std::uint16_t fragments[kPixels + kMostGroups * (kLeastOfGroup + 7)];

  void begin() {
    for (BlockColors& block : colors)
      for (float& a : block.a) a = 1;
  }
};

/// Whether the bin's triangles are so small that it is worth it, and there are lanes for the model.
[[nodiscard]] bool suits_lit_bin(Isa isa, const LitShading& lit, const BinSurface& bin) noexcept;
/// Sets the colours of the pixels of `bin`, which it suits, that hold a surface; others may be set
/// to anything.
void shade_lit_bin(Isa isa, const LitShading& lit, const FrameGeometry& frame,
                   const BinSurface& bin, LitBin& own) noexcept;

}  // namespace rastrum::raster
