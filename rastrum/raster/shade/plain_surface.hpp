// SPDX-License-Identifier: BSD-3-Clause
// How surfaces without textures look: points, lines, spheres and their like. They have a colour and
// a normal, wherever these come from, and the light of the triangles (lit_light.inl,
// material_light.inl).
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

/// How the surfaces of a frame look.
struct SurfaceLook {
  std::optional<Shader> model;       ///< none: as materials
  bool blends = false;               ///< alpha counts
  float opacity = 1;                 ///< the frame's
  const LightSet* lights = nullptr;  ///< as LitScene's
};

/// The part of an instance in the look of its surfaces.
struct PlainSurface {
  Vec4 base;    ///< colours are multiplied by it, or it stands for them; its alpha is the own one
  Vec4 albedo;  ///< the same in linear light, whatever the shader
  const Material* material = nullptr;
  float opacity = 1;               ///< the instance's, the frame's and the material's
  bool own_alpha = false;          ///< counts whatever the mode of the material
  float normal_matrix[3][3] = {};  ///< object to world, inverse transpose
};

/// The material of the instance or, where it has none, of its geometry.
[[nodiscard]] std::uint32_t material_of(const InstanceView& instance);

/// Shades plain surfaces. Scenes without materials have plain ones.
class PlainLook {
 public:
  PlainLook(const SurfaceLook& look, std::span<const Material> materials, const Camera& camera,
            int width, int height);

  /// `colored`: the geometry has colours, and no colour of the instance stands for them.
  [[nodiscard]] PlainSurface surface(const InstanceView& instance, bool colored) const;
  /// A colour as the look computes with it: display values, or light.
  [[nodiscard]] Vec4 shown(Vec4 color, ColorSpace space) const;
  /// As MaterialShading::linear.
  void leave_linear() { linear_ = true; }
  [[nodiscard]] const SurfaceLook& look() const { return look_; }
  [[nodiscard]] const ViewRays& rays() const { return rays_; }

  /// The alpha of a surface as it is drawn; `own`: its own alpha, with its colours.
  [[nodiscard]] float alpha(const PlainSurface& surface, float own) const;
  /// The colour at (px, py), px, premultiplied. `base`: the surface's own, with its colours;
  /// `normal`: in the world, of any length; null: it is not lit. `key`: of the sample.
  [[nodiscard]] Vec4 shade(const PlainSurface& surface, const Vec4& base, const Vec3* normal,
                           float px, float py, std::uint64_t key) const;

 private:
  SurfaceLook look_;
  bool linear_ = false;
  std::vector<Material> materials_;  ///< without any: two plain ones, without colours and with
  std::vector<Vec3> display_;        ///< their base colours; empty: there are none
  ViewRays rays_;
};

}  // namespace rastrum::raster
