// SPDX-License-Identifier: BSD-3-Clause
// The lit shaders except `id` and `wireframe` at one point, for host and devices.
#pragma once

#include <rastrum/raster/shade/lights_scalar.hpp>
#include <rastrum/raster/shade/lit_constants.hpp>
#include <rastrum/raster/shade/lit_triangle.hpp>

namespace rastrum::raster {
namespace scalar_lane {
#define RASTRUM_LANES RASTRUM_HD inline
#include <rastrum/raster/shade/lit_light.inl>
#undef RASTRUM_LANES
}  // namespace scalar_lane

/// At pixel (x, y), `from_centre` px from its centre.
[[nodiscard]] RASTRUM_HD inline scalar_lane::CornerWeights corner_weights(const LitTriangle& t,
                                                                          int x, int y,
                                                                          Vec2 from_centre) {
  if (!t.exact)
    return scalar_lane::weights_of(t, static_cast<float>(x) + 0.5F + from_centre.x,
                                   static_cast<float>(y) + 0.5F + from_centre.y);
  const Weights exact = weights_at(t.planes, x, y, from_centre);
  return {static_cast<float>(exact.b[0]), static_cast<float>(exact.b[1]),
          static_cast<float>(exact.b[2])};
}

/// SeenNormals::world of triangle `t` at the centre of pixel (x, y). `cut`: it may miss the centre.
[[nodiscard]] inline Vec3 seen_normal(const ViewRays& rays, const LitTriangle& t, int x, int y,
                                      bool cut) {
  scalar_lane::CornerWeights w = corner_weights(t, x, y, {0, 0});
  if (cut) w = scalar_lane::inside(w);
  return scalar_lane::seen_normal(rays, static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F,
                                  w.sum(t.normal));
}

/// The colour of triangle `t` at pixel (x, y), `from_centre` px from its centre. `depth` there is
/// for the scene's lights. `own_base` replaces the base colour; null: it does not.
[[nodiscard]] RASTRUM_HD inline Vec3 shade_lit(Shader model, const LitView& scene,
                                               const LitTriangle& t, int x, int y, Vec2 from_centre,
                                               float depth = 0, const Vec3* own_base = nullptr) {
  const float px = static_cast<float>(x) + 0.5F + from_centre.x;
  const float py = static_cast<float>(y) + 0.5F + from_centre.y;
  const scalar_lane::CornerWeights w = corner_weights(t, x, y, from_centre);
  constexpr Vec3 default_base = kDefaultBase;
  Vec3 base = default_base;
  if (own_base != nullptr)
    base = *own_base;
  else if (scene.colored && model != Shader::normal)
    base = scalar_lane::interpolated_color(t, w);
  const Vec3 normal = model != Shader::flat ? w.sum(t.normal) : base;
  if (scene.lights != nullptr)
    return scalar_lane::light_by(*scene.lights, model, scene.rays, px, py, depth, normal, base);
  return scalar_lane::light(model, scene.rays, px, py, normal, base);
}

}  // namespace rastrum::raster
