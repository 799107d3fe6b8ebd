// SPDX-License-Identifier: BSD-3-Clause
// The formulas of docs/light_rules.md in float64, for tests: the light that arrives at a point.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>
#include <vector>

#include <rastrum/light.hpp>
#include <rastrum/vec.hpp>

#include "tests/support/colors.hpp"

namespace rastrum::test::light_oracle {

[[nodiscard]] inline Light light(decltype(Light::kind) kind, float intensity = 1,
                                 Vec3 color = {1, 1, 1}) {
  return Light{.kind = kind, .color = color, .intensity = intensity};
}

[[nodiscard]] inline Vec3d wide(Vec3 v) {
  return {v.x, v.y, v.z};
}
[[nodiscard]] inline Vec3d unit(Vec3d v) {
  return v * (1 / length(v));
}
[[nodiscard]] inline Vec3d times(Vec3d a, Vec3d b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

struct Arrived {
  Vec3d to_light;
  Vec3d radiance;
};
/// Ambient and hemisphere light: what arrives at a surface with normal d.
[[nodiscard]] inline std::optional<Vec3d> around(const Light& l, Vec3d d) {
  const Vec3d full = wide(l.color) * l.intensity;
  if (std::holds_alternative<AmbientLight>(l.kind)) return full;
  if (const auto* const h = std::get_if<HemisphereLight>(&l.kind)) {
    const double share = (1 + dot(unit(wide(h->up)), d)) / 2;
    return full * share + wide(h->below) * (l.intensity * (1 - share));
  }
  return {};
}
[[nodiscard]] inline Arrived arrived(const Light& l, Vec3d p) {
  const Vec3d full = wide(l.color) * l.intensity;
  if (const auto* const d = std::get_if<DirectionalLight>(&l.kind))
    return {unit(wide(d->direction)) * -1, full};
  const auto* const point = std::get_if<PointLight>(&l.kind);
  const auto* const spot = std::get_if<SpotLight>(&l.kind);
  const Vec3d away = (point != nullptr ? point->position : spot->position) - p;
  const double range = point != nullptr ? point->range : spot->range;
  const double d = length(away);
  double share = std::max(std::min(1 - std::pow(d / range, 4), 1.0), 0.0) / (d * d);
  if (spot != nullptr) {
    const double inner = std::cos(spot->inner_rad), outer = std::cos(spot->outer_rad);
    const double scale = 1 / std::max(0.001, inner - outer);
    const double cosine = dot(unit(away) * -1, unit(wide(spot->direction)));
    const double cone = std::clamp(cosine * scale - outer * scale, 0.0, 1.0);
    share *= cone * cone;
  }
  return {unit(away), full * share};
}

/// All lights of all sets, dimmed.
inline std::vector<Light> all_dimmed(const std::vector<std::vector<Light>>& sets) {
  std::vector<Light> all;
  for (const auto& set : sets)
    for (Light l : set) {
      l.intensity *= 0.3F;
      all.push_back(l);
    }
  return all;
}

}  // namespace rastrum::test::light_oracle
