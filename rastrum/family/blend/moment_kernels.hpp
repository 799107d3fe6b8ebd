// The SIMD leaves of moment-based transparency (moments_simd.cpp), once for each instruction set
// and with the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/transparency/blend.hpp>

namespace rastrum::family {

/// A block while it is blended: element 8 · row + column.
struct alignas(64) MomentBlock {
  float nearest[8], farthest[8];  ///< depths so far, of pixels of a column
  /// A depth's logarithm, from −1 nearest to 1 farthest: log(nearest / depth) · scale + offset.
  struct {
    float nearest, farthest, scale, offset;
  } warp;
  alignas(64) float sum[7][64];  ///< of absorbance · zᵏ
  raster::BlockColors colors;    ///< sums, weighted by transmittance

  void clear();
  /// From the depths so far.
  void set_warp();
};

/// Rows are all fragments of 8 pixels, elements `first` … ; layers at most one of each pixel.
struct MomentKernels {
  /// The first pass: depths.
  void (*row_depths)(const transparency::PackedRow& row, MomentBlock& block) noexcept;
  void (*layer_depths)(const transparency::Layer& layer, MomentBlock& block) noexcept;
  /// The second and third at once.
  void (*row)(const transparency::PackedRow& row, std::size_t first, MomentBlock& block) noexcept;
  /// The second, the third.
  void (*sum_layer)(const transparency::Layer& layer, MomentBlock& block) noexcept;
  void (*weigh_layer)(const transparency::Layer& layer, MomentBlock& block) noexcept;
  void (*finish)(const MomentBlock& block, const raster::BlockColors& behind,
                 raster::BlockColors& out) noexcept;
};

/// `moments`: 4 or 6.
[[nodiscard]] const MomentKernels& moment_kernels(int moments, Isa isa) noexcept;

}  // namespace rastrum::family
