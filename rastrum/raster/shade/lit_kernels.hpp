// SPDX-License-Identifier: BSD-3-Clause
// The lit shaders in lanes, one table for each instruction set (lit_simd.cpp). Operations, order
// and bits are those of the scalar forms (lit_scalar.hpp, wire.cpp). Colours are opaque, and alpha
// is not set.
#pragma once

#include <cstdint>

#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/raster/surface/seen_bin.hpp>

namespace rastrum::raster {

struct FragmentRuns;

struct alignas(64) LitBlock {
  float n[3][64];  ///< normal, world space, any length
  float base[3][64];
  std::uint64_t normals = 0;  ///< samples whose `n` is set
};

/// A block's normals as images show them: unit length, facing the viewer, 0 where there is none.
/// Element 8 · row + column.
struct SeenNormals {
  Vec3 world[64], camera[64];
};

/// All but `shade` are for shaders with is_light().
struct LitKernels {
  void (*shade)(const LitShading& lit, const FrameGeometry& frame, const VisibleBlock& block,
                BlockColors& colors) noexcept;
  /// Stores 8-bit colours (store_shaded).
  void (*store)(const LitShading& lit, const FrameGeometry& frame, const VisibleBlock& block,
                Rgba8 empty, BlockPixels to) noexcept;
  /// As `shade`, with the base colours of `surface`, not its normals.
  void (*shade_base)(const LitShading& lit, const FrameGeometry& frame, const VisibleBlock& block,
                     LitBlock& surface, BlockColors& colors) noexcept;
  /// Lights a surface found elsewhere.
  void (*light)(Shader model, const ViewRays& rays, const LightSet* lights,
                const VisibleBlock& block, const LitBlock& surface, BlockColors& colors) noexcept;
  /// Normals of the covered samples, all of meshes: from `surface` if it has all, else interpolated
  /// into it. `cut`: triangles may miss their pixels' centres. `to_camera`: null if `out.camera` is
  /// not wanted.
  void (*seen_normals)(const LitScene& scene, const FrameGeometry& frame, const VisibleBlock& block,
                       LitBlock& surface, bool cut, const float (*to_camera)[3],
                       SeenNormals& out) noexcept;
  /// Colours of fragments sorted by triangle, times `alpha` > 0 (shade_runs of shader.hpp).
  void (*shade_runs)(const LitShading& lit, const FrameGeometry& frame, const FragmentRuns& runs,
                     float alpha, Vec4* colors) noexcept;
  /// Sets up the triangles of rows of blocks from `row` to `seen.end_row`, which it sets.
  void (*see_bin)(const LitShading& lit, const FrameGeometry& frame, const BinSurface& bin, int row,
                  SeenBin& seen) noexcept;
};

/// Null: the instruction set has none.
[[nodiscard]] const LitKernels* lit_kernels(Isa isa) noexcept;

}  // namespace rastrum::raster
