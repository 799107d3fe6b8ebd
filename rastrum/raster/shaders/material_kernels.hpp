// The lane-parallel part of materials (material_simd.cpp), once for each instruction set. It is
// plain C++ that compilers vectorize; operations and their order are the same everywhere, so the
// bits are too.
#pragma once

#include <cstdint>

#include <rastrum/raster/shaders/material.hpp>

namespace rastrum::raster {

struct MaterialKernels {
  /// Colours of the covered samples, all opaque.
  void (*shade)(const MaterialScene& scene, const FrameGeometry& frame, const VisibleBlock& block,
                BlockColors& colors) noexcept;
  /// The subset of `mask` (bit 8 · row + column of the block at (x0, y0)) where triangle `id` is
  /// not cut out.
  std::uint64_t (*alpha_test)(const MaterialScene& scene, const FrameGeometry& frame,
                              std::uint64_t id, std::uint64_t mask, int x0, int y0) noexcept;
};

[[nodiscard]] const MaterialKernels& material_kernels(Isa isa) noexcept;

}  // namespace rastrum::raster
