// SPDX-License-Identifier: BSD-3-Clause
// The plain shaders: flat, normal, id, lambert, phong, wireframe. They write display values
// as they are. The lighting is fixed, so that other renderers can be compared with it:
//   base · (0.1 + 0.8 max(n·l, 0)) + 0.3 max(n·h, 0)³²,  l = (0.4, 0.6, 1) / |…| in world space,
// base = the mesh's colours, (0.8, 0.7, 0.6) where it has none. In a scene with materials it is the
// material's base colour factor as a display value, times the mesh's colours where there are some
// (textures are the material shader's). n is turned to face the viewer.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/config.hpp>
#include <rastrum/program.hpp>
#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/draws/shading.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

struct LightSet;

/// A draw as the lit shaders read it.
struct LitDraw {
  const MeshView* mesh = nullptr;
  /// Where the mesh is drawn as copies, their instances; else null.
  const InstanceView* copies = nullptr;
  AttributeView<Vec4> colors;  ///< the mesh's, or the instance's in their place
  ColorSpace color_space = ColorSpace::display;
  IndexView face_materials;  ///< the same; empty: `material`
  std::uint32_t material = 0;
  float normal_matrix[3][3];  ///< object to world, inverse transpose
  bool identity = false;      ///< normal_matrix is a multiple of the identity

  /// The same draw with the matrix and colour of `instance`.
  [[nodiscard]] LitDraw of(const InstanceView& instance) const;
  [[nodiscard]] RASTRUM_HD Vec3 to_world(Vec3 n) const {
    const auto& m = normal_matrix;
    return {m[0][0] * n.x + m[0][1] * n.y + m[0][2] * n.z,
            m[1][0] * n.x + m[1][1] * n.y + m[1][2] * n.z,
            m[2][0] * n.x + m[2][1] * n.y + m[2][2] * n.z};
  }
};

/// The direction to the viewer at pixel centre (x, y), not normalized: −(d + x · dx + y · dy).
/// Exact interpolation of positions gives the same direction, because a position lies on its
/// pixel's ray.
struct ViewRays {
  Vec3 d, dx, dy;
  static ViewRays of(const Camera& camera, int width, int height);
};

/// The scene as the scalar form reads it, in the host's memory or a device's (lit_scalar.hpp).
struct LitView {
  std::span<const LitDraw> draws;
  ViewRays rays;
  bool colored = false;
  std::span<const Vec3> materials;
  const LightSet* lights = nullptr;  ///< null: the fixed light; a device has no others

  /// The colour that those at the corners of a face's triangles are multiplied by, or that stands
  /// for them where there are none.
  [[nodiscard]] RASTRUM_HD Vec3 base_color(const LitDraw& draw, std::size_t face) const;
};

struct LitScene {
  std::vector<LitDraw> draws;
  ViewRays rays;
  bool by_place = false;        ///< draws are those of the frame, by their place, and not by number
  bool colored = false;         ///< some draw has colours of its own, or a material's
  std::vector<Vec3> materials;  ///< the base colour of each, a display value

  const LightSet* lights = nullptr;  ///< the frame's, which must outlive this; null: none

  LitScene(const SceneView& scene, const Camera& camera, int width, int height);
  [[nodiscard]] LitView view() const { return {draws, rays, colored, materials, lights}; }
  /// The entry of a draw of the frame.
  [[nodiscard]] const LitDraw& of(const FrameGeometry& frame, const Draw& draw) const {
    return draws[by_place ? static_cast<std::size_t>(&draw - frame.draws.data()) : draw.number];
  }
};

/// Sets the colours of the covered samples (others may be set to anything), which are opaque; alpha
/// is not set. Its scratch is a KeptTriangles (lit_triangle.hpp).
void shade_lit_block(const LitShading& lit, const FrameGeometry& frame, const VisibleBlock& block,
                     Isa isa, BlockColors& colors) noexcept;

}  // namespace rastrum::raster
