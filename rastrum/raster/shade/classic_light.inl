// SPDX-License-Identifier: BSD-3-Clause
// The lights of the classic shader (formula in material.hpp). One body in lanes
// (material_light-inl.hpp) or one float (material_scalar.hpp), so the bits are the same.

/// base^(sixteenths / 16), for a base in [0, 1] and sixteenths in [0, 2048].
RASTRUM_LANES F power(F base, int sixteenths) {
  F result = set(1), factor = base;
  for (int part = sixteenths % 16, value = 8; part != 0; part %= value, value /= 2) {
    factor = square_root(factor);  // base^(value / 16)
    if (part >= value) result = result * factor;
  }
  factor = base;
  for (int whole = sixteenths / 16; whole != 0; whole /= 2) {
    if (whole % 2 != 0) result = result * factor;
    factor = factor * factor;
  }
  return result;
}
/// Lanes may have other exponents, whole sixteenths; mostly they do not.
RASTRUM_LANES F power(F base, F sixteenths) {
  F result = base;
  for_each_value(sixteenths, [&](float value, auto here) {
    result = choose(here, power(base, static_cast<int>(value)), result);
  });
  return result;
}

/// The share of a light that arrives.
RASTRUM_LANES Arriving classic_arriving(const LightTerm& t, const V3& place) {
  const ClassicTerm& c = t.classic;
  if (!c.fades || t.kind == LightTerm::Kind::directional) return arriving(t, place);
  const V3 away = set(t.place) - place;
  const F square = at_least(dot(away, away), 1e-12F);
  const F distance = square_root(square);
  const V3 l = away * (set(1) / distance);
  F share = set(1) / (set(c.fade.x) + set(c.fade.y) * distance + set(c.fade.z) * square);
  if (t.kind == LightTerm::Kind::spot) {
    const F cosine = set(0) - dot(set(t.axis), l);
    const F lobe = power(clamp01(cosine), static_cast<int>(c.sixteenths));
    share = choose(cosine >= set(c.cutoff), share * lobe, set(0));
  }
  return {l, share};
}

struct ClassicSurface {
  V3 base;    ///< display values, as all colours here
  V3 normal;  ///< unit, towards the viewer
  F specular, sixteenths, emission;
  V3 texel;  ///< of the texture
};

/// Display values at (px, py), px, for the surface at reversed depth `depth`.
RASTRUM_LANES V3 classic_light(const LightSet& lights, const ViewRays& rays,
                               const ClassicSurface& s, F px, F py, F depth) {
  const V3 away = set(rays.d) + set(rays.dx) * px + set(rays.dy) * py;
  const V3 v = away * (set(0) - set(1) / square_root(dot(away, away)));
  const V3 n = s.normal, place = lights.has_places ? place_of(lights, px, py, depth) : v;
  V3 lit = s.base * (from_around(lights, n) + V3{s.emission, s.emission, s.emission});
  V3 more = set(Vec3{});
  for (const LightTerm& t : lights.terms) {
    const Arriving a = classic_arriving(t, place);
    const F nl = at_least(dot(n, a.to_light), 0);
    F shine = set(0);
    if (const auto mirrors = both(nl > set(0), s.specular > set(0)); !none(mirrors)) {
      const V3 sum = v + a.to_light;
      const V3 half = sum * (set(1) / square_root(at_least(dot(sum, sum), 1e-12F)));
      shine = choose(mirrors, power(clamp01(dot(n, half)), s.sixteenths) * s.specular, shine);
    }
    const V3 own = (s.base * (set(t.classic.ambient) + set(t.classic.diffuse) * nl) +
                    set(t.classic.specular) * shine) *
                   a.share;
    if (t.shadow.empty()) {
      lit = lit + own;
      continue;
    }
    const V3 seen = unshadowed(t, V3{clamp01(own.x), clamp01(own.y), clamp01(own.z)}, place, n, nl);
    more = more + choose(nl > set(0), seen, set(Vec3{}));
  }
  const V3 all = (V3{clamp01(lit.x), clamp01(lit.y), clamp01(lit.z)} + more) * s.texel;
  return {clamp01(all.x), clamp01(all.y), clamp01(all.z)};
}
