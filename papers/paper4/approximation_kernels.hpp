// SPDX-License-Identifier: BSD-3-Clause
// The SIMD leaves of the approximations (approximations_simd.cpp), one for each instruction set,
// all with the same bits. A row is all fragments of 8 pixels, elements `first` … of the block. A
// layer has at most one fragment of each pixel. Elements are numbered 8 · row + column.
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/transparency/blend.hpp>

namespace rastrum::family {

/// The state of a block that is blended by moments.
struct alignas(64) MomentBlock {
  float nearest[8], farthest[8];  ///< depths so far, of the pixels of a column
  /// Logarithm of a depth, from −1 (nearest) to 1 (farthest): log(nearest / depth) · scale +
  /// offset.
  struct {
    float nearest, farthest, scale, offset;
  } warp;
  alignas(64) float sum[7][64];  ///< of absorbance · zᵏ
  raster::BlockColors colors;    ///< sums, weighted by transmittance

  void clear();
  /// Computes `warp` from the depths so far.
  void set_warp();
};

struct MomentKernels {
  /// The first pass: depths.
  void (*row_depths)(const transparency::PackedRow& row, MomentBlock& block) noexcept;
  void (*layer_depths)(const transparency::Layer& layer, MomentBlock& block) noexcept;
  /// The second and third passes at once.
  void (*row)(const transparency::PackedRow& row, std::size_t first, MomentBlock& block) noexcept;
  /// The second pass and the third.
  void (*sum_layer)(const transparency::Layer& layer, MomentBlock& block) noexcept;
  void (*weigh_layer)(const transparency::Layer& layer, MomentBlock& block) noexcept;
  void (*finish)(const MomentBlock& block, const raster::BlockColors& behind,
                 raster::BlockColors& out) noexcept;
};

/// Weighted blending.
struct alignas(64) WeightedBlock {
  raster::BlockColors sum;
  float through[64];

  void clear();
};

struct WeightedKernels {
  void (*row)(const transparency::PackedRow& row, std::size_t first, WeightedBlock& block) noexcept;
  void (*layer)(const transparency::Layer& layer, WeightedBlock& block) noexcept;
  void (*finish)(const WeightedBlock& block, const raster::BlockColors& behind,
                 raster::BlockColors& out) noexcept;
};

/// Blending that keeps a few layers a pixel.
inline constexpr std::size_t kKeptLayers = 4;
struct alignas(64) MultiLayerBlock {
  /// Nearest first, premultiplied; a depth below 0 means no layer.
  struct {
    float depth[64], r[64], g[64], b[64], through[64];
  } layers[kKeptLayers];

  void clear();
};

struct MultiLayerKernels {
  void (*row)(const transparency::PackedRow& row, std::size_t first,
              MultiLayerBlock& block) noexcept;
  void (*layer)(const transparency::Layer& layer, MultiLayerBlock& block) noexcept;
  void (*finish)(const MultiLayerBlock& block, const raster::BlockColors& behind,
                 raster::BlockColors& out) noexcept;
};

struct ApproximationKernels {
  MomentKernels mboit4, mboit6;
  WeightedKernels wboit;
  MultiLayerKernels mlab4;
};

[[nodiscard]] const ApproximationKernels& approximation_kernels(Isa isa) noexcept;

}  // namespace rastrum::family
