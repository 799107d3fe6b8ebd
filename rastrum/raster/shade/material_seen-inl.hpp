// The triangles that a block sees, set up for materials a lane each: as MaterialTriangle
// (material_triangle.hpp) and its kin do for one, but for kLanes at once, by the same operations in
// the same order, so it gives the same bits. Pixels then look their triangle's lane up. Triangles
// whose arrays are no packed lists, copies and clipped triangles are set up one by one.
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
#include <rastrum/raster/shade/seen_triangles-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

using HalfF32 = hn::Half<F32>;
constexpr std::size_t kHalf = kLanes / 2;

/// kLanes numbers of float64.
struct Wide {
  D lower, upper;
};
HWY_INLINE Wide load_wide(const double* p) {
  return {hn::Load(F64{}, p), hn::Load(F64{}, p + kHalf)};
}
HWY_INLINE void store(const Wide& v, double* p) {
  hn::Store(v.lower, F64{}, p);
  hn::Store(v.upper, F64{}, p + kHalf);
}
HWY_INLINE Wide wide(double v) {
  return {hn::Set(F64{}, v), hn::Set(F64{}, v)};
}
HWY_INLINE Wide wide(F v) {
  return {hn::PromoteTo(F64{}, hn::LowerHalf(HalfF32{}, v)),
          hn::PromoteTo(F64{}, hn::UpperHalf(HalfF32{}, v))};
}
HWY_INLINE Wide wide(I v) {
  const hn::Half<I32> half;
  return {hn::PromoteTo(F64{}, hn::LowerHalf(half, v)),
          hn::PromoteTo(F64{}, hn::UpperHalf(half, v))};
}
HWY_INLINE F rounded(const Wide& v) {
  return hn::Combine(F32{}, hn::DemoteTo(HalfF32{}, v.upper), hn::DemoteTo(HalfF32{}, v.lower));
}
HWY_INLINE Wide operator+(const Wide& a, const Wide& b) {
  return {a.lower + b.lower, a.upper + b.upper};
}
HWY_INLINE Wide operator-(const Wide& a, const Wide& b) {
  return {a.lower - b.lower, a.upper - b.upper};
}
HWY_INLINE Wide operator-(const Wide& a) {
  return {hn::Neg(a.lower), hn::Neg(a.upper)};
}
HWY_INLINE Wide operator*(const Wide& a, const Wide& b) {
  return {a.lower * b.lower, a.upper * b.upper};
}
HWY_INLINE Wide operator/(const Wide& a, const Wide& b) {
  return {a.lower / b.lower, a.upper / b.upper};
}

HWY_INLINE V3 load(const float (&v)[3][kLanes]) {
  return {hn::Load(F32{}, v[0]), hn::Load(F32{}, v[1]), hn::Load(F32{}, v[2])};
}
HWY_INLINE void store(const V3& v, float (&to)[3][kLanes]) {
  hn::Store(v.x, F32{}, to[0]);
  hn::Store(v.y, F32{}, to[1]);
  hn::Store(v.z, F32{}, to[2]);
}
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

/// MaterialTriangle by lane, with the attributes of its corners: those of corner 0, and how much
/// more the others have.
struct MaterialLanes {
  /// WeightPlanes, in pairs that pixels look up together: p[c] is kP + 3 c, and so on.
  enum Plane : std::size_t { kX0, kY0, kP, kQ, kR, kPlanes = kP + 9 };
  HWY_ALIGN double planes[kPlanes + 1][kLanes];
  HWY_ALIGN float face[3][kLanes];
  HWY_ALIGN float normal[3][3][kLanes];
  HWY_ALIGN float color[3][3][kLanes];
  HWY_ALIGN float u[3][kLanes], v[3][kLanes];
  HWY_ALIGN float right[3][kLanes], up[3][kLanes];  ///< TangentFrame
  const BoundMaterial* material[kLanes];
  std::uint64_t with_normals, with_texcoords, with_colors;  ///< lanes that have some
};

/// Where the corners of a lane's triangle are read.
struct MaterialSources {
  const float* vertex[3][kLanes];    ///< ProjectedVertex
  const float* position[3][kLanes];  ///< 16 bytes may be read, as of the next
  const float* normal[3][kLanes];
  const MaterialDraw* draw[kLanes];
  std::uint64_t asked;  ///< lanes that are set up one by one
  /// Copies of the last values of arrays, behind which nothing may be read.
  alignas(16) float own_position[3][kLanes][4];
  alignas(16) float own_normal[3][kLanes][4];
};

/// Finds the material and the arrays of one triangle after another, whose draws are mostly the
/// same.
class MaterialOfTriangle {
 public:
  HWY_INLINE MaterialOfTriangle(const MaterialView& scene, const FrameGeometry& frame)
      : scene_(scene), frame_(frame) {}

  /// Asks the cache for the indices of triangle `low`, which say what else is read.
  HWY_INLINE void prefetch(std::uint64_t low) {
    const std::uint64_t corner = 3 * find(low);
    if (!simple_) return;
    __builtin_prefetch(indices_ + corner);
    if (normals_.indices != indices_) __builtin_prefetch(normals_.indices + corner);
    if (texcoords_.indices != indices_) __builtin_prefetch(texcoords_.indices + corner);
  }
  /// Finds where triangle `low` is read, and sets all that is not fetched in lanes.
  HWY_INLINE void find_sources(std::uint64_t low, std::size_t lane, MaterialSources& from,
                               MaterialLanes& out) {
    const std::uint64_t t = find(low);
    const std::uint64_t bit = std::uint64_t{1} << lane;
    if (!simple_) {
      from.asked |= bit;
      // Any place that may be read.
      for (int c = 0; c < 3; ++c)
        from.vertex[c][lane] = from.position[c][lane] = from.normal[c][lane] = kNothing;
      from.draw[lane] = draw_of_material_;
      return;
    }
    const std::uint32_t* const vertex = indices_ + 3 * t;
    for (std::size_t c = 0; c < 3; ++c) {
      from.vertex[c][lane] = reinterpret_cast<const float*>(projected_ + vertex[c]);
      from.position[c][lane] = positions_.at(vertex[c], from.own_position[c][lane]);
    }
    from.draw[lane] = draw_of_material_;
    out.material[lane] = &scene_.material_of(*draw_of_material_, t);
    if (normals_.data != nullptr) {
      out.with_normals |= bit;
      for (std::size_t c = 0; c < 3; ++c)
        from.normal[c][lane] = normals_.at(normals_.indices[3 * t + c], from.own_normal[c][lane]);
    } else {
      for (int c = 0; c < 3; ++c) from.normal[c][lane] = kNothing;
    }
    if (texcoords_.data != nullptr) {
      out.with_texcoords |= bit;
      for (std::size_t c = 0; c < 3; ++c) {
        const float* const at = texcoords_.data + std::size_t{2} * texcoords_.indices[3 * t + c];
        out.u[c][lane] = at[0];
        out.v[c][lane] = at[1];
      }
    } else {
      for (int c = 0; c < 3; ++c) out.u[c][lane] = out.v[c][lane] = 0;
    }
    if (!draw_of_material_->colors.empty()) {
      out.with_colors |= bit;
      const std::uint32_t vertices[3] = {vertex[0], vertex[1], vertex[2]};
      Vec4 color[3];
      linear_colors(*draw_of_material_, scene_.curve, {{3 * t, 3 * t + 1, 3 * t + 2}, t}, vertices,
                    color);
      set_colors(color, *out.material[lane], lane, out);
    }
  }
  /// Sets up all of a triangle that is not read in lanes.
  HWY_NOINLINE void ask(std::uint64_t low, std::size_t lane, MaterialLanes& out) {
    (void)find(low);
    const std::uint64_t id = kIdMask - low;
    const MaterialTriangle t(scene_, frame_, *draw_, id);
    const std::uint64_t bit = std::uint64_t{1} << lane;
    out.planes[MaterialLanes::kX0][lane] = t.planes.x0;
    out.planes[MaterialLanes::kY0][lane] = t.planes.y0;
    for (std::size_t c = 0; c < 3; ++c) {
      out.planes[MaterialLanes::kP + 3 * c][lane] = t.planes.p[c];
      out.planes[MaterialLanes::kQ + 3 * c][lane] = t.planes.q[c];
      out.planes[MaterialLanes::kR + 3 * c][lane] = t.planes.r[c];
    }
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

  /// An attribute that is simple to read.
  struct Values {
    const float* data = nullptr;  ///< null: there is none
    const std::uint32_t* indices = nullptr;
    std::size_t last = 0;

    [[nodiscard]] HWY_INLINE const float* at(std::size_t i, float (&own)[4]) const {
      if (i != last) return data + i * 3;
      std::copy_n(data + i * 3, 3, own);
      return own;
    }
  };

  /// Returns the number of triangle `low` in its draw.
  HWY_INLINE std::uint64_t find(std::uint64_t low) {
    const std::uint64_t id = kIdMask - low;
    if (draw_ == nullptr || id - draw_->first_id >= draw_->primitive_count) look_at(id);
    return id - draw_->first_id;
  }
  HWY_NOINLINE void look_at(std::uint64_t id) {
    draw_ = &frame_.draw_of(id);
    draw_of_material_ = &scene_.draws[draw_->number];
    projected_ = frame_.projected_of(*draw_);
    simple_ = false;
    if (projected_ == nullptr || draw_->mesh != nullptr || draw_->indices.empty() ||
        draw_->is_copied())
      return;
    const MeshView& mesh = *draw_of_material_->mesh;
    if (!mesh.positions.is_packed()) return;
    indices_ = draw_->indices.data();
    positions_ = {&mesh.positions.data()->x, nullptr, mesh.positions.size() - 1};
    simple_ = look_at(mesh.normals, normals_) && look_at(mesh.texcoords, texcoords_);
  }
  /// Returns whether the attribute is simple to read.
  template <class T>
  HWY_INLINE bool look_at(const AttributeView<T>& attribute, Values& out) {
    out = {nullptr, indices_, 0};
    if (attribute.empty()) return true;
    const bool is_indexed = !attribute.indices.empty();
    if (!attribute.values.is_packed()) return false;
    if (is_indexed ? !attribute.indices.is_packed() : attribute.per != Per::vertex) return false;
    if (is_indexed) out.indices = attribute.indices.data();
    out.data = &attribute.values.data()->x;
    out.last = attribute.values.size() - 1;
    return true;
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
  const FrameGeometry& frame_;
  const Draw* draw_ = nullptr;
  const MaterialDraw* draw_of_material_ = nullptr;
  bool simple_ = false;  ///< it is read by the pointers that follow
  const ProjectedVertex* projected_ = nullptr;
  const std::uint32_t* indices_ = nullptr;
  Values positions_, normals_, texcoords_;
};

/// weight_planes. Returns the lanes of triangles that were clipped, whose planes are not valid.
HWY_INLINE std::uint64_t set_planes(const MaterialSources& from, std::size_t n,
                                    MaterialLanes& out) {
  const I32 di;
  const V4 v0 = load_transposed(from.vertex[0], n);
  const V4 v1 = load_transposed(from.vertex[1], n);
  const V4 v2 = load_transposed(from.vertex[2], n);
  const auto whole = [&](F v) HWY_ATTR { return hn::BitCast(di, v); };
  const I needs_clip = hn::Set(di, kNeedsClip);
  const auto is_clipped = [&](F x) HWY_ATTR {
    return hn::RebindMask(F32{}, hn::Eq(whole(x), needs_clip));
  };
  const std::uint64_t clipped =
      bits_of(hn::Or(is_clipped(v0.x), hn::Or(is_clipped(v1.x), is_clipped(v2.x))));
  const Wide px = wide(1.0 / kSubpixels);
  const auto along = [&](F to, F begin)
                         HWY_ATTR { return wide(hn::Sub(whole(to), whole(begin))) * px; };
  const Wide e1x = along(v1.x, v0.x), e1y = along(v1.y, v0.y);
  const Wide e2x = along(v2.x, v0.x), e2y = along(v2.y, v0.y);
  const Wide inv_det = wide(1.0) / (e1x * e2y - e2x * e1y);
  store(wide(whole(v0.x)) * px, out.planes[MaterialLanes::kX0]);
  store(wide(whole(v0.y)) * px, out.planes[MaterialLanes::kY0]);
  const Wide p1 = e2y * inv_det, q1 = -e2x * inv_det;
  const Wide p2 = -e1y * inv_det, q2 = e1x * inv_det;
  const Wide w0 = wide(v0.w), w1 = wide(v1.w), w2 = wide(v2.w), none = wide(0.0);
  const auto put = [&](std::size_t c, const Wide& p, const Wide& q, const Wide& r) HWY_ATTR {
    store(p, out.planes[MaterialLanes::kP + 3 * c]);
    store(q, out.planes[MaterialLanes::kQ + 3 * c]);
    store(r, out.planes[MaterialLanes::kR + 3 * c]);
  };
  put(0, -(p1 + p2) * w0, -(q1 + q2) * w0, w0);
  put(1, p1 * w1, q1 * w1, none);
  put(2, p2 * w2, q2 * w2, none);
  return clipped;
}

/// Calls use(draw, lanes that are of it) for the draws of n lanes.
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

/// Finds where triangles low[0, n) are read, 0 < n ≤ kLanes.
HWY_INLINE void find_sources(MaterialOfTriangle& of, const std::uint64_t* low, std::size_t n,
                             MaterialSources& from, MaterialLanes& out) {
  from.asked = 0;
  out.with_normals = out.with_texcoords = out.with_colors = 0;
  for (std::size_t i = 0; i < n; ++i) of.find_sources(low[i], i, from, out);
}

/// Sets up triangles low[0, n), whose sources have been found. `end`: so many lanes are read, n or
/// some more.
HWY_INLINE void set_triangles(MaterialOfTriangle& of, const std::uint64_t* low, std::size_t n,
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
    asked |= set_planes(from, end, out) & all;
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
    of.ask(low[lane], lane, out);
  }
}

/// Looks up values of triangles' lanes; `lane`: that of each pixel's triangle.
struct MaterialLookup {
  using WideIndices = decltype(hn::IndicesFromVec(F64{}, hn::Zero(I64{})));
  decltype(hn::IndicesFromVec(F32{}, hn::Zero(I32{}))) lane;
  WideIndices lower, upper;
  hn::Mask<F64> lower_is_far, upper_is_far;  ///< of the second half of the triangles

  explicit HWY_INLINE MaterialLookup(I place)
      : lane(hn::IndicesFromVec(F32{}, place)),
        lower(of_half(wide_place(place, false))),
        upper(of_half(wide_place(place, true))),
        lower_is_far(is_far(wide_place(place, false))),
        upper_is_far(is_far(wide_place(place, true))) {}

  HWY_INLINE F operator()(const float* values) const {
    return hn::TableLookupLanes(hn::Load(F32{}, values), lane);
  }
  /// Looks up `bits`, one for each triangle's lane.
  [[nodiscard]] HWY_INLINE hn::Mask<F32> of(std::uint64_t bits) const {
    const F is = choose_or_zero(mask_of(bits), set(1));
    return hn::TableLookupLanes(is, lane) > set(0);
  }
  HWY_INLINE V3 operator()(const float (&v)[3][kLanes]) const {
    return {(*this)(v[0]), (*this)(v[1]), (*this)(v[2])};
  }
  HWY_INLINE Wide operator()(const double* values) const {
    const D near = hn::Load(F64{}, values), far = hn::Load(F64{}, values + kHalf);
    return {hn::IfThenElse(lower_is_far, hn::TableLookupLanes(far, lower),
                           hn::TableLookupLanes(near, lower)),
            hn::IfThenElse(upper_is_far, hn::TableLookupLanes(far, upper),
                           hn::TableLookupLanes(near, upper))};
  }

 private:
  static HWY_INLINE hn::Vec<I64> wide_place(I place, bool is_upper) {
    const hn::Half<I32> half;
    return hn::PromoteTo(I64{}, is_upper ? hn::UpperHalf(half, place) : hn::LowerHalf(half, place));
  }
  static HWY_INLINE WideIndices of_half(hn::Vec<I64> place) {
    return hn::IndicesFromVec(F64{},
                              hn::And(place, hn::Set(I64{}, static_cast<std::int64_t>(kHalf - 1))));
  }
  static HWY_INLINE hn::Mask<F64> is_far(hn::Vec<I64> place) {
    return hn::RebindMask(F64{},
                          hn::Gt(place, hn::Set(I64{}, static_cast<std::int64_t>(kHalf - 1))));
  }
};

/// Two numbers of each of kLanes triangles.
struct WidePair {
  Wide first, second;
};

/// Looks up values of the lanes of `t` at pixels, as BinLookup does (material_bin-inl.hpp).
struct LaneLookup {
  const MaterialLanes& t;
  const MaterialLookup& look;

  template <std::size_t kFirst>
  [[nodiscard]] HWY_INLINE WidePair planes() const {
    return {look(t.planes[kFirst]), look(t.planes[kFirst + 1])};
  }
  [[nodiscard]] HWY_INLINE V3 face() const { return look(t.face); }
  [[nodiscard]] HWY_INLINE bool some_normals() const { return t.with_normals != 0; }
  [[nodiscard]] HWY_INLINE bool some_colors() const { return t.with_colors != 0; }
  [[nodiscard]] HWY_INLINE hn::Mask<F32> with_normals() const { return look.of(t.with_normals); }
  [[nodiscard]] HWY_INLINE hn::Mask<F32> with_colors() const { return look.of(t.with_colors); }
  HWY_INLINE void normals(V3 (&of)[3]) const {
    for (int i = 0; i < 3; ++i) of[i] = look(t.normal[i]);
  }
  HWY_INLINE void colors(V3 (&of)[3]) const {
    for (int i = 0; i < 3; ++i) of[i] = look(t.color[i]);
  }
  HWY_INLINE void coordinates(V3& u, V3& v) const {
    u = look(t.u);
    v = look(t.v);
  }
};

/// CornerShares of kLanes pixels.
struct LaneShares {
  Wide scale;
  F weight1, weight2;

  /// At pixels whose samples lie at (x, y), px.
  template <class From>
  HWY_INLINE LaneShares(const From& from, const Wide& x, const Wide& y) {
    using M = MaterialLanes;
    const WidePair origin = from.template planes<M::kX0>();
    const Wide dx = x - origin.first, dy = y - origin.second;
    const WidePair pq0 = from.template planes<M::kP>();
    const WidePair r0p1 = from.template planes<M::kP + 2>();
    const WidePair q1r1 = from.template planes<M::kP + 4>();
    const WidePair pq2 = from.template planes<M::kP + 6>();
    const Wide r2 = from.template planes<M::kP + 8>().first;
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
