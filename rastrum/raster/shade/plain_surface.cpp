// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/shade/plain_surface.hpp>

#include <algorithm>

#include <rastrum/raster/rules/srgb.hpp>
#include <rastrum/raster/shade/lit_scalar.hpp>
#include <rastrum/raster/shade/material_scalar.hpp>

namespace rastrum::raster {

PlainLook::PlainLook(const SurfaceLook& look, std::span<const Material> materials,
                     const Camera& camera, int width, int height)
    : look_(look), materials_(materials.begin(), materials.end()) {
  const LitScene lit({{}, materials, {}}, camera, width, height);
  display_ = lit.materials;
  rays_ = lit.rays;
  if (materials_.empty()) materials_ = {plain_material(false), plain_material(true)};
}

std::uint32_t material_of(const InstanceView& instance) {
  return instance.material.value_or(
      instance.geometry.visit([](const auto& g) { return g.material; }));
}

PlainSurface PlainLook::surface(const InstanceView& instance, bool colored) const {
  const InstanceView place{.object_to_world = instance.object_to_world};
  const LitScene lit({{&place, 1}, {}, {}}, {}, 1, 1);
  const bool has_materials = !display_.empty();
  colored |= instance.color.has_value();
  const std::size_t m = has_materials ? material_of(instance) : colored ? 1 : 0;
  PlainSurface s;
  s.material = &materials_[m];
  s.opacity = look_.opacity * instance.opacity * s.material->opacity;
  s.base = s.albedo = s.material->base_color;
  std::copy_n(&lit.draws.front().normal_matrix[0][0], 9, &s.normal_matrix[0][0]);
  if (!look_.is_linear()) {
    const Vec3 base = has_materials ? display_[m] : colored ? Vec3{1, 1, 1} : kDefaultBase;
    s.base = {base.x, base.y, base.z, s.base.w};
  }
  if (instance.color) {
    s.base = s.base * shown(*instance.color, ColorSpace::display);
    s.albedo = s.albedo * converted(*instance.color, ColorSpace::display, ColorSpace::linear);
  }
  return s;
}

Vec4 PlainLook::shown(Vec4 color, ColorSpace space) const {
  return converted(color, space, look_.is_linear() ? ColorSpace::linear : ColorSpace::display);
}

float PlainLook::alpha(const PlainSurface& s, float own) const {
  if (!look_.blends) return 1;
  const bool counts = s.own_alpha || s.material->alpha_mode == AlphaMode::blend;
  const float alpha = counts ? s.opacity * own : s.opacity;
  return clamped_alpha(alpha);
}

Vec4 PlainLook::shade(const PlainSurface& s, const Vec4& base, const Vec3* normal, float px,
                      float py, std::uint64_t key) const {
  const Material& m = *s.material;
  const float a = alpha(s, base.w);
  Vec3 c{base.x, base.y, base.z};
  if (look_.model == Shader::id) {
    c = id_color(id_of_key(key));
  } else if (look_.model) {
    if (normal != nullptr)
      c = look_.lights == nullptr ? scalar_lane::light(*look_.model, rays_, px, py, *normal, c)
                                  : scalar_lane::light_by(*look_.lights, *look_.model, rays_, px,
                                                          py, depth_of_key(key), *normal, c);
  } else if (m.unlit || normal == nullptr) {
    if (!look_.classic) c = scalar_lane::written(c, linear_);
  } else {
    const Vec3 away = rays_.d + rays_.dx * px + rays_.dy * py;
    const Vec3 n = scalar_lane::unit(*normal);
    const float side = dot(n, away) > 0 ? -1.0F : 1.0F;
    if (look_.classic) {
      const ClassicMaterial& k = m.classic;
      const scalar_lane::ClassicSurface lit{
          c, n * side, k.specular, sixteenths(128 * k.shininess), k.emission, {1, 1, 1}};
      c = scalar_lane::classic_light(*look_.lights, rays_, lit, px, py, depth_of_key(key));
      return {c.x * a, c.y * a, c.z * a, a};
    }
    const scalar_lane::LitSurface lit{c, n * side, m.metallic, m.roughness, 1, m.emissive};
    c = look_.lights == nullptr
            ? scalar_lane::light(rays_, lit, px, py)
            : scalar_lane::light_by(*look_.lights, rays_, lit, px, py, depth_of_key(key));
    c = scalar_lane::written(c, linear_);
  }
  return {c.x * a, c.y * a, c.z * a, a};
}

}  // namespace rastrum::raster
