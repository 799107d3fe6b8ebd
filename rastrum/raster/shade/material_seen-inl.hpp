// SPDX-License-Identifier: BSD-3-Clause
// Sets up the triangles that a block sees for materials, one a lane, with the operations and bits
// of MaterialTriangle and the like (material_triangle.hpp). Pixels look up their triangle's lane.
// Copies, clipped triangles and those whose arrays lanes cannot read (PackedValues) are set up one
// by one.
#if defined(RASTRUM_RASTER_SHADE_MATERIAL_SEEN_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_SHADE_MATERIAL_SEEN_INL_HPP
#undef RASTRUM_RASTER_SHADE_MATERIAL_SEEN_INL_HPP
#else
#define RASTRUM_RASTER_SHADE_MATERIAL_SEEN_INL_HPP
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>

#include <rastrum/raster/shade/material_triangle.hpp>
#include <rastrum/raster/surface/sources-inl.hpp>
#include <rastrum/raster/surface/weights-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

HWY_INLINE V3 cross(const V3& a, const V3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// normalize of vec.hpp.
HWY_INLINE V3 normalized(const V3& v) {
  const F l = square_root(dot(v, v));
  return choose(l > set(0), v * (set(1) / l), v);
}
/// times of material_triangle.hpp.
HWY_INLINE V3 turned_by(const float (&m)[3][3], const V3& v) {
  const auto row = [&](int i) HWY_ATTR {
    return set(m[i][0]) * v.x + set(m[i][1]) * v.y + set(m[i][2]) * v.z;
  };
  return {row(0), row(1), row(2)};
}

/// MaterialTriangle by lane. Attributes have corner 0's value and the differences of the other
/// corners.
struct MaterialLanes {
  PlaneTable<kLanes> planes;
  HWY_ALIGN float face[3][kLanes];
  HWY_ALIGN float normal[3][3][kLanes];
  HWY_ALIGN float color[3][3][kLanes];
  HWY_ALIGN float u[3][kLanes], v[3][kLanes];
  HWY_ALIGN float right[3][kLanes], up[3][kLanes];  ///< TangentFrame
  const BoundMaterial* material[kLanes];
  std::uint64_t with_normals, with_texcoords, with_colors;  ///< lanes that have some
};

struct MaterialSources : CornerSources {
  const MaterialDraw* draw[kLanes];
  std::uint64_t asked;  ///< lanes that are set up one by one
};

/// Finds the material and the arrays of triangles in sequence.
class MaterialOfTriangle : DrawFinder<MaterialDraw> {
 public:
  HWY_INLINE MaterialOfTriangle(const MaterialView& scene, const FrameGeometry& frame)
      : DrawFinder(frame), scene_(scene) {}

  /// Prefetches the indices of triangle `low`, which say what else is read.
  HWY_INLINE void prefetch(std::uint64_t low) {
    const std::uint64_t corner = 3 * find(low);
    prefetch_indices(corner);
    normals_.prefetch(corner);
    texcoords_.prefetch(corner);
  }
  /// Finds where triangle `low` is read, and sets what is not fetched in lanes.
  HWY_INLINE void find_sources(std::uint64_t low, std::size_t lane, MaterialSources& from,
                               MaterialLanes& out) {
    const std::uint64_t t = find(low);
    const std::uint64_t bit = std::uint64_t{1} << lane;
    from.draw[lane] = look_;
    if (!simple_) {
      from.asked |= bit;
      // Any readable address.
      for (int c = 0; c < 3; ++c)
        from.vertex[c][lane] = from.position[c][lane] = from.normal[c][lane] = kNothing;
      return;
    }
    std::uint32_t vertex[3];
    vertices(3 * t, vertex);
    out.material[lane] = &scene_.material_of(*look_, t);
    out.with_normals |= std::uint64_t{normals_.data != nullptr} << lane;
    out.with_texcoords |= std::uint64_t{texcoords_.data != nullptr} << lane;
    for (std::size_t c = 0; c < 3; ++c) {
      from.vertex[c][lane] = projected(vertex[c]);
      from.position[c][lane] = positions_.at(vertex[c], from.place_copy[c][lane]);
      from.normal[c][lane] =
          normals_.data == nullptr
              ? kNothing
              : normals_.at(normals_.number(3 * t + c, vertex[c]), from.normal_copy[c][lane]);
      const float* const at =
          texcoords_.data == nullptr
              ? kNothing
              : texcoords_.data + std::size_t{2} * texcoords_.number(3 * t + c, vertex[c]);
      out.u[c][lane] = at[0];
      out.v[c][lane] = at[1];
    }
    if (!look_->colors.empty()) {
      out.with_colors |= bit;
      Vec4 color[3];
      const auto face = static_cast<std::size_t>(t);
      shown_colors(*look_, scene_, {{3 * face, 3 * face + 1, 3 * face + 2}, face}, vertex, color);
      set_colors(color, *out.material[lane], lane, out);
    }
  }
  /// Sets up a triangle that lanes cannot read.
  HWY_NOINLINE void ask(std::uint64_t low, std::size_t lane, MaterialLanes& out) {
    (void)find(low);
    const MaterialTriangle t(scene_, frame_, *draw_, kIdMask - low);
    const std::uint64_t bit = std::uint64_t{1} << lane;
    out.planes.set(lane, t.planes);
    const BoundMaterial& material = scene_.material_of(t.draw, t.index);
    out.material[lane] = &material;
    set(t.face_normal(), lane, out.face);
    const MeshView& mesh = *t.draw.mesh;
    out.with_normals &= ~bit;
    if (!mesh.normals.empty()) {
      out.with_normals |= bit;
      Vec3 n[3];
      t.normals(n);
      set(n[0], lane, out.normal[0]);
      set(n[1] - n[0], lane, out.normal[1]);
      set(n[2] - n[0], lane, out.normal[2]);
    }
    out.with_colors &= ~bit;
    if (!t.draw.colors.empty()) {
      out.with_colors |= bit;
      Vec4 color[3];
      t.colors(color);
      set_colors(color, material, lane, out);
    }
    Vec2 at[3] = {};
    if (!mesh.texcoords.empty()) t.corners(mesh.texcoords, at);
    out.u[0][lane] = at[0].x;
    out.v[0][lane] = at[0].y;
    for (int c = 1; c < 3; ++c) {
      out.u[c][lane] = at[c].x - at[0].x;
      out.v[c][lane] = at[c].y - at[0].y;
    }
    if (material.normal == nullptr) return;
    const TangentFrame tangents(t);
    set(tangents.right, lane, out.right);
    set(tangents.up, lane, out.up);
  }

 private:
  alignas(16) static constexpr float kNothing[4] = {};

  /// The number of triangle `low` in its draw.
  HWY_INLINE std::uint64_t find(std::uint64_t low) {
    const std::uint64_t id = kIdMask - low;
    if (is_other(id)) look_at(frame_.draw_of(id));
    return id - draw_->first_id;
  }
  HWY_NOINLINE void look_at(const Draw& draw) {
    simple_ = begin(draw, scene_.draws[draw.number]);
    normals_ = texcoords_ = {};
    if (!simple_) return;
    const MeshView& mesh = *look_->mesh;
    simple_ = mesh.positions.is_packed() && normals_.look_at(mesh.normals) &&
              texcoords_.look_at(mesh.texcoords);
    if (simple_) positions_ = {&mesh.positions.data()->x, nullptr, mesh.positions.size() - 1};
  }
  static HWY_INLINE void set(Vec3 v, std::size_t lane, float (&to)[3][kLanes]) {
    to[0][lane] = v.x;
    to[1][lane] = v.y;
    to[2][lane] = v.z;
  }
  static HWY_INLINE void set_colors(Vec4 (&color)[3], const BoundMaterial& material,
                                    std::size_t lane, MaterialLanes& out) {
    for (Vec4& c : color) c = c * material.base;
    set({color[0].x, color[0].y, color[0].z}, lane, out.color[0]);
    for (int c = 1; c < 3; ++c)
      set({color[c].x - color[0].x, color[c].y - color[0].y, color[c].z - color[0].z}, lane,
          out.color[c]);
  }

  const MaterialView& scene_;
  bool simple_ = false;  ///< lanes can read it
  PackedValues positions_, normals_, texcoords_;
};

/// Calls use(draw, its lanes) for the draws of n lanes.
template <class Use>
HWY_INLINE void for_each_draw(const MaterialSources& from, std::size_t n, const Use& use) {
  std::uint64_t rest = (std::uint64_t{1} << n) - 1;
  while (rest != 0) {
    const MaterialDraw* const draw = from.draw[std::countr_zero(rest)];
    std::uint64_t own = 0;
    for (std::size_t i = 0; i < n; ++i) own |= std::uint64_t{from.draw[i] == draw} << i;
    rest &= ~own;
    use(*draw, mask_of(own));
  }
}

/// Finds where triangles low[0, n), 0 < n ≤ kLanes, are read.
HWY_INLINE void find_sources(MaterialOfTriangle& finder, const std::uint64_t* low, std::size_t n,
                             MaterialSources& from, MaterialLanes& out) {
  from.asked = 0;
  out.with_normals = out.with_texcoords = out.with_colors = 0;
  for (std::size_t i = 0; i < n; ++i) finder.find_sources(low[i], i, from, out);
}

/// Sets up triangles low[0, n), whose sources are found. `end` ≥ n: the lanes that are read.
HWY_INLINE void set_triangles(MaterialOfTriangle& finder, const std::uint64_t* low, std::size_t n,
                              std::size_t end, MaterialSources& from, MaterialLanes& out) {
  const F32 d;
  const std::uint64_t all = (std::uint64_t{1} << n) - 1;
  std::uint64_t asked = from.asked;
  if (asked != all) {
    for (std::size_t i = n; i < end || i % 4 != 0; ++i)
      for (int c = 0; c < 3; ++c) {
        from.vertex[c][i] = from.vertex[c][0];
        from.position[c][i] = from.position[c][0];
        from.normal[c][i] = from.normal[c][0];
      }
    const ProjectedCorners projected(from.vertex, end);
    asked |= projected.clipped() & all;
    set_planes(projected, out.planes);
    V3 corner[3];
    for (int c = 0; c < 3; ++c) {
      const V4 v = load_transposed(from.position[c], end);
      corner[c] = {v.x, v.y, v.z};
    }
    const V3 e1 = corner[1] - corner[0], e2 = corner[2] - corner[0];
    const V3 across = cross(e1, e2);
    V3 face = across;
    for_each_draw(from, n, [&](const MaterialDraw& draw, auto own) HWY_ATTR {
      face = choose(own, turned_by(draw.normal_matrix, across), face);
    });
    store(normalized(face), out.face);
    if (out.with_normals != 0) {
      V3 normal[3];
      for (int c = 0; c < 3; ++c) {
        const V4 v = load_transposed(from.normal[c], end);
        normal[c] = {v.x, v.y, v.z};
        const F sum = hn::Abs(v.x) + hn::Abs(v.y) + hn::Abs(v.z);
        const auto says = hn::And(sum > set(0), sum < set(std::numeric_limits<float>::infinity()));
        asked |= ~bits_of(says) & out.with_normals & all;  // to be filled in
      }
      for_each_draw(from, n, [&](const MaterialDraw& draw, auto own) HWY_ATTR {
        for (V3& v : normal) v = choose(own, turned_by(draw.normal_matrix, v), v);
      });
      store(normal[0], out.normal[0]);
      store(normal[1] - normal[0], out.normal[1]);
      store(normal[2] - normal[0], out.normal[2]);
    }
    const auto more = [&](float(&at)[3][kLanes]) HWY_ATTR {
      const V3 v = load(at);
      store({v.x, v.y - v.x, v.z - v.x}, at);
    };
    more(out.u);
    more(out.v);
    bool bent = false;
    for (std::size_t i = 0; i < n; ++i)
      bent |= (from.asked >> i & 1) == 0 && out.material[i]->normal != nullptr;
    if (bent) {  // TangentFrame
      V3 t1 = e1, t2 = e2;
      for_each_draw(from, n, [&](const MaterialDraw& draw, auto own) HWY_ATTR {
        t1 = choose(own, turned_by(draw.to_world, e1), t1);
        t2 = choose(own, turned_by(draw.to_world, e2), t2);
      });
      const F u1 = hn::Load(d, out.u[1]), u2 = hn::Load(d, out.u[2]);
      const F v1 = hn::Load(d, out.v[1]), v2 = hn::Load(d, out.v[2]);
      const F sign = choose(u1 * v2 - u2 * v1 < set(0), set(-1), set(1));
      const auto has = mask_of(out.with_texcoords);
      const V3 none = set(Vec3{});
      store(choose(has, normalized((t1 * v2 - t2 * v1) * sign), none), out.right);
      store(choose(has, normalized((t1 * u2 - t2 * u1) * sign), none), out.up);
    }
  }
  for (; asked != 0; asked &= asked - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(asked));
    finder.ask(low[lane], lane, out);
  }
}

/// Looks up triangles' lanes; `place`: each pixel's lane.
struct MaterialLookup : WideLookup, FloatLookup {
  explicit HWY_INLINE MaterialLookup(I place)
      : WideLookup(place), FloatLookup{hn::IndicesFromVec(F32{}, place)} {}

  using FloatLookup::operator();
  using WideLookup::operator();
  /// Looks up `bits`, one a lane.
  [[nodiscard]] HWY_INLINE hn::Mask<F32> where(std::uint64_t bits) const {
    const F is = choose_or_zero(mask_of(bits), set(1));
    return hn::TableLookupLanes(is, lane) > set(0);
  }
};

struct WidePair {
  Wide first, second;
};

/// Looks up the lanes of `t` at pixels, as BinLookup (material_bin-inl.hpp).
struct LaneLookup {
  const MaterialLanes& t;
  const MaterialLookup& look;

  template <std::size_t kFirst>
  [[nodiscard]] HWY_INLINE WidePair planes() const {
    return {look(t.planes.number[kFirst]), look(t.planes.number[kFirst + 1])};
  }
  [[nodiscard]] HWY_INLINE V3 face() const { return look(t.face); }
  [[nodiscard]] HWY_INLINE bool some_normals() const { return t.with_normals != 0; }
  [[nodiscard]] HWY_INLINE bool some_colors() const { return t.with_colors != 0; }
  [[nodiscard]] HWY_INLINE hn::Mask<F32> with_normals() const { return look.where(t.with_normals); }
  [[nodiscard]] HWY_INLINE hn::Mask<F32> with_colors() const { return look.where(t.with_colors); }
  HWY_INLINE void normals(V3 (&corner)[3]) const {
    for (int i = 0; i < 3; ++i) corner[i] = look(t.normal[i]);
  }
  HWY_INLINE void colors(V3 (&corner)[3]) const {
    for (int i = 0; i < 3; ++i) corner[i] = look(t.color[i]);
  }
  HWY_INLINE void coordinates(V3& u, V3& v) const {
    u = look(t.u);
    v = look(t.v);
  }
};

struct LaneShares {
  Wide scale;
  F weight1, weight2;

  /// At the samples (x, y), px.
  template <class From>
  HWY_INLINE LaneShares(const From& from, const Wide& x, const Wide& y) {
    using P = PlaneTable<kLanes>;
    const WidePair origin = from.template planes<P::kX0>();
    const Wide dx = x - origin.first, dy = y - origin.second;
    const WidePair pq0 = from.template planes<P::kP>();
    const WidePair r0p1 = from.template planes<P::kP + 2>();
    const WidePair q1r1 = from.template planes<P::kP + 4>();
    const WidePair pq2 = from.template planes<P::kP + 6>();
    const Wide r2 = from.template planes<P::kP + 8>().first;
    const auto weight = [&](const Wide& p, const Wide& q, const Wide& r)
                            HWY_ATTR { return r + p * dx + q * dy; };
    const Wide b0 = weight(pq0.first, pq0.second, r0p1.first);
    const Wide b1 = weight(r0p1.second, q1r1.first, q1r1.second);
    const Wide b2 = weight(pq2.first, pq2.second, r2);
    scale = wide(1.0) / (b0 + b1 + b2);
    weight1 = rounded(b1 * scale);
    weight2 = rounded(b2 * scale);
  }
  [[nodiscard]] HWY_INLINE F offset(F d1, F d2) const { return weight1 * d1 + weight2 * d2; }
  [[nodiscard]] HWY_INLINE F at(F a0, F d1, F d2) const { return a0 + offset(d1, d2); }
  [[nodiscard]] HWY_INLINE V3 at(const V3 (&v)[3]) const {
    return {at(v[0].x, v[1].x, v[2].x), at(v[0].y, v[1].y, v[2].y), at(v[0].z, v[1].z, v[2].z)};
  }
};

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_SHADE_MATERIAL_SEEN_INL_HPP
