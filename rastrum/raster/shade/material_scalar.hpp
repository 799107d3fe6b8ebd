// SPDX-License-Identifier: BSD-3-Clause
// The material shader and alpha at one fragment, for the scalar instruction set and for devices.
// The lights are material_light.inl, shared with material_simd.cpp, which does the rest with the
// same operations, order and bits.
#pragma once

#include <cmath>
#include <cstdint>

#include <rastrum/raster/rules/srgb.hpp>
#include <rastrum/raster/shade/lights_scalar.hpp>
#include <rastrum/raster/shade/material_constants.hpp>
#include <rastrum/raster/shade/material_triangle.hpp>
#include <rastrum/raster/shade/texture_lookup.hpp>

namespace rastrum::raster {

/// Where a triangle is shaded: in pixel (x, y), `from_centre` px from its centre.
struct MaterialPoint {
  float x, y;  ///< px
  CornerShares shares;

  RASTRUM_HD MaterialPoint(const WeightPlanes& w, int px, int py, Vec2 from_centre)
      : x(static_cast<float>(px) + 0.5F + from_centre.x),
        y(static_cast<float>(py) + 0.5F + from_centre.y),
        shares(CornerShares::at(w, px + 0.5 - w.x0 + static_cast<double>(from_centre.x),
                                py + 0.5 - w.y0 + static_cast<double>(from_centre.y))) {}
  [[nodiscard]] RASTRUM_HD float interpolate(float a0, float a1, float a2) const {
    return a0 + shares.offset(a1 - a0, a2 - a0);
  }
};

namespace scalar_lane {
#define RASTRUM_LANES RASTRUM_HD inline
#include <rastrum/raster/shade/classic_light.inl>
#include <rastrum/raster/shade/material_light.inl>
#undef RASTRUM_LANES
}  // namespace scalar_lane

namespace material_detail {

struct Sampler {
  Coordinate u{}, v{};

  RASTRUM_HD Sampler(const MaterialTriangle& t, const MaterialPoint& at) {
    const auto& texcoords = t.draw.mesh->texcoords;
    if (texcoords.values.empty()) return;
    const Vec2 a = t.corner(texcoords, 0);
    const Vec2 d1 = t.corner(texcoords, 1) - a;
    const Vec2 d2 = t.corner(texcoords, 2) - a;
    u = CoordinatePlane(t.planes, a.x, d1.x, d2.x).at(at.shares);
    v = CoordinatePlane(t.planes, a.y, d1.y, d2.y).at(at.shares);
  }
  template <class Decode>
  [[nodiscard]] RASTRUM_HD auto look_up(const MipChain& chain) const {
    const float lod =
        level_of_detail(static_cast<float>(chain.level[0].width),
                        static_cast<float>(chain.level[0].height), u.dx, v.dx, u.dy, v.dy);
    return Lookup<Decode>(chain)(fold(chain.wrap_u, u.value), fold(chain.wrap_v, v.value), lod);
  }
};

/// The base colour without its texture.
RASTRUM_HD inline Vec3 plain_color(const MaterialTriangle& t, const BoundMaterial& m,
                                   const MaterialPoint& at) {
  if (t.draw.colors.values.empty()) return {m.base.x, m.base.y, m.base.z};
  Vec4 c[3];
  t.colors(c);
  for (Vec4& i : c) i = i * m.base;
  return {at.interpolate(c[0].x, c[1].x, c[2].x), at.interpolate(c[0].y, c[1].y, c[2].y),
          at.interpolate(c[0].z, c[1].z, c[2].z)};
}

/// The base colour in linear light, not lit.
RASTRUM_HD inline Vec3 base_color(const MaterialTriangle& t, const BoundMaterial& m,
                                  const MaterialPoint& at, const Sampler& textures) {
  Vec3 base = plain_color(t, m, at);
  if (m.base_color != nullptr) {
    const Texel c = textures.look_up<AllChannels>(*m.base_color);
    base = base * Vec3{c.r, c.g, c.b};
  }
  return base;
}

RASTRUM_HD inline Vec3 normal(const MaterialView& scene, const MaterialTriangle& t,
                              const BoundMaterial& m, const MaterialPoint& at,
                              const Sampler& textures) {
  const Vec3 face = t.face_normal();
  const float side = is_seen_from_behind(scene.rays, face, at.x, at.y) ? -1.0F : 1.0F;
  Vec3 n = face * side;
  if (!t.draw.mesh->normals.values.empty()) {
    Vec3 c[3];
    t.normals(c);
    n = turned({at.interpolate(c[0].x, c[1].x, c[2].x), at.interpolate(c[0].y, c[1].y, c[2].y),
                at.interpolate(c[0].z, c[1].z, c[2].z)},
               face, side);
  }
  if (m.normal == nullptr) return n;
  const Texel map = textures.look_up<AllChannels>(*m.normal);
  return TangentFrame(t).bend(n, map.r, map.g, map.b, m.normal_scale * side);
}

/// A fragment's own alpha, for masks and blending.
RASTRUM_HD inline float own_alpha(const MaterialTriangle& t, const BoundMaterial& m,
                                  const MaterialPoint& at) {
  const auto& colors = t.draw.colors;
  float alpha = m.base.w;
  if (!colors.values.empty())
    alpha = at.interpolate(t.corner(colors, 0).w * m.base.w, t.corner(colors, 1).w * m.base.w,
                           t.corner(colors, 2).w * m.base.w);
  if (m.base_color == nullptr && m.alpha == nullptr) return alpha;
  const Sampler textures(t, at);
  if (m.base_color != nullptr) alpha *= textures.look_up<AlphaChannel>(*m.base_color);
  if (m.alpha != nullptr) alpha *= textures.look_up<RedChannel>(*m.alpha);
  return alpha;
}

}  // namespace material_detail

/// The opaque colour of triangle `t` at a point, a display value or linear light. `depth` there is
/// for the scene's lights. `own_base` replaces the base colour; null: it does not.
[[nodiscard]] RASTRUM_HD inline Vec3 shade_material(const MaterialView& scene,
                                                    const MaterialTriangle& t,
                                                    const MaterialPoint& at, bool linear,
                                                    float depth = 0,
                                                    const Vec3* own_base = nullptr) {
  using namespace material_detail;
  const BoundMaterial& m = scene.material_of(t.draw, t.index);
  const Sampler textures(t, at);
  if (scene.classic) {
    scalar_lane::ClassicSurface s{own_base != nullptr ? *own_base : plain_color(t, m, at),
                                  {},
                                  m.classic.specular,
                                  m.sixteenths,
                                  m.classic.emission,
                                  {1, 1, 1}};
    if (own_base == nullptr && m.base_color != nullptr) {
      const Texel c = textures.look_up<AllChannels>(*m.base_color);
      s.texel = {c.r, c.g, c.b};
    }
    if (m.unlit) return s.base * s.texel;
    s.normal = normal(scene, t, m, at, textures);
    return scalar_lane::classic_light(*scene.lights, scene.rays, s, at.x, at.y, depth);
  }
  scalar_lane::LitSurface s{own_base != nullptr ? *own_base : base_color(t, m, at, textures),
                            {},
                            m.metallic,
                            m.roughness,
                            1,
                            m.emission};
  if (m.unlit) return scalar_lane::written(s.base, linear);
  if (m.metallic_roughness != nullptr) {
    const Texel c = textures.look_up<AllChannels>(*m.metallic_roughness);
    s.roughness *= c.g;
    s.metallic *= c.b;
  }
  if (m.occlusion != nullptr)
    s.occlusion = 1 + m.occlusion_strength * (textures.look_up<AllChannels>(*m.occlusion).r - 1);
  if (m.emissive != nullptr) {
    const Texel c = textures.look_up<AllChannels>(*m.emissive);
    s.emission = s.emission * Vec3{c.r, c.g, c.b};
  }
  s.normal = normal(scene, t, m, at, textures);
  if (scene.lights != nullptr)
    return scalar_lane::written(
        scalar_lane::light_by(*scene.lights, scene.rays, s, at.x, at.y, depth), linear);
  return scalar_lane::written(scalar_lane::light(scene.rays, s, at.x, at.y), linear);
}

/// A fragment's base colour and own alpha: linear light, straight.
template <class Geometry>
[[nodiscard]] Vec4 material_albedo(const MaterialView& scene, const Geometry& frame,
                                   const Fragment& f) {
  const Draw& draw = frame.draws[f.draw];
  const MaterialTriangle t(scene, frame, draw, f.id);
  const BoundMaterial& m = scene.material_of(t.draw, t.index);
  MaterialPoint at(t.planes, f.x, f.y, f.from_centre);
  // The fragment's weights are clamped to [0, 1], for a triangle that misses the place.
  at.shares.weight1 = static_cast<float>(f.weights.b[1]);
  at.shares.weight2 = static_cast<float>(f.weights.b[2]);
  const Vec3 base = material_detail::base_color(t, m, at, material_detail::Sampler(t, at));
  return {base.x, base.y, base.z, material_detail::own_alpha(t, m, at)};
}

template <class Geometry>
[[nodiscard]] RASTRUM_HD bool passes_mask(const MaterialView& scene, const Geometry& frame,
                                          std::uint64_t id, int x, int y, Vec2 from_centre) {
  const Draw& draw = frame.draw_of(id);
  const MaterialDraw& of = scene.draws[draw.number];
  const BoundMaterial& m = scene.material_of(of, draw.of_copy(id - draw.first_id).primitive);
  if (m.alpha_mode != AlphaMode::mask) return true;
  const MaterialTriangle t(scene, frame, draw, id);
  return !(material_detail::own_alpha(t, m, MaterialPoint(t.planes, x, y, from_centre)) <
           m.alpha_cutoff);
}

template <class Geometry>
[[nodiscard]] RASTRUM_HD float alpha_at(const MaterialView& scene, const Geometry& frame,
                                        std::uint64_t id, int x, int y, Vec2 from_centre,
                                        float opacity) {
  const Draw& draw = frame.draw_of(id);
  const MaterialDraw& of = scene.draws[draw.number];
  const BoundMaterial& m = scene.material_of(of, draw.of_copy(id - draw.first_id).primitive);
  opacity = opacity * m.opacity * of.opacity;
  if (m.alpha_mode != AlphaMode::blend) return clamped_alpha(opacity);
  if (has_constant_alpha(of, m)) return clamped_alpha(opacity * m.base.w);
  const MaterialTriangle t(scene, frame, draw, id);
  return clamped_alpha(
      opacity * material_detail::own_alpha(t, m, MaterialPoint(t.planes, x, y, from_centre)));
}

}  // namespace rastrum::raster
