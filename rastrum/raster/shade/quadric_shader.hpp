// The built-in shaders over quadrics: normal and colour are those of the exact point of the surface
// that a sample sees, in float64; the rest is plain_surface.hpp's.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/draws/quadrics.hpp>
#include <rastrum/raster/setup/quadric_surface.hpp>
#include <rastrum/raster/shade/plain_surface.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::raster {

/// Shades draws of quadrics, in the order of `add`, and tests those whose material is a mask.
/// Textures are not read: a quadric has no texture coordinates.
class QuadricShader final : public BlockShader, public FragmentTest {
 public:
  QuadricShader(const SurfaceLook& look, std::span<const Material> materials, const Camera& camera,
                int width, int height)
      : look_(look, materials, camera, width, height) {}
  /// `instance`: of the stage, whose own look is heeded. `stage` must outlive the frame.
  void add(const QuadricStage& stage, const InstanceView& instance);
  /// As MaterialShading::linear.
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
    ArrayView<Vec4> colors;  ///< empty: there are none
    PlainSurface plain;
  };
  struct Kept;
  struct KeptQuadrics;

  void fetch(const FrameGeometry& frame, std::uint64_t low, Kept& out) const;
  [[nodiscard]] Vec4 color(const Kept& kept, const FrameGeometry& frame, std::uint64_t key,
                           float px, float py, QuadricSurface::Place at) const;

  PlainLook look_;
  std::vector<Surface> surfaces_;
};

/// The geometry's colours, unless the instance's stands for them.
[[nodiscard]] ArrayView<Vec4> colors_of(const QuadricGeometry& geometry,
                                        const InstanceView& instance);

/// The colour that the geometry, or the instance instead, gives to a place along a primitive's
/// axis; white where neither has one.
[[nodiscard]] Vec4 color_at(const QuadricGeometry& geometry, const InstanceView& instance,
                            std::uint64_t primitive, double along);

}  // namespace rastrum::raster
