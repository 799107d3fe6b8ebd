// SPDX-License-Identifier: BSD-3-Clause
// The built-in shaders and materials' masks for points and lines of a scene. A point has one
// colour; a line's is linear and perspective-correct, as all its attributes. Points with normals
// are lit, all else shows its colour.
#pragma once

#include <span>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/program.hpp>
#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/shade/plain_surface.hpp>
#include <rastrum/raster/shade/surface_scalars.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::raster {

/// Shades draws of points and lines, in the order of `add`.
class PointLineShader final : public BlockShader, public FragmentTest {
 public:
  PointLineShader(const SurfaceLook& look, std::span<const Material> materials,
                  const Camera& camera, int width, int height)
      : look_(look, materials, camera, width, height) {}

  /// `instance`: of points or lines, whose arrays must outlive the frame; with its scalars. Returns
  /// their colours, or none where scalars or the instance's colour replace them.
  ArrayView<Vec4> add(const InstanceView& instance, const SurfaceScalars& scalars);
  void leave_linear() { look_.leave_linear(); }

  bool shade(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
             BlockColors& colors) const noexcept override;
  void prefetch(const FrameGeometry& frame, std::uint64_t id) const noexcept override;
  /// AlphaMode::mask: drops fragments below the material's cutoff.
  [[nodiscard]] std::uint64_t test(const FrameGeometry& frame, const Piece& piece,
                                   const Block& block,
                                   const ShadingPoints* points) const noexcept override;
  /// Linear light, straight alpha.
  [[nodiscard]] Vec4 albedo(const FrameGeometry& frame, const Fragment& f) const;

 private:
  struct Part {
    ArrayView<Vec4> colors;  ///< one a position; empty: none
    ColorSpace color_space = ColorSpace::display;
    ArrayView<Vec3> normals;  ///< the same
    SurfaceScalars scalars;
    PlainSurface surface;
  };
  [[nodiscard]] const Part& part_of(const Draw& draw) const { return parts_[draw.number]; }
  enum class Way { shown, albedo };
  /// A position's colour times the surface's base, in the look's space or linear light.
  [[nodiscard]] Vec4 color(const Part& part, Way way, std::uint32_t vertex) const;
  /// For a fragment of a line; `f` has the corners' shares.
  [[nodiscard]] Vec4 along(const Part& part, Way way, const Fragment& f) const;

  PlainLook look_;
  std::vector<Part> parts_;
};

}  // namespace rastrum::raster
