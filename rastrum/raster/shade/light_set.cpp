#include <rastrum/raster/shade/light_set.hpp>

#include <algorithm>
#include <optional>
#include <variant>

#include <rastrum/core/elementary.hpp>
#include <rastrum/mat.hpp>

namespace rastrum::raster {
namespace {

struct Standpoint {
  Mat4d camera_to_world;
  Vec3d origin;  ///< from which places are counted
};

Vec3d unit(Vec3d v) {
  return v * (1 / length(v));
}

Vec3d direction(const Standpoint& frame, bool of_camera, Vec3 v) {
  const Vec3d d{v.x, v.y, v.z};
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

/// Row `row` of clip to world, as a function of pixels.
PixelPlane plane(const Mat4d& clip_to_world, int row, int width, int height) {
  const double(&m)[4] = clip_to_world.m[row];
  return {static_cast<float>(m[3] - m[0] + m[1]), static_cast<float>(m[0] * 2 / width),
          static_cast<float>(m[1] * -2 / height), static_cast<float>(m[2])};
}

ShadowMap map_of(const LightShadow& shadow, const Mat4d& from_origin) {
  const Mat4d clip = shadow.world_to_clip * from_origin;
  const int size = shadow.depth.width;
  const auto row = [&](auto&& of) {
    return Vec4{static_cast<float>(of(0)), static_cast<float>(of(1)), static_cast<float>(of(2)),
                static_cast<float>(of(3))};
  };
  ShadowMap map;
  map.depth = &shadow.depth(0, 0);
  map.size = size;
  map.column = row([&](int k) { return (clip.m[3][k] + clip.m[0][k]) * size / 2; });
  map.row = row([&](int k) { return (clip.m[3][k] - clip.m[1][k]) * size / 2; });
  map.z = row([&](int k) { return clip.m[2][k]; });
  map.w = row([&](int k) { return clip.m[3][k]; });
  map.offset = static_cast<float>(3 * shadow.texel);
  return map;
}

}  // namespace

FrameLights::FrameLights(std::span<const Light> lights, std::span<const LightShadow> shadows,
                         const Camera& camera, int width, int height) {
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
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Light& light = lights[i];
    const Vec3 full = light.color * light.intensity;
    if (std::holds_alternative<AmbientLight>(light.kind)) {
      set_.ambient = set_.ambient + full;
      continue;
    }
    if (const auto* const h = std::get_if<HemisphereLight>(&light.kind)) {
      const Vec3 below = h->below * light.intensity;
      const auto up = Vec3(direction(frame, light.of_camera, h->up));
      const Vec3 rise = (full - below) * 0.5F;
      set_.ambient = set_.ambient + (full + below) * 0.5F;
      set_.rise_x = set_.rise_x + rise * up.x;
      set_.rise_y = set_.rise_y + rise * up.y;
      set_.rise_z = set_.rise_z + rise * up.z;
      continue;
    }
    LightTerm& term = terms_.emplace_back();
    term.radiance = full;
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
    if (!shadows.empty() && !shadows[i].depth.empty())
      term.shadow = &maps_.emplace_back(map_of(shadows[i], from_origin));
    set_.has_places |= term.kind != LightTerm::Kind::directional || term.shadow != nullptr;
  }
  set_.terms = terms_;
}

}  // namespace rastrum::raster
