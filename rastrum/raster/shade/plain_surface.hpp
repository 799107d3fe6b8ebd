// SPDX-License-Identifier: BSD-3-Clause
// The look of surfaces without textures: points, lines, spheres and the like. They have a colour
// and a normal, from any source, and the triangles' light (lit_light.inl, material_light.inl).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/raster/draws/shading.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::raster {

struct SurfaceLook {
  std::optional<Shader> model;       ///< none: materials
  bool classic = false;              ///< by Shader::classic; without a model
  bool blends = false;               ///< alpha counts
  float opacity = 1;                 ///< the frame's
  const LightSet* lights = nullptr;  ///< as in LitScene

  /// Whether colours are linear light, and not display values.
  [[nodiscard]] bool is_linear() const { return !model && !classic; }
};

/// An instance's part of its surfaces' look.
struct PlainSurface {
  Vec4 base;    ///< multiplies or replaces colours; its alpha is the own alpha
  Vec4 albedo;  ///< the same in linear light, for any shader
  const Material* material = nullptr;
  float opacity = 1;               ///< product of the instance's, the frame's and the material's
  bool own_alpha = false;          ///< counts in any mode of the material
  float normal_matrix[3][3] = {};  ///< object to world, inverse transpose
};

/// The material of the instance or, without one, of its geometry.
[[nodiscard]] std::uint32_t material_of(const InstanceView& instance);

/// Shades plain surfaces. Scenes without materials have plain ones.
class PlainLook {
 public:
  PlainLook(const SurfaceLook& look, std::span<const Material> materials, const Camera& camera,
            int width, int height);

  /// `colored`: the geometry has colours that no colour of the instance replaces.
  [[nodiscard]] PlainSurface surface(const InstanceView& instance, bool colored) const;
  /// A colour in the look's space: display values or linear light.
  [[nodiscard]] Vec4 shown(Vec4 color, ColorSpace space) const;
  void leave_linear() { linear_ = true; }
  [[nodiscard]] const SurfaceLook& look() const { return look_; }
  [[nodiscard]] const ViewRays& rays() const { return rays_; }

  /// The alpha that is drawn; `own`: the surface's own, with its colours.
  [[nodiscard]] float alpha(const PlainSurface& surface, float own) const;
  /// The premultiplied colour at (px, py), px. `base`: the surface's, with its colours. `normal`:
  /// world space, any length; null: not lit. `key`: the sample's.
  [[nodiscard]] Vec4 shade(const PlainSurface& surface, const Vec4& base, const Vec3* normal,
                           float px, float py, std::uint64_t key) const;

 private:
  SurfaceLook look_;
  bool linear_ = false;
  std::vector<Material> materials_;  ///< without any: two plain ones, without colours and with
  std::vector<Vec3> display_;        ///< their base colours; empty: none
  ViewRays rays_;
};

}  // namespace rastrum::raster
