// SPDX-License-Identifier: BSD-3-Clause
// The lit shaders in lanes, a table an instruction set (lit_simd.cpp). Operations and their order
// are those of the scalar forms (lit_scalar.hpp, wire.cpp), so the bits are too. Their colours are
// opaque, and alpha is not set.
#pragma once

#include <cstdint>

#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/raster/surface/seen_bin.hpp>

namespace rastrum::raster {

struct FragmentRuns;

/// The surface of a block as lighting needs it, by sample.
struct alignas(64) LitBlock {
  float n[3][64];             ///< the normal, world space, of any length
  float base[3][64];          ///< the base colour
  std::uint64_t normals = 0;  ///< samples whose `n` is set
};

/// Normals of a block as images show them: of unit length, turned to the viewer, 0 where there is
/// none. Element 8 · row + column.
struct SeenNormals {
  Vec3 world[64], camera[64];
};

/// All but `shade` are for shaders whose colours light() makes (is_light()).
struct LitKernels {
  /// Colours of the covered samples.
  void (*shade)(const LitShading& lit, const FrameGeometry& frame, const VisibleBlock& block,
                BlockColors& colors) noexcept;
  /// The same to 8 bits (store_shaded).
  void (*store)(const LitShading& lit, const FrameGeometry& frame, const VisibleBlock& block,
                Rgba8 empty, BlockPixels to) noexcept;
  /// As `shade`, with the base colours that `surface` holds. Its normals are not read.
  void (*shade_base)(const LitShading& lit, const FrameGeometry& frame, const VisibleBlock& block,
                     LitBlock& surface, BlockColors& colors) noexcept;
  /// Lights a surface that others have found.
  void (*light)(Shader model, const ViewRays& rays, const LightSet* lights,
                const VisibleBlock& block, const LitBlock& surface, BlockColors& colors) noexcept;
  /// The normals of the covered samples, which are of meshes: those of `surface` where it has all,
  /// else they are interpolated into it. `cut`: triangles may not cover their pixels' centres.
  /// `to_camera`: null where `out.camera` is not asked for.
  void (*seen_normals)(const LitScene& scene, const FrameGeometry& frame, const VisibleBlock& block,
                       LitBlock& surface, bool cut, const float (*to_camera)[3],
                       SeenNormals& out) noexcept;
  /// Colours of fragments that lie side by side by triangle, times `alpha`, which is above 0
  /// (shade_runs of shader.hpp).
  void (*shade_runs)(const LitShading& lit, const FrameGeometry& frame, const FragmentRuns& runs,
                     float alpha, Vec4* colors) noexcept;
  /// Sets up the triangles that rows of blocks see, from `row` to `seen.end_row`, which it sets.
  void (*see_bin)(const LitShading& lit, const FrameGeometry& frame, const BinSurface& bin, int row,
                  SeenBin& seen) noexcept;
};

/// Null: that instruction set has none.
[[nodiscard]] const LitKernels* lit_kernels(Isa isa) noexcept;

}  // namespace rastrum::raster
