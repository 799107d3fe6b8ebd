// SPDX-License-Identifier: BSD-3-Clause
// The plain shaders: flat, normal, id, lambert, phong, wireframe. They write display values
// unchanged. Their light is fixed, so that other renderers can be compared:
//   base · (0.1 + 0.8 max(n·l, 0)) + 0.3 max(n·h, 0)³²,  l = (0.4, 0.6, 1) / |…| in world space.
// base is the mesh's colours, or (0.8, 0.7, 0.6). In a scene with materials it is the material's
// base colour factor as a display value, times the mesh's colours, if any (only the material shader
// reads textures). n is turned to face the viewer.
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

/// A draw for the lit shaders.
struct LitDraw {
  const MeshView* mesh = nullptr;
  /// The instances of a mesh that is drawn as copies; else null.
  const InstanceView* copies = nullptr;
  AttributeView<Vec4> colors;  ///< the mesh's, or the instance's instead
  ColorSpace color_space = ColorSpace::display;
  IndexView face_materials;  ///< of the mesh; empty: `material`
  std::uint32_t material = 0;
  float normal_matrix[3][3];  ///< object to world, inverse transpose
  bool identity = false;      ///< normal_matrix is a multiple of the identity

  /// With the matrix and colour of `instance`.
  [[nodiscard]] LitDraw of(const InstanceView& instance) const;
  [[nodiscard]] RASTRUM_HD Vec3 to_world(Vec3 n) const {
    const auto& m = normal_matrix;
    return {m[0][0] * n.x + m[0][1] * n.y + m[0][2] * n.z,
            m[1][0] * n.x + m[1][1] * n.y + m[1][2] * n.z,
            m[2][0] * n.x + m[2][1] * n.y + m[2][2] * n.z};
  }
};

/// The direction to the viewer at pixel centre (x, y), not normalized: −(d + x · dx + y · dy).
/// Exact interpolation of positions gives the same, since a position lies on its pixel's ray.
struct ViewRays {
  Vec3 d, dx, dy;
  static ViewRays of(const Camera& camera, int width, int height);
};

/// The scene for the scalar form, in host or device memory (lit_scalar.hpp).
struct LitView {
  std::span<const LitDraw> draws;
  ViewRays rays;
  bool colored = false;
  std::span<const Vec3> materials;
  const LightSet* lights = nullptr;  ///< null: the fixed light, a device's only one

  /// The factor of a face's corner colours or, without those, its colour.
  [[nodiscard]] RASTRUM_HD Vec3 base_color(const LitDraw& draw, std::size_t face) const;
};

struct LitScene {
  std::vector<LitDraw> draws;
  ViewRays rays;
  bool by_place = false;        ///< indexed by place among the frame's draws, not by number
  bool colored = false;         ///< some draw or material has colours
  std::vector<Vec3> materials;  ///< base colours, display values

  const LightSet* lights = nullptr;  ///< the frame's; must outlive this; null: none

  LitScene(const SceneView& scene, const Camera& camera, int width, int height);
  [[nodiscard]] LitView view() const { return {draws, rays, colored, materials, lights}; }
  [[nodiscard]] const LitDraw& of(const FrameGeometry& frame, const Draw& draw) const {
    return draws[by_place ? static_cast<std::size_t>(&draw - frame.draws.data()) : draw.number];
  }
};

/// Sets opaque colours of the covered samples, and any of others; alpha is not set. Its scratch is
/// a KeptTriangles (lit_triangle.hpp).
void shade_lit_block(const LitShading& lit, const FrameGeometry& frame, const VisibleBlock& block,
                     Isa isa, BlockColors& colors) noexcept;

}  // namespace rastrum::raster
