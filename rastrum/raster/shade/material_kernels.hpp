// SPDX-License-Identifier: BSD-3-Clause
// Materials over blocks: in lanes, once for each instruction set (material_simd.cpp), and fragment
// by fragment (material_scalar.cpp), with the same operations, order and bits.
#pragma once

#include <cstdint>

#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/shade/material.hpp>
#include <rastrum/raster/surface/seen_bin.hpp>

namespace rastrum::raster {

/// Samples with alpha > 0, and those with alpha = 1.
struct AlphaMasks {
  std::uint64_t visible = 0, opaque = 0;
};

struct MaterialKernels {
  /// Colours of the covered samples, all opaque, as display values or linear light. `own_base`
  /// replaces base colours: 64 red ones, then green and blue, 64-byte aligned; null: it does not.
  void (*shade)(const MaterialView& scene, const FrameGeometry& frame, const VisibleBlock& block,
                bool linear, const float* own_base, BlockColors& colors) noexcept;
  /// The subset of `mask` (bit 8 · row + column of the block at (x0, y0)) where triangle `id` has
  /// no hole. `points` as in VisibleBlock.
  std::uint64_t (*alpha_test)(const MaterialView& scene, const FrameGeometry& frame,
                              std::uint64_t id, std::uint64_t mask, int x0, int y0,
                              const ShadingPoints* points) noexcept;
  /// Alpha of the covered samples (alpha.hpp), 0 elsewhere: 64 floats, 64-byte aligned.
  AlphaMasks (*alpha)(const MaterialView& scene, const FrameGeometry& frame,
                      const VisibleBlock& block, float opacity, float* out) noexcept;
  /// Multiplies all 64 colours with their alpha. Where `alpha` is 0 they become 0, even from NaN.
  void (*premultiply)(const float* alpha, BlockColors& colors) noexcept;
  /// As LitKernels::see_bin, for a scene without normal maps; null: blocks are shaded one by one.
  void (*see_bin)(const MaterialView& scene, const FrameGeometry& frame, const BinSurface& bin,
                  int row, SeenBin& seen) noexcept;
};

/// Isa::scalar's: material_scalar.hpp, fragment by fragment.
[[nodiscard]] const MaterialKernels& scalar_material_kernels() noexcept;

[[nodiscard]] const MaterialKernels& material_kernels(Isa isa) noexcept;

}  // namespace rastrum::raster
