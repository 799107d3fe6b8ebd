// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/shade/light_set.hpp>

#include <algorithm>
#include <optional>
#include <variant>

#include <rastrum/core/elementary.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/raster/rules/srgb.hpp>
#include <rastrum/raster/shade/material.hpp>
#include <rastrum/scene/tilt.hpp>

namespace rastrum::raster {
namespace {

struct Standpoint {
  Mat4d camera_to_world;
  Vec3d origin;  ///< places are relative to it
};

Vec3d unit(Vec3d v) {
  return v * (1 / length(v));
}

Vec3d direction(const Standpoint& frame, bool of_camera, Vec3d d) {
  const auto& m = frame.camera_to_world.m;
  if (!of_camera) return unit(d);
  return unit({m[0][0] * d.x + m[0][1] * d.y + m[0][2] * d.z,
               m[1][0] * d.x + m[1][1] * d.y + m[1][2] * d.z,
               m[2][0] * d.x + m[2][1] * d.y + m[2][2] * d.z});
}

Vec3 place(const Standpoint& frame, bool of_camera, Vec3d p) {
  const auto& m = frame.camera_to_world.m;
  if (of_camera)
    p = {m[0][0] * p.x + m[0][1] * p.y + m[0][2] * p.z + m[0][3],
         m[1][0] * p.x + m[1][1] * p.y + m[1][2] * p.z + m[1][3],
         m[2][0] * p.x + m[2][1] * p.y + m[2][2] * p.z + m[2][3]};
  return Vec3(p - frame.origin);
}

float inverse_square(float range) {
  return static_cast<float>(1 / (static_cast<double>(range) * static_cast<double>(range)));
}

void set_cone(const SpotLight& spot, LightTerm& term) {
  const double inner = elementary::cos(static_cast<double>(spot.inner_rad));
  const double outer = elementary::cos(static_cast<double>(spot.outer_rad));
  const double scale = 1 / std::max(0.001, inner - outer);
  term.cone_scale = static_cast<float>(scale);
  term.cone_offset = static_cast<float>(-outer * scale);
}

Vec3 displayed(Vec3 linear) {
  return {display_value(linear.x), display_value(linear.y), display_value(linear.z)};
}

/// `full`: its colour times its intensity.
ClassicTerm classic_term(const Light& light, Vec3 full) {
  ClassicTerm term;
  term.diffuse = term.specular = full;
  if (!light.classic) return term;
  const ClassicLight& own = *light.classic;
  term.ambient = own.ambient;
  term.diffuse = own.diffuse;
  term.specular = own.specular;
  term.fades = true;
  term.fade = own.attenuation;
  if (const auto* const spot = std::get_if<SpotLight>(&light.kind))
    term.cutoff = static_cast<float>(elementary::cos(static_cast<double>(spot->outer_rad)));
  term.sixteenths = sixteenths(own.exponent);
  return term;
}

PixelPlane plane(const Mat4d& clip_to_world, int row, int width, int height) {
  const double(&m)[4] = clip_to_world.m[row];
  return {static_cast<float>(m[3] - m[0] + m[1]), static_cast<float>(m[0] * 2 / width),
          static_cast<float>(m[1] * -2 / height), static_cast<float>(m[2])};
}

ShadowMap map_of(const LightPicture& picture, const Mat4d& from_origin) {
  const Mat4d clip = picture.world_to_clip * from_origin;
  const int width = picture.depth.width, height = picture.depth.height;
  const auto row = [&](auto&& of) {
    return Vec4{static_cast<float>(of(0)), static_cast<float>(of(1)), static_cast<float>(of(2)),
                static_cast<float>(of(3))};
  };
  ShadowMap map;
  map.depth = &picture.depth(0, 0);
  map.width = width;
  map.height = height;
  map.column = row([&](int k) { return (clip.m[3][k] + clip.m[0][k]) * width / 2; });
  map.row = row([&](int k) { return (clip.m[3][k] - clip.m[1][k]) * height / 2; });
  map.z = row([&](int k) { return clip.m[2][k]; });
  map.w = row([&](int k) { return clip.m[3][k]; });
  map.offset = static_cast<float>(3 * picture.texel);
  return map;
}

FrameLights::Axes axes_of(const EnvironmentLight& light, const Standpoint& frame, bool of_camera) {
  const auto [sin, cos] = elementary::sin_cos(static_cast<double>(light.turn_rad));
  const Vec3d up = unit({light.up.x, light.up.y, light.up.z});
  const auto axis = [&](Vec3d v) { return direction(frame, of_camera, tilted(up, v)); };
  return {axis({cos, 0, -sin}), axis({0, 1, 0}), axis({sin, 0, cos})};
}

}  // namespace

FrameLights::FrameLights(std::span<const Light> lights, std::span<const LightShadow> shadows,
                         const Camera& camera, int width, int height, bool classic) {
  Standpoint frame;
  const auto camera_to_world = inverse(world_to_camera(camera));
  frame.camera_to_world = camera_to_world.value_or(Mat4d::identity());
  const auto& c = frame.camera_to_world.m;
  frame.origin = {c[0][3], c[1][3], c[2][3]};
  Mat4d from_origin = Mat4d::identity();
  for (int i = 0; i < 3; ++i) from_origin.m[i][3] = c[i][3];
  const Mat4d to_clip = world_to_clip(camera, width, height) * from_origin;
  if (const auto to_world = inverse(to_clip)) {
    set_.x = plane(*to_world, 0, width, height);
    set_.y = plane(*to_world, 1, width, height);
    set_.z = plane(*to_world, 2, width, height);
    set_.w = plane(*to_world, 3, width, height);
  }
  std::size_t pictures = 0;
  for (const LightShadow& shadow : shadows) pictures += shadow.size();
  maps_.reserve(pictures);  // maps must not move
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Light& light = lights[i];
    const auto colored = [&](Vec3 own) {
      return (classic ? displayed(own) : own) * light.intensity;
    };
    const Vec3 full = colored(light.color);
    if (std::holds_alternative<AmbientLight>(light.kind)) {
      set_.ambient = set_.ambient + full;
      continue;
    }
    if (const auto* const h = std::get_if<HemisphereLight>(&light.kind)) {
      const Vec3 below = colored(h->below);
      const auto up = Vec3(direction(frame, light.of_camera, h->up));
      const Vec3 rise = (full - below) * 0.5F;
      set_.ambient = set_.ambient + (full + below) * 0.5F;
      set_.rise_x = set_.rise_x + rise * up.x;
      set_.rise_y = set_.rise_y + rise * up.y;
      set_.rise_z = set_.rise_z + rise * up.z;
      continue;
    }
    if (const auto* const e = std::get_if<EnvironmentLight>(&light.kind)) {
      add_environment(*e, axes_of(*e, frame, light.of_camera), full);
      continue;
    }
    LightTerm& term = terms_.emplace_back();
    term.radiance = full;
    term.classic = classic_term(light, full);
    if (const auto* const d = std::get_if<DirectionalLight>(&light.kind)) {
      term.place = -Vec3(direction(frame, light.of_camera, d->direction));
    } else if (const auto* const p = std::get_if<PointLight>(&light.kind)) {
      term.kind = LightTerm::Kind::point;
      term.place = place(frame, light.of_camera, p->position);
      term.inv_range2 = inverse_square(p->range);
    } else {
      const auto& spot = std::get<SpotLight>(light.kind);
      term.kind = LightTerm::Kind::spot;
      term.place = place(frame, light.of_camera, spot.position);
      term.inv_range2 = inverse_square(spot.range);
      term.axis = Vec3(direction(frame, light.of_camera, spot.direction));
      set_cone(spot, term);
    }
    if (!shadows.empty()) {
      const std::size_t first = maps_.size();
      for (const LightPicture& picture : shadows[i]) maps_.push_back(map_of(picture, from_origin));
      term.shadow = std::span(maps_).subspan(first);
    }
    set_.has_places |= term.kind != LightTerm::Kind::directional || !term.shadow.empty();
  }
  set_.terms = terms_;
  set_.surroundings = surroundings_;
}

void FrameLights::add_environment(const EnvironmentLight& light, const Axes& axes, Vec3 color) {
  const environment_detail::Data& data = light.picture->data();
  surroundings_.push_back({data.map, Vec3(axes.x), Vec3(axes.y), Vec3(axes.z), color});
  // A vector r of the picture is R r in the world, and a form S is R S Rᵀ.
  const environment_detail::Gathered& g = data.gathered;
  GatheredLight& sum = set_.gathered;
  const double of_color[3] = {color.x, color.y, color.z};
  const double mean[3] = {g.mean.x, g.mean.y, g.mean.z};
  double rise[3][3], bend[6][3];
  for (int c = 0; c < 3; ++c) {
    const Vec3d r = axes.x * g.rise[c].x + axes.y * g.rise[c].y + axes.z * g.rise[c].z;
    const double(&s)[6] = g.bend[c];
    // Columns of S, with halves of the mixed terms.
    const Vec3d column[3] = {
        {s[0], s[3] / 2, s[5] / 2}, {s[3] / 2, s[1], s[4] / 2}, {s[5] / 2, s[4] / 2, s[2]}};
    const auto entry = [&](const Vec3d& a, const Vec3d& b) {
      return a.x * dot(column[0], b) + a.y * dot(column[1], b) + a.z * dot(column[2], b);
    };
    const Vec3d row[3] = {{axes.x.x, axes.y.x, axes.z.x},
                          {axes.x.y, axes.y.y, axes.z.y},
                          {axes.x.z, axes.y.z, axes.z.z}};
    const double turned[6] = {entry(row[0], row[0]),     entry(row[1], row[1]),
                              entry(row[2], row[2]),     2 * entry(row[0], row[1]),
                              2 * entry(row[1], row[2]), 2 * entry(row[2], row[0])};
    const double moved[3] = {r.x, r.y, r.z};
    for (int k = 0; k < 3; ++k) rise[k][c] = moved[k] * of_color[c];
    for (int k = 0; k < 6; ++k) bend[k][c] = turned[k] * of_color[c];
  }
  const auto rounded = [](const double(&v)[3]) { return Vec3(Vec3d{v[0], v[1], v[2]}); };
  sum.mean =
      sum.mean + Vec3(Vec3d{mean[0] * of_color[0], mean[1] * of_color[1], mean[2] * of_color[2]});
  for (int k = 0; k < 3; ++k) sum.rise[k] = sum.rise[k] + rounded(rise[k]);
  for (int k = 0; k < 6; ++k) sum.bend[k] = sum.bend[k] + rounded(bend[k]);
}

}  // namespace rastrum::raster
