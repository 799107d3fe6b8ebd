// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/light.hpp>

#include <cmath>
#include <string>
#include <variant>

#include <rastrum/core/angle.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/vectors.hpp>
#include <rastrum/error.hpp>

namespace rastrum {
namespace {

bool is_color(Vec3 c) {
  return c.x >= 0 && c.y >= 0 && c.z >= 0 && c.x <= 1e12F && c.y <= 1e12F && c.z <= 1e12F;
}

bool is_direction(Vec3 v) {
  const double square = static_cast<double>(v.x) * v.x + static_cast<double>(v.y) * v.y +
                        static_cast<double>(v.z) * v.z;
  return square > 0 && std::isfinite(square);
}

/// Null: the light is valid.
struct Problem {
  const char* operator()(const AmbientLight&) const { return nullptr; }
  const char* operator()(const HemisphereLight& h) const {
    if (!is_direction(h.up)) return "its up must be finite and not zero";
    return is_color(h.below) ? nullptr : "its colour below must lie in [0, 1e12]";
  }
  const char* operator()(const DirectionalLight& d) const {
    return is_direction(d.direction) ? nullptr : "its direction must be finite and not zero";
  }
  const char* operator()(const PointLight& p) const { return placed(p.position, p.range); }
  const char* operator()(const SpotLight& s) const {
    if (const char* const problem = placed(s.position, s.range)) return problem;
    if (!is_direction(s.direction)) return "its direction must be finite and not zero";
    // π / 2 in float32 is a little more than in float64.
    const bool cone = s.inner_rad >= 0 && s.inner_rad < s.outer_rad &&
                      s.outer_rad <= std::numbers::pi_v<float> / 2;
    return cone ? nullptr : "its cone must have 0 <= inner < outer <= 90 degrees";
  }
  const char* operator()(const EnvironmentLight& e) const {
    if (!e.picture) return "its environment has no picture";
    if (!is_direction(e.up)) return "its up must be finite and not zero";
    return std::isfinite(e.turn_rad) ? nullptr : "its turn must be finite";
  }
  static const char* placed(Vec3d p, float range) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      return "its position must be finite";
    return range > 0 ? nullptr : "its range must be greater than 0";
  }
};

const char* problem_of(const ClassicLight& c) {
  for (const Vec3 color : {c.ambient, c.diffuse, c.specular})
    if (!is_color(color)) return "its classic colours must lie in [0, 1e12]";
  const Vec3 a = c.attenuation;
  if (!is_color(a) || a.x + a.y + a.z == 0)
    return "its attenuation must be three numbers in [0, 1e12] of which one is not 0";
  return c.exponent >= 0 && c.exponent <= 128 ? nullptr : "its exponent must lie in [0, 128]";
}

/// A lamp of VTK's light kit, `elevation` above and `azimuth` to the right of the viewer.
Light lamp(double elevation, double azimuth, float intensity, Vec3 color) {
  const SinCos up = sin_cos_degrees(elevation), across = sin_cos_degrees(azimuth);
  Light light;
  light.kind = DirectionalLight{Vec3(Vec3d{-up.cos * across.sin, -up.sin, -up.cos * across.cos})};
  light.color = color;
  light.intensity = intensity;
  light.of_camera = true;
  return light;
}

}  // namespace

void check_lights(std::span<const Light> lights) {
  const FloatScope floats;
  if (lights.size() > kMaxLights)
    throw Error(Errc::invalid_argument, std::to_string(lights.size()) +
                                            " lights are given, and at most " +
                                            std::to_string(kMaxLights) + " are possible");
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Light& light = lights[i];
    const char* problem = std::visit(Problem{}, light.kind);
    if (problem == nullptr && light.classic) {
      problem = problem_of(*light.classic);
      if (std::holds_alternative<AmbientLight>(light.kind) ||
          std::holds_alternative<HemisphereLight>(light.kind) ||
          std::holds_alternative<EnvironmentLight>(light.kind))
        problem = "its classic part is for directional lights, points and spots";
    }
    if (!is_color(light.color)) problem = "its colour must lie in [0, 1e12]";
    if (!(light.intensity >= 0 && light.intensity <= 1e12F))
      problem = "its intensity must lie in [0, 1e12]";
    if (problem != nullptr)
      throw Error(Errc::invalid_argument, "light " + std::to_string(i) + ": " + problem);
  }
}

Light placed(const Light& light, const Mat4d& to_world) {
  const FloatScope floats;
  if (light.of_camera) return light;
  const auto turn = [&](Vec3 v) { return Vec3(turned_by(to_world, v)); };
  const auto move = [&](Vec3d p) { return moved_by(to_world, p); };
  Light moved = light;
  if (auto* const h = std::get_if<HemisphereLight>(&moved.kind)) {
    h->up = turn(h->up);
  } else if (auto* const d = std::get_if<DirectionalLight>(&moved.kind)) {
    d->direction = turn(d->direction);
  } else if (auto* const p = std::get_if<PointLight>(&moved.kind)) {
    p->position = move(p->position);
  } else if (auto* const s = std::get_if<SpotLight>(&moved.kind)) {
    s->position = move(s->position);
    s->direction = turn(s->direction);
  } else if (auto* const e = std::get_if<EnvironmentLight>(&moved.kind)) {
    e->up = turn(e->up);
  }
  return moved;
}

Light headlight(float intensity) {
  const FloatScope floats;
  Light light;
  light.intensity = intensity;
  light.of_camera = true;
  return light;
}

std::vector<Light> light_kit(float ambient) {
  const FloatScope floats;
  constexpr float kKey = 0.75F;
  constexpr Vec3 kWarm{1, 0.972320F, 0.902222F}, kCool{0.90824F, 0.93314F, 1},
      kWhite{0.9998F, 0.9998F, 0.9998F};
  std::vector<Light> kit{lamp(50, 10, kKey, kWarm), lamp(-75, -10, kKey / 3, kCool),
                         lamp(0, 110, kKey / 3.5F, kWhite), lamp(0, -110, kKey / 3.5F, kWhite),
                         headlight(kKey / 3)};
  Light all_around;
  all_around.kind = AmbientLight{};
  all_around.intensity = ambient;
  kit.push_back(all_around);
  return kit;
}

}  // namespace rastrum
