// SPDX-License-Identifier: BSD-3-Clause
// glTF 2.0 metallic-roughness materials (Khronos, "glTF 2.0 Specification", appendix B: GGX with
// Schlick's Fresnel term over a Lambertian base) under fixed lights, so that a picture can be made
// again anywhere:
//
//   light        direction to it (world, normalized here)   radiance (E / π, linear)
//   key          (0.4, 0.6, 1)                               0.65  white
//   fill         (−0.8, 0.1, 0.6)                            0.20  white
//   hemisphere   +y sky 0.30, −y ground 0.12, linear in the y of the direction
//
//   colour = key + fill + occlusion · (diffuse · hemi(n) + F(n·v, roughness) · hemi(r)) + emission
//
// hemi(d) is the hemisphere's radiance, r the mirrored view direction, and F(c, roughness) =
// F0 + (max(1 − roughness, F0) − F0) (1 − c)^5 stands in for the integral over the lobe, so that
// metals are not black. Masking is Hammon's approximation of Smith's height-correlated term (GDC
// 2017). Roughness is at least 0.045. Normals are turned to the side of the triangle that is seen,
// with or without double_sided (the façade culls the back of single-sided ones). The tangent frame
// is that of the texture coordinates: their derivative over a triangle is constant in the world, so
// none is stored or differenced on the screen.
//
// Textures: texel (0, 0) at the top left, centres at half texels, trilinear; the level is log2 of
// the longer axis of a pixel's footprint, from the analytic derivatives of the weights. The result
// is written with the sRGB transfer function; where something is translucent, after blending. Alpha
// is alpha.hpp's business.
//
// Shader::classic reads the same scene as OpenGL's fixed pipeline does, in display values:
//
//   colour = texel · (1 ∧ (base · (ambient lights + emission) + Σ light) + Σ (1 ∧ shadowed light))
//   light  = share · (base · (ambient + diffuse · n·l) + specular · material's specular · (n·h)ᵉ)
//
// a ∧ b is the lesser, share the part that attenuation, cone and shadow leave. A light with shadows
// lights what faces it. Exponents are whole sixteenths, so that products and square roots make
// them. The texture's codes are filtered as they are. Without lights there is a headlight.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/raster/shade/texture.hpp>
#include <rastrum/scene/instance_runs.hpp>

namespace rastrum::raster {

/// A material as shaders read it: its numbers, and its textures, null where it has none.
struct BoundMaterial {
  Vec4 base;
  float metallic = 1, roughness = 1;
  float normal_scale = 1, occlusion_strength = 1;
  Vec3 emission;
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5F;
  float opacity = 1;
  bool unlit = false;
  const MipChain* base_color = nullptr;
  const MipChain* metallic_roughness = nullptr;
  const MipChain* normal = nullptr;
  const MipChain* occlusion = nullptr;
  const MipChain* emissive = nullptr;
  const MipChain* alpha = nullptr;
  ClassicMaterial classic{};
  float sixteenths = 0;  ///< its classic exponent
};

/// A classic exponent in [0, 128] as whole sixteenths.
[[nodiscard]] inline float sixteenths(float exponent) {
  return std::floor(exponent * 16 + 0.5F);
}

struct MaterialDraw {
  const MeshView* mesh = nullptr;
  const InstanceView* copies = nullptr;  ///< as LitDraw's
  AttributeView<Vec4> colors;            ///< this and the next three as in LitDraw
  ColorSpace color_space = ColorSpace::display;
  IndexView face_materials;
  std::uint32_t material = 0;
  float opacity = 1;          ///< of the instance
  float normal_matrix[3][3];  ///< object to world, inverse transpose
  float to_world[3][3];       ///< object to world, directions

  /// Sets the fields that come from `lit` and from `instance`, to which it belongs.
  void set(const LitDraw& lit, const InstanceView& instance);
  /// The same draw with the matrix and colour of `instance`.
  [[nodiscard]] MaterialDraw of(const InstanceView& instance) const;
};

/// A scene's materials as shaders read them, in the host's memory or a device's.
struct MaterialView {
  std::span<const BoundMaterial> materials;
  std::span<const MaterialDraw> draws;
  ViewRays rays;
  const LightSet* lights = nullptr;  ///< as LitView's
  const double* curve = nullptr;     ///< display_curve()
  bool classic = false;              ///< for Shader::classic: colours are display values

  [[nodiscard]] RASTRUM_HD const BoundMaterial& material_of(const MaterialDraw& draw,
                                                            std::uint64_t triangle) const {
    if (draw.face_materials.empty()) return materials[draw.material];
    return materials[draw.face_materials[draw.mesh->place(triangle).face]];
  }
};

/// A scene as the material shader and alpha read it.
struct MaterialScene {
  /// At least one. A scene without materials has two plain ones: without colours and with.
  std::vector<BoundMaterial> materials;
  std::vector<MaterialDraw> draws;
  ViewRays rays;
  const LightSet* lights = nullptr;  ///< as LitScene's
  bool bent = false;                 ///< some material has a normal map
  bool classic = false;              ///< as MaterialView's; then `lights` must be set

  /// `scene` and `textures` must outlive this.
  MaterialScene(const SceneView& scene, const Camera& camera, int width, int height,
                const TextureSet& textures, bool classic = false);

  [[nodiscard]] MaterialView view() const;
};

/// Throws Error{invalid_argument} naming the material or instance whose index into textures or
/// materials is out of range. O(triangles with face_materials).
void check_materials(const InstanceRuns& runs);

/// The uses TextureSet::update wants: all that `materials` read. Without `shading` only those that
/// alpha comes from: of masks and, with `blending`, of AlphaMode::blend. `classic`: also those that
/// Shader::classic reads.
[[nodiscard]] std::vector<std::uint8_t> texture_uses(const SceneView& scene, bool shading,
                                                     bool blending, bool classic = false);

}  // namespace rastrum::raster
