// SPDX-License-Identifier: BSD-3-Clause
// The lights of the material shader (formula in material.hpp). One body in lanes
// (material_light-inl.hpp) or one float (material_scalar.hpp), so the bits are the same.

RASTRUM_LANES F mix(F a, F b, F t) {
  return a + (b - a) * t;
}
RASTRUM_LANES V3 mix(const V3& a, const V3& b, F t) {
  return {mix(a.x, b.x, t), mix(a.y, b.y, t), mix(a.z, b.z, t)};
}
RASTRUM_LANES F pow5(F a) {
  const F a2 = a * a;
  return a2 * a2 * a;
}

/// The result of a shader: a display value, or finite linear light.
RASTRUM_LANES F written(F linear, bool as_linear) {
  return as_linear ? at_most(at_least(linear, 0), kMostLight) : srgb_from_linear(linear);
}
RASTRUM_LANES V3 written(const V3& linear, bool as_linear) {
  return {written(linear.x, as_linear), written(linear.y, as_linear), written(linear.z, as_linear)};
}

struct Reflectance {
  V3 diffuse, f0;
  F alpha, alpha2;
};

struct Reflected {
  V3 share;  ///< of the arriving light
  F n_l;     ///< how much of it arrives
};
/// Light from one direction, reflected towards v; n·l ≤ 0 gives nothing.
RASTRUM_LANES Reflected reflect(const Reflectance& s, const V3& n, const V3& v, F nv, const V3& l) {
  const V3 sum = v + l;
  const V3 half = sum * (set(1) / square_root(at_least(dot(sum, sum), 1e-12F)));
  const F nl = at_least(dot(n, l), 0);
  const F nh = at_least(dot(n, half), 0);
  const F vh = at_least(dot(v, half), 0);
  const F lobe = nh * nh * (s.alpha2 - set(1)) + set(1);
  const F pi_d = s.alpha2 / (lobe * lobe);
  const F visibility = set(0.5F) / mix(set(2) * nl * nv, nl + nv, s.alpha);
  const V3 one = set(Vec3{1, 1, 1});
  const V3 f = mix(s.f0, one, pow5(clamp01(set(1) - vh)));
  const V3 diffuse = s.diffuse * (one - f);
  return {diffuse + f * (pi_d * visibility), nl};
}
/// For a white light.
RASTRUM_LANES V3 reflect(const Reflectance& s, const V3& n, const V3& v, F nv, Vec3 to_light,
                         float radiance) {
  const Reflected r = reflect(s, n, v, nv, set(to_light));
  return r.share * (r.n_l * set(radiance));
}

RASTRUM_LANES V3 hemisphere(const V3& diffuse, const V3& specular, F normal_y, F mirrored_y) {
  return diffuse * (set(kSkyMean) + set(kSkySlope) * normal_y) +
         specular * (set(kSkyMean) + set(kSkySlope) * mirrored_y);
}

struct LitSurface {
  V3 base;
  V3 normal;  ///< unit, towards the viewer
  F metallic, roughness, occlusion;
  V3 emission;
};

/// Values that all lights at a point share.
struct SeenSurface {
  V3 n, v;
  F facing;  ///< n·v
  F nv;      ///< the same, kept above 0
  Reflectance surface;
  V3 f;  ///< Fresnel term of light from all around
  F roughness;
};
RASTRUM_LANES SeenSurface seen_from(const ViewRays& rays, const LitSurface& s, F px, F py) {
  const V3 away = set(rays.d) + set(rays.dx) * px + set(rays.dy) * py;
  const V3 v = away * (set(0) - set(1) / square_root(dot(away, away)));
  const V3 n = s.normal;
  const F metallic = clamp01(s.metallic);
  const F roughness = at_most(at_least(s.roughness, kMinRoughness), 1);

  const F alpha = roughness * roughness;
  const Reflectance surface{
      s.base * (set(1) - metallic),
      mix(set(Vec3{kDielectricF0, kDielectricF0, kDielectricF0}), s.base, metallic), alpha,
      alpha * alpha};
  const F facing = dot(n, v);
  const F nv = at_least(facing, 1e-4F);

  const V3 f0 = surface.f0;
  const F smooth = set(1) - roughness;
  const V3 rise{at_least(smooth - f0.x, 0), at_least(smooth - f0.y, 0), at_least(smooth - f0.z, 0)};
  return {n, v, facing, nv, surface, f0 + rise * pow5(clamp01(set(1) - nv)), roughness};
}

/// Linear light at (px, py), px.
RASTRUM_LANES V3 light(const ViewRays& rays, const LitSurface& s, F px, F py) {
  constexpr Vec3 key = kKeyLight,
                 fill = kFillLight;  // a device has no address of a namespace's constant
  const SeenSurface p = seen_from(rays, s, px, py);
  const V3 direct = reflect(p.surface, p.n, p.v, p.nv, key, kKeyRadiance) +
                    reflect(p.surface, p.n, p.v, p.nv, fill, kFillRadiance);
  const V3 ambient = hemisphere(p.surface.diffuse, p.f, p.n.y, set(2) * p.facing * p.n.y - p.v.y);
  return direct + ambient * s.occlusion + s.emission;
}

/// By a frame's lights, for the surface at reversed depth `depth`.
RASTRUM_LANES V3 light_by(const LightSet& lights, const ViewRays& rays, const LitSurface& s, F px,
                          F py, F depth) {
  const SeenSurface p = seen_from(rays, s, px, py);
  const V3 place = lights.has_places ? place_of(lights, px, py, depth) : p.v;
  V3 direct = set(Vec3{});
  for (const LightTerm& term : lights.terms) {
    const Incoming in = incoming(term, place);
    const Reflected r = reflect(p.surface, p.n, p.v, p.nv, in.to_light);
    const V3 radiance = unshadowed(term, in.radiance, place, p.n, r.n_l);
    direct = direct + r.share * (radiance * r.n_l);
  }
  const V3 mirrored = p.n * (set(2) * p.facing) - p.v;
  const V3 ambient = p.surface.diffuse * gathered(lights, p.n) +
                     p.f * mirrored_around(lights, mirrored, p.roughness);
  return direct + ambient * s.occlusion + s.emission;
}
