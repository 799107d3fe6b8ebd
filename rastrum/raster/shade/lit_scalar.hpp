// The scalar form of the lit shaders but wireframe, for the host and for devices. The twin of
// lit_simd.cpp: the same float32 operations in the same order, because where a normal stands at a
// right angle to the view the last bit decides which side it faces.
#pragma once

#include <algorithm>
#include <cmath>

#include <rastrum/raster/shade/lit_constants.hpp>
#include <rastrum/raster/shade/lit_triangle.hpp>

namespace rastrum::raster {
namespace lit_detail {

RASTRUM_HD inline Vec3 unit(Vec3 v) {
  const float square = dot(v, v);
  return v * (square > 0 ? 1.0F / std::sqrt(square) : 1.0F);
}
RASTRUM_HD inline float positive(float v) {
  return v > 0 ? v : 0.0F;
}

struct SampleWeights {
  float b[3];  ///< up to a common positive factor

  RASTRUM_HD SampleWeights(const LitTriangle& t, int x, int y, Vec2 from_centre) {
    if (t.exact) {
      const Weights w = weights_at(t.planes, x, y, from_centre);
      for (int c = 0; c < 3; ++c) b[c] = static_cast<float>(w.b[c]);
      return;
    }
    const float dx = (static_cast<float>(x) + 0.5F + from_centre.x) - t.x0;
    const float dy = (static_cast<float>(y) + 0.5F + from_centre.y) - t.y0;
    const float l1 = t.p1 * dx + t.q1 * dy;
    const float l2 = t.p2 * dx + t.q2 * dy;
    b[0] = (1.0F - l1 - l2) * t.inv_w[0];
    b[1] = l1 * t.inv_w[1];
    b[2] = l2 * t.inv_w[2];
  }
  [[nodiscard]] RASTRUM_HD Vec3 sum(const Vec3 (&v)[3]) const {
    return v[0] * b[0] + v[1] * b[1] + v[2] * b[2];
  }
};

RASTRUM_HD inline Vec3 light(LitModel model, const ViewRays& rays, int x, int y, Vec2 from_centre,
                             Vec3 normal, Vec3 base) {
  if (model == LitModel::flat) return base;
  constexpr Vec3 to_light = kLight;  // a device has no address of the namespace's
  Vec3 n = unit(normal);
  if (model == LitModel::normal) return n * 0.5F + Vec3{0.5F, 0.5F, 0.5F};
  const float px = static_cast<float>(x) + 0.5F + from_centre.x;
  const float py = static_cast<float>(y) + 0.5F + from_centre.y;
  const Vec3 v = unit(-(rays.d + rays.dx * px + rays.dy * py));
  n = n * (dot(n, v) < 0 ? -1.0F : 1.0F);
  const Vec3 lit = base * (kAmbient + kDiffuse * positive(dot(n, to_light)));
  if (model == LitModel::lambert) return lit;
  // (n·h)³² = ((n·u)² / u·u)¹⁶ with u = v + l: the half vector needs no square root.
  const Vec3 u = v + to_light;
  const float n_u = positive(dot(n, u));
  float s = n_u * n_u / std::max(dot(u, u), 1e-20F);
  for (int i = 0; i < 4; ++i) s *= s;
  const float specular = s * kSpecular;
  return lit + Vec3{specular, specular, specular};
}

}  // namespace lit_detail

/// The colour of triangle `t` at pixel (x, y), `from_centre` px from its centre. Not for `id` and
/// `wireframe`.
[[nodiscard]] RASTRUM_HD inline Vec3 shade_lit(LitModel model, const LitView& scene,
                                               const LitTriangle& t, int x, int y,
                                               Vec2 from_centre) {
  const lit_detail::SampleWeights w(t, x, y, from_centre);
  constexpr Vec3 default_base = kDefaultBase;
  Vec3 base = default_base;
  if (scene.colored && model != LitModel::normal)
    base = w.sum(t.color) * (1.0F / (w.b[0] + w.b[1] + w.b[2]));
  const Vec3 normal = model != LitModel::flat ? w.sum(t.normal) : base;
  return lit_detail::light(model, scene.rays, x, y, from_centre, normal, base);
}

}  // namespace rastrum::raster
