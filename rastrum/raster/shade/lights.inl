// SPDX-License-Identifier: BSD-3-Clause
// Light from a frame's lights (LightSet) at a point. One body in lanes (lights-inl.hpp) or one
// float (lights_scalar.hpp), so the bits are the same.

/// NaN gives the bound.
RASTRUM_LANES F at_least(F a, float bound) {
  return choose(a > set(bound), a, set(bound));
}
RASTRUM_LANES F at_most(F a, float bound) {
  return choose(a < set(bound), a, set(bound));
}
RASTRUM_LANES F clamp01(F a) {
  return at_most(at_least(a, 0), 1);
}

RASTRUM_LANES F on_plane(const PixelPlane& p, F px, F py, F depth) {
  return set(p.constant) + set(p.x) * px + set(p.y) * py + set(p.depth) * depth;
}
/// The place of the surface with reversed depth `depth` at (px, py).
RASTRUM_LANES V3 place_of(const LightSet& lights, F px, F py, F depth) {
  const F scale = set(1) / on_plane(lights.w, px, py, depth);
  return V3{on_plane(lights.x, px, py, depth), on_plane(lights.y, px, py, depth),
            on_plane(lights.z, px, py, depth)} *
         scale;
}

/// Light from all around that a surface with normal `n` gathers.
RASTRUM_LANES V3 from_around(const LightSet& lights, const V3& n) {
  return set(lights.ambient) + set(lights.rise_x) * n.x + set(lights.rise_y) * n.y +
         set(lights.rise_z) * n.z;
}

/// Light that a matt surface with unit normal `n` gathers from all around. Opposite a small bright
/// lamp the environments' bands fall below 0 and are clamped.
RASTRUM_LANES V3 gathered(const LightSet& lights, const V3& n) {
  V3 sum = from_around(lights, n);
  if (lights.surroundings.empty()) return sum;
  const GatheredLight& g = lights.gathered;
  const V3 bands =
      set(g.mean) + set(g.rise[0]) * n.x + set(g.rise[1]) * n.y + set(g.rise[2]) * n.z +
      set(g.bend[0]) * (n.x * n.x) + set(g.bend[1]) * (n.y * n.y) + set(g.bend[2]) * (n.z * n.z) +
      set(g.bend[3]) * (n.x * n.y) + set(g.bend[4]) * (n.y * n.z) + set(g.bend[5]) * (n.z * n.x);
  return sum + V3{at_least(bands.x, 0), at_least(bands.y, 0), at_least(bands.z, 0)};
}
/// Light from direction `d` that a surface mirrors; roughness in [0, 1].
RASTRUM_LANES V3 mirrored_around(const LightSet& lights, const V3& d, F roughness) {
  V3 sum = from_around(lights, d);
  for (const Surrounding& s : lights.surroundings) sum = sum + lane_by_lane(s, d, roughness);
  return sum;
}

struct Arriving {
  V3 to_light;  ///< of unit length
  F share;      ///< of the light
};
RASTRUM_LANES Arriving arriving(const LightTerm& t, const V3& place) {
  if (t.kind == LightTerm::Kind::directional) return {set(t.place), set(1)};
  const V3 away = set(t.place) - place;
  const F square = at_least(dot(away, away), 1e-12F);
  const V3 l = away * (set(1) / square_root(square));
  const F reach = square * set(t.inv_range2);
  F share = at_least(set(1) - reach * reach, 0) / square;
  if (t.kind == LightTerm::Kind::spot) {
    const F cone = clamp01(dot(set(t.axis), l) * set(-t.cone_scale) + set(t.cone_offset));
    share = share * (cone * cone);
  }
  return {l, share};
}

struct Incoming {
  V3 to_light;  ///< of unit length
  V3 radiance;
};
RASTRUM_LANES Incoming incoming(const LightTerm& t, const V3& place) {
  if (t.kind == LightTerm::Kind::directional) return {set(t.place), set(t.radiance)};
  const Arriving a = arriving(t, place);
  return {a.to_light, set(t.radiance) * a.share};
}

RASTRUM_LANES F on(const Vec4& r, const V3& p) {
  return set(r.x) * p.x + set(r.y) * p.y + set(r.z) * p.z + set(r.w);
}
/// The share of a light that reaches a place with unit normal `n`, in [0, 1]: the share of 4 × 4
/// texels that are not nearer to the light, weighted as a square of 3 × 3, in the first of `maps`
/// that contains them all. A place outside of all maps, or a NaN, is lit.
RASTRUM_LANES F lit_share(std::span<const ShadowMap> maps, const V3& place, const V3& n) {
  const F one = set(1), zero = set(0);
  F share = one, asks = one;  // asks: 0 once a map has given the share
  for (const ShadowMap& map : maps) {
    const V3 p = place + n * (set(map.offset) * on(map.w, place));
    const F scale = one / on(map.w, p);
    const F u = on(map.column, p) * scale - set(0.5F), v = on(map.row, p) * scale - set(0.5F);
    const F d = on(map.z, p) * scale;
    const F last_u = set(static_cast<float>(map.width - 3));
    const F last_v = set(static_cast<float>(map.height - 3));
    const auto across_it = both(both(scale > zero, u >= one), u < last_u);
    const auto in_it = both(across_it, both(v >= one, v < last_v));
    const auto inside = both(in_it, asks > zero);
    if (none(inside)) continue;
    // Lanes outside read the map's first texel.
    const F safe_u = choose(inside, u, one), safe_v = choose(inside, v, one);
    const Whole x = truncated(safe_u), y = truncated(safe_v);
    const F fx = safe_u - as_float(x), fy = safe_v - as_float(y);
    const F across[4] = {one - fx, one, one, fx}, down[4] = {one - fy, one, one, fy};
    Whole texel = times_plus(plus(y, -1), map.width, plus(x, -1));
    F sum = zero;
    for (int j = 0; j < 4; ++j) {
      F line = zero;
      for (int i = 0; i < 4; ++i)
        line = line + choose(looked_up(map.depth, plus(texel, i)) > d, zero, across[i]);
      sum = sum + line * down[j];
      texel = plus(texel, map.width);
    }
    share = choose(inside, sum * set(1.0F / 9), share);
    asks = choose(inside, zero, asks);
    if (none(asks > zero)) break;
  }
  return share;
}
/// `radiance` without its shadowed part, at a surface with unit normal `n` on the visible side.
/// `n_l`: the part of the light that it takes; at 0 the result does not matter.
RASTRUM_LANES V3 unshadowed(const LightTerm& t, const V3& radiance, const V3& place, const V3& n,
                            F n_l) {
  if (t.shadow.empty() || none(n_l > set(0))) return radiance;
  return radiance * lit_share(t.shadow, place, n);
}
