// SPDX-License-Identifier: BSD-3-Clause
// The built-in shaders over meshes coloured by scalars. Their colours replace base colours,
// textures and vertex colours. Light, normals and the rest of a material are unchanged.
#pragma once

#include <cstdint>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/raster/shade/lit_kernels.hpp>
#include <rastrum/raster/shade/material.hpp>
#include <rastrum/raster/shade/plain_surface.hpp>
#include <rastrum/raster/shade/scalar_lanes.hpp>
#include <rastrum/raster/shade/surface_scalars.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::raster {

/// Shades the draws of such instances, in order. Tests those whose material is a mask by its
/// texture, as without scalars. Alpha is opacity times the colour's, in any mode of the material.
class ScalarMeshShader final : public BlockShader, public FragmentTest {
 public:
  /// `scene`: only these instances, `scalars` theirs; both must outlive this. `textures`: up to
  /// date with what materials and masks read.
  ScalarMeshShader(const SurfaceLook& look, const SceneView& scene,
                   std::vector<SurfaceScalars> scalars, const Camera& camera, int width, int height,
                   const TextureSet& textures);
  void leave_linear() { linear_ = true; }

  bool shade(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
             BlockColors& colors) const noexcept override;
  [[nodiscard]] std::size_t scratch_bytes() const noexcept override;
  [[nodiscard]] std::uint64_t test(const FrameGeometry& frame, const Piece& piece,
                                   const Block& block,
                                   const ShadingPoints* points) const noexcept override;

 private:
  void color_each(const FrameGeometry& frame, const VisibleBlock& block, LitBlock& surface,
                  float (&alpha)[64]) const;
  /// The same in lanes, if there are `ramps_`; not for `wireframe` and `id`.
  void color_all(const FrameGeometry& frame, const VisibleBlock& block, Isa isa, LitBlock& surface,
                 float (&alpha)[64]) const;
  /// The part of alpha that is constant on a face.
  [[nodiscard]] float opacity_of(const Fragment& f, std::size_t number) const;
  /// Colours of the covered samples with the base colours of `surface`; alpha 1.
  void light(const FrameGeometry& frame, const VisibleBlock& block, Isa isa, LitBlock& surface,
             BlockColors& colors) const;

  SurfaceLook look_;
  bool linear_ = false;
  bool isolines_ = false;                ///< some scalars have isolines
  std::vector<SurfaceScalars> scalars_;  ///< by Draw::number
  std::vector<ScalarRamp> ramps_;        ///< all scalars', or none
  std::vector<std::uint32_t> ramp_of_;   ///< by Draw::number, into `ramps_`
  LitScene lit_;
  MaterialScene materials_;
};

}  // namespace rastrum::raster
