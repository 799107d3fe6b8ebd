// SPDX-License-Identifier: BSD-3-Clause
// The built-in shaders over quadrics. Normal and colour are those of the exact surface point that a
// sample sees, in float64; the light is the triangles' (lit_light.inl, material_light.inl).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/draws/shading.hpp>
#include <rastrum/raster/rules/quadric_surface.hpp>
#include <rastrum/raster/rules/quadrics.hpp>
#include <rastrum/raster/shade/plain_surface.hpp>
#include <rastrum/raster/shade/surface_scalars.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::raster {

struct QuadricBlock;
struct QuadricLanes;

/// Shades draws of quadrics, in the order of `add`, and tests those whose material is a mask. A
/// scene without materials acts as one that blends by its colours. Textures are not read: a quadric
/// has no texture coordinates.
class QuadricShader final : public BlockShader, public FragmentTest {
 public:
  QuadricShader(const SurfaceLook& look, std::span<const Material> materials, const Camera& camera,
                int width, int height);
  /// `instance`: the stage's; its look and scalars apply. `stage` must outlive the frame.
  void add(const QuadricStage& stage, const InstanceView& instance, const SurfaceScalars& scalars);
  void leave_linear() { look_.leave_linear(); }

  bool shade(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
             BlockColors& colors) const noexcept override;
  [[nodiscard]] std::size_t scratch_bytes() const noexcept override;
  [[nodiscard]] std::uint64_t test(const FrameGeometry& frame, const Piece& piece,
                                   const Block& block,
                                   const ShadingPoints* points) const noexcept override;

 private:
  struct Surface {
    const QuadricStage* stage;
    PlainSurface plain;
    ArrayView<Vec4> colors;  ///< empty: none
    SurfaceScalars scalars;

    [[nodiscard]] bool shows_scalars() const { return scalars.colors() != nullptr; }
    /// Whether alpha may change from point to point.
    [[nodiscard]] bool has_own_alpha() const {
      if (shows_scalars()) return true;
      return plain.material->alpha_mode == AlphaMode::blend &&
             !(colors.empty() && plain.base.w == 1);
    }
  };
  struct Kept;
  struct KeptQuadrics;

  struct Seen {
    Vec4 base;
    Vec3 normal;  ///< world space, any length
  };

  /// `all`: has the eye to use; null: a new one is made.
  void fetch(const FrameGeometry& frame, std::uint64_t low, KeptQuadrics* all, Kept& out) const;
  [[nodiscard]] Seen seen(const Kept& kept, std::uint64_t key, QuadricSurface::Place at) const;
  void fill(const QuadricLanes& lanes, const Kept& kept, const VisibleBlock& block,
            std::uint64_t mask, QuadricBlock& out) const;
  /// shade() for the models that lanes have.
  bool shade_lit(const QuadricLanes& lanes, const FrameGeometry& frame, const VisibleBlock& block,
                 Isa isa, BlockColors& colors) const;

  PlainLook look_;
  std::vector<Surface> surfaces_;
};

/// The geometry's colours, unless the instance's replaces them.
[[nodiscard]] ArrayView<Vec4> colors_of(const QuadricGeometry& geometry,
                                        const InstanceView& instance);

/// Base colour times colours at a place on a primitive's axis, in linear light.
[[nodiscard]] Vec4 albedo_at(const QuadricGeometry& geometry, const InstanceView& instance,
                             std::span<const Material> materials, std::uint64_t primitive,
                             double along);

}  // namespace rastrum::raster
