// SPDX-License-Identifier: BSD-3-Clause
// The lit shaders under a frame's lights (lights.inl), in lanes (lit_seen-inl.hpp) or one float
// (lit_scalar.hpp).
#include <rastrum/raster/shade/lit_fixed.inl>

/// light() with a frame's lights, for the surface at reversed depth `depth`. Each shines like the
/// fixed one, and not on surfaces that face away from it.
RASTRUM_LANES V3 light_by(const LightSet& lights, Shader model, const ViewRays& rays, F px, F py,
                          F depth, const V3& normal, const V3& base) {
  if (model != Shader::lambert && model != Shader::phong)
    return light(model, rays, px, py, normal, base);
  const V3 v = unit(-(set(rays.d) + set(rays.dx) * px + set(rays.dy) * py));
  const V3 n = turned_to(v, unit(normal));
  const V3 place = lights.has_places ? place_of(lights, px, py, depth) : v;
  V3 diffuse = gathered(lights, n);
  V3 specular = set(Vec3{});
  for (const LightTerm& term : lights.terms) {
    const Incoming in = incoming(term, place);
    const F n_l = positive(dot(n, in.to_light));
    // A light kit's back lights reach few visible surfaces.
    if (none(n_l > set(0))) continue;
    const V3 radiance = unshadowed(term, in.radiance, place, n, n_l);
    diffuse = diffuse + radiance * n_l;
    if (model == Shader::lambert) continue;
    const F shine = highlight(n, v, in.to_light) * set(kSpecular / kDiffuse);
    specular = specular + radiance * choose_or_zero(n_l > set(0), shine);
  }
  return base * diffuse + specular;
}
