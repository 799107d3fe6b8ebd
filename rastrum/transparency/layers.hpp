// SPDX-License-Identifier: BSD-3-Clause
// The visibility of transparency: keeps every fragment that may be visible and resolves a pixel's
// in order (papers 4 and 5; docs/layers.md).
#pragma once

#include <memory>
#include <span>

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/frame/frame_run.hpp>
#include <rastrum/transparency/blend.hpp>

namespace rastrum::transparency {

/// Records translucent pieces and draws opaque ones like BinKeys; `finish` blends. For a bin, or a
/// part of one, that one thread owns. The keys become those of the nearest surface, translucent or
/// not.
///
/// Counters: "translucent fragments" that opaque surfaces do not hide, "layer blocks" (a piece's
/// parts of 8 × 8 blocks), "deepest" (most fragments of a pixel), "windows" (walks over a block's
/// pieces beyond the first), and "wrong pixels" with AddedTransparency::filter or "repaired pixels"
/// with `exact`. Memory: 24 bytes per small triangle or block of a larger one, and 8 bytes per
/// pixel of a block and layer.
class LayeredBin {
 public:
  static constexpr bool kColors = true;  ///< of the surface

  explicit LayeredBin(MemoryAccount& memory);
  LayeredBin(LayeredBin&&) noexcept;
  ~LayeredBin();

  /// As in BinKeys.
  void begin(const raster::BinContext& context, const raster::SurfaceView& surface,
             raster::Rect rect);
  void blocks(const raster::Piece* pieces, std::span<const raster::Block> blocks);
  /// True with one sample per pixel: then windows() takes what raster::CoverWindows writes. Opaque
  /// windows become blocks.
  [[nodiscard]] bool takes_windows() const;
  void windows(const raster::Piece* pieces, std::span<raster::Block> windows);
  void fragments(std::span<const raster::BinFragment> fragments);
  [[nodiscard]] raster::DepthBounds* bounds();
  static void find_bounds() {}  // pieces that face away are not drawn later
  void finish();
  void collect(raster::Counters& counters);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rastrum::transparency
