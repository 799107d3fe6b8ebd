// The material shader and alpha at one fragment, for the scalar instruction set and for devices.
// The twin of material_simd.cpp: the same operations in the same order, so the same bits.
#pragma once

#include <cmath>
#include <cstdint>

#include <rastrum/raster/shade/material_constants.hpp>
#include <rastrum/raster/shade/material_triangle.hpp>
#include <rastrum/raster/shade/srgb.hpp>
#include <rastrum/raster/shade/texture_lookup.hpp>

namespace rastrum::raster {

/// Where a triangle is shaded: at pixel (x, y), `from_centre` px from its centre.
struct MaterialPoint {
  float x, y;              ///< px
  double scale;            ///< 1 / Σ weights
  float weight1, weight2;  ///< normalized

  RASTRUM_HD MaterialPoint(const WeightPlanes& w, int px, int py, Vec2 from_centre)
      : x(static_cast<float>(px) + 0.5F + from_centre.x),
        y(static_cast<float>(py) + 0.5F + from_centre.y) {
    const double dx = px + 0.5 - w.x0 + static_cast<double>(from_centre.x);
    const double dy = py + 0.5 - w.y0 + static_cast<double>(from_centre.y);
    const double b0 = w.r[0] + w.p[0] * dx + w.q[0] * dy;
    const double b1 = w.r[1] + w.p[1] * dx + w.q[1] * dy;
    const double b2 = w.r[2] + w.p[2] * dx + w.q[2] * dy;
    scale = 1 / (b0 + b1 + b2);
    weight1 = static_cast<float>(b1 * scale);
    weight2 = static_cast<float>(b2 * scale);
  }
  [[nodiscard]] RASTRUM_HD float interpolate(float a0, float a1, float a2) const {
    const float d1 = a1 - a0, d2 = a2 - a0;
    return a0 + (weight1 * d1 + weight2 * d2);
  }
};

namespace material_detail {

/// A texture coordinate and its change per px.
struct Coordinate {
  float value = 0, dx = 0, dy = 0;

  Coordinate() = default;
  /// From that of corner 0 and the differences to the others'.
  RASTRUM_HD Coordinate(const WeightPlanes& w, const MaterialPoint& at, float a0, float a1,
                        float a2) {
    const double p = w.p[0] + w.p[1] + w.p[2], q = w.q[0] + w.q[1] + w.q[2];
    const double px = w.p[1] * a1 + w.p[2] * a2, qy = w.q[1] * a1 + w.q[2] * a2;
    const float offset = at.weight1 * a1 + at.weight2 * a2;
    value = a0 + offset;
    dx = static_cast<float>((px - offset * p) * at.scale);
    dy = static_cast<float>((qy - offset * q) * at.scale);
  }
};

/// The textures of a material at a point.
struct Sampler {
  Coordinate u, v;

  RASTRUM_HD Sampler(const MaterialTriangle& t, const MaterialPoint& at) {
    const auto& texcoords = t.draw.mesh.texcoords;
    if (texcoords.values.empty()) return;
    const Vec2 a = t.corner(texcoords, 0);
    const Vec2 d1 = t.corner(texcoords, 1) - a;
    const Vec2 d2 = t.corner(texcoords, 2) - a;
    u = Coordinate(t.planes, at, a.x, d1.x, d2.x);
    v = Coordinate(t.planes, at, a.y, d1.y, d2.y);
  }
  template <class Decode>
  [[nodiscard]] RASTRUM_HD auto look_up(const MipChain& chain) const {
    const float lod =
        level_of_detail(static_cast<float>(chain.level[0].width),
                        static_cast<float>(chain.level[0].height), u.dx, v.dx, u.dy, v.dy);
    return Lookup<Decode>(chain)(fold(chain.wrap_u, u.value), fold(chain.wrap_v, v.value), lod);
  }
};

/// NaN becomes the bound.
RASTRUM_HD inline float at_least(float a, float bound) {
  return a > bound ? a : bound;
}
RASTRUM_HD inline float at_most(float a, float bound) {
  return a < bound ? a : bound;
}
RASTRUM_HD inline float clamp01(float a) {
  return at_most(at_least(a, 0), 1);
}
RASTRUM_HD inline float mix(float a, float b, float t) {
  return a + (b - a) * t;
}
RASTRUM_HD inline Vec3 mix(Vec3 a, Vec3 b, float t) {
  return {mix(a.x, b.x, t), mix(a.y, b.y, t), mix(a.z, b.z, t)};
}
RASTRUM_HD inline float pow5(float a) {
  const float a2 = a * a;
  return a2 * a2 * a;
}
RASTRUM_HD inline float written(float linear, bool as_linear) {
  return as_linear ? at_most(at_least(linear, 0), kMostLight) : srgb_from_linear(linear);
}
RASTRUM_HD inline Vec3 written(Vec3 linear, bool as_linear) {
  return {written(linear.x, as_linear), written(linear.y, as_linear), written(linear.z, as_linear)};
}

struct Reflectance {
  Vec3 diffuse, f0;
  float alpha, alpha2;
};

/// Light of one direction, reflected towards v; n·l ≤ 0 gives nothing.
RASTRUM_HD inline Vec3 reflect(const Reflectance& s, Vec3 n, Vec3 v, float nv, Vec3 l,
                               float radiance) {
  const Vec3 sum = v + l;
  const Vec3 half = sum * (1 / std::sqrt(at_least(dot(sum, sum), 1e-12F)));
  const float nl = at_least(dot(n, l), 0);
  const float nh = at_least(dot(n, half), 0);
  const float vh = at_least(dot(v, half), 0);
  const float lobe = nh * nh * (s.alpha2 - 1) + 1;
  const float pi_d = s.alpha2 / (lobe * lobe);
  const float visibility = 0.5F / mix(2 * nl * nv, nl + nv, s.alpha);
  const Vec3 one{1, 1, 1};
  const Vec3 f = mix(s.f0, one, pow5(clamp01(1 - vh)));
  const Vec3 diffuse = s.diffuse * (one - f);
  return (diffuse + f * (pi_d * visibility)) * (nl * radiance);
}

RASTRUM_HD inline Vec3 hemisphere(Vec3 diffuse, Vec3 specular, float normal_y, float mirrored_y) {
  return diffuse * (kSkyMean + kSkySlope * normal_y) +
         specular * (kSkyMean + kSkySlope * mirrored_y);
}

/// What the lights need to know.
struct Surface {
  Vec3 base;
  Vec3 normal;  ///< unit, towards the viewer
  float metallic, roughness, occlusion;
  Vec3 emission;
};

RASTRUM_HD inline Vec3 light(const ViewRays& rays, const Surface& s, const MaterialPoint& at) {
  constexpr Vec3 key = kKeyLight, fill = kFillLight;  // a device has no address of the namespace's
  const Vec3 away = rays.d + rays.dx * at.x + rays.dy * at.y;
  const Vec3 v = away * (0 - 1 / std::sqrt(dot(away, away)));
  const Vec3 n = s.normal;
  const float metallic = clamp01(s.metallic);
  const float roughness = at_most(at_least(s.roughness, kMinRoughness), 1);

  Reflectance surface;
  surface.diffuse = s.base * (1 - metallic);
  surface.f0 = mix({kDielectricF0, kDielectricF0, kDielectricF0}, s.base, metallic);
  surface.alpha = roughness * roughness;
  surface.alpha2 = surface.alpha * surface.alpha;
  const float facing = dot(n, v);
  const float nv = at_least(facing, 1e-4F);
  Vec3 color = reflect(surface, n, v, nv, key, kKeyRadiance) +
               reflect(surface, n, v, nv, fill, kFillRadiance);

  const Vec3 f0 = surface.f0;
  const float smooth = 1 - roughness;
  const Vec3 rise{at_least(smooth - f0.x, 0), at_least(smooth - f0.y, 0),
                  at_least(smooth - f0.z, 0)};
  const Vec3 f = f0 + rise * pow5(clamp01(1 - nv));
  const Vec3 ambient = hemisphere(surface.diffuse, f, n.y, 2 * facing * n.y - v.y);
  color = color + ambient * s.occlusion;
  return color + s.emission;
}

RASTRUM_HD inline Vec3 normal(const MaterialView& scene, const MaterialTriangle& t,
                              const BoundMaterial& m, const MaterialPoint& at,
                              const Sampler& textures) {
  const auto& normals = t.draw.mesh.normals;
  const Vec3 face = t.face_normal();
  const float side = is_seen_from_behind(scene.rays, face, at.x, at.y) ? -1.0F : 1.0F;
  Vec3 n = face * side;
  if (!normals.values.empty()) {
    Vec3 c[3];
    for (int i = 0; i < 3; ++i) c[i] = times(t.draw.normal_matrix, t.corner(normals, i));
    n = turned({at.interpolate(c[0].x, c[1].x, c[2].x), at.interpolate(c[0].y, c[1].y, c[2].y),
                at.interpolate(c[0].z, c[1].z, c[2].z)},
               face, side);
  }
  if (m.normal == nullptr) return n;
  const Texel map = textures.look_up<AllChannels>(*m.normal);
  return TangentFrame(t).bend(n, map.r, map.g, map.b, m.normal_scale * side);
}

/// A fragment's own alpha: what a mask tests and what blends.
RASTRUM_HD inline float own_alpha(const MaterialTriangle& t, const BoundMaterial& m,
                                  const MaterialPoint& at) {
  const auto& colors = t.draw.mesh.colors;
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

/// The colour of triangle `t` at a point, opaque: a display value or linear light.
[[nodiscard]] RASTRUM_HD inline Vec3 shade_material(const MaterialView& scene,
                                                    const MaterialTriangle& t,
                                                    const MaterialPoint& at, bool linear) {
  using namespace material_detail;
  const BoundMaterial& m = scene.material_of(t.draw, t.index);
  const auto& colors = t.draw.mesh.colors;
  const Sampler textures(t, at);
  Surface s{{m.base.x, m.base.y, m.base.z}, {}, m.metallic, m.roughness, 1, m.emission};
  if (!colors.values.empty()) {
    Vec4 c[3];
    for (int i = 0; i < 3; ++i) c[i] = t.corner(colors, i) * m.base;
    s.base = {at.interpolate(c[0].x, c[1].x, c[2].x), at.interpolate(c[0].y, c[1].y, c[2].y),
              at.interpolate(c[0].z, c[1].z, c[2].z)};
  }
  if (m.base_color != nullptr) {
    const Texel c = textures.look_up<AllChannels>(*m.base_color);
    s.base = s.base * Vec3{c.r, c.g, c.b};
  }
  if (m.unlit) return written(s.base, linear);
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
  return written(light(scene.rays, s, at), linear);
}

/// Whether a mask's material leaves the fragment of primitive `id` at (x, y) standing.
template <class Geometry>
[[nodiscard]] RASTRUM_HD bool passes_mask(const MaterialView& scene, const Geometry& frame,
                                          std::uint64_t id, int x, int y, Vec2 from_centre) {
  const Draw& draw = frame.draw_of(id);
  const MaterialDraw& of = scene.draws[draw.number];
  const BoundMaterial& m = scene.material_of(of, id - draw.first_id);
  if (m.alpha_mode != AlphaMode::mask) return true;
  const MaterialTriangle t(scene, frame, draw, id);
  return !(material_detail::own_alpha(t, m, MaterialPoint(t.planes, x, y, from_centre)) <
           m.alpha_cutoff);
}

/// The alpha (alpha.hpp) of a fragment of primitive `id` at (x, y).
template <class Geometry>
[[nodiscard]] RASTRUM_HD float alpha_at(const MaterialView& scene, const Geometry& frame,
                                        std::uint64_t id, int x, int y, Vec2 from_centre,
                                        float opacity) {
  const Draw& draw = frame.draw_of(id);
  const MaterialDraw& of = scene.draws[draw.number];
  const BoundMaterial& m = scene.material_of(of, id - draw.first_id);
  opacity *= m.opacity;
  if (m.alpha_mode != AlphaMode::blend) return clamped_alpha(opacity);
  if (has_constant_alpha(of, m)) return clamped_alpha(opacity * m.base.w);
  const MaterialTriangle t(scene, frame, draw, id);
  return clamped_alpha(
      opacity * material_detail::own_alpha(t, m, MaterialPoint(t.planes, x, y, from_centre)));
}

}  // namespace rastrum::raster
