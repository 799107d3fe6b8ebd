// SPDX-License-Identifier: BSD-3-Clause
// Sets up the triangles that a block sees for shading, one a lane, with fetch_triangle's operations
// and bits (lit_triangle.hpp). Pixels look up their triangle's lane. The light is lit_light.inl.
#if defined(RASTRUM_RASTER_SHADE_LIT_SEEN_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_SHADE_LIT_SEEN_INL_HPP
#undef RASTRUM_RASTER_SHADE_LIT_SEEN_INL_HPP
#else
#define RASTRUM_RASTER_SHADE_LIT_SEEN_INL_HPP
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#include <hwy/highway.h>

#include <rastrum/raster/draws/interpolate.hpp>
#include <rastrum/raster/draws/shader_table.hpp>
#include <rastrum/raster/shade/lights-inl.hpp>
#include <rastrum/raster/shade/lit_constants.hpp>
#include <rastrum/raster/shade/lit_triangle.hpp>
#include <rastrum/raster/surface/sources-inl.hpp>
#include <rastrum/raster/surface/weights-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

#define RASTRUM_LANES HWY_INLINE
#include <rastrum/raster/shade/lit_light.inl>
#undef RASTRUM_LANES

/// Calls use(constant of the shader) if is_light(); returns whether it is.
template <class Use, std::size_t... kValues>
HWY_INLINE bool with_light(Shader shader, const Use& use, std::index_sequence<kValues...>) {
  const auto matches = [&](auto value) HWY_ATTR {
    constexpr auto kShader = static_cast<Shader>(decltype(value)::value);
    if constexpr (is_light(kShader)) {
      if (shader != kShader) return false;
      use(std::integral_constant<Shader, kShader>{});
      return true;
    }
    return false;
  };
  return (matches(std::integral_constant<std::size_t, kValues>{}) || ...);
}
template <class Use>
HWY_INLINE bool with_light(Shader shader, const Use& use) {
  return with_light(shader, use, std::make_index_sequence<kShaders.size()>{});
}

/// LitTriangle by lane.
struct LitLanes {
  HWY_ALIGN float x0[kLanes], y0[kLanes];
  HWY_ALIGN float p1[kLanes], q1[kLanes], p2[kLanes], q2[kLanes];
  HWY_ALIGN float inv_w[3][kLanes];
  HWY_ALIGN float normal[3][3][kLanes];  ///< corner, axis
  HWY_ALIGN float color[3][3][kLanes];
  std::uint64_t exact;  ///< lanes with the weights of LitTriangle::planes
};

/// Triangles kept from block to block: the next block mostly sees the same ones if they are large,
/// and others if they are small.
struct SeenLanes {
  static constexpr std::size_t kGroups = 64 / kLanes;
  SeenTriangles seen;
  std::uint64_t exact;  ///< a bit for each triangle
  LitLanes lanes[kGroups];

  [[nodiscard]] std::size_t groups() const { return (seen.count + kLanes - 1) / kLanes; }
};
static_assert(sizeof(SeenLanes) <= sizeof(KeptTriangles::lanes));

class LitOfTriangle;

/// The sources of a group, with what the lit shaders need besides.
struct LitSources : CornerSources {
  LitOfTriangle* finder;  ///< for attributes not read here
  const std::uint64_t* low;
  std::size_t count;             ///< their number; later lanes are unused
  const LitDraw* turns[kLanes];  ///< of turned lanes: its matrix takes normals to the world
  std::uint64_t turned;          ///< lanes whose normals are not in world space
  std::uint64_t finished;        ///< lanes whose normals are safe
  std::uint64_t flat;            ///< lanes with their plane's normal: they read positions
  bool wide;                     ///< positions are float64, three each
};

/// Finds the arrays of triangles in sequence.
class LitOfTriangle : DrawFinder<LitDraw> {
 public:
  HWY_INLINE LitOfTriangle(const LitScene& scene, const FrameGeometry& frame)
      : DrawFinder(frame), scene_(scene), view_(scene.view()) {}

  /// Prefetches the indices of triangle `low`, which say what else is read.
  HWY_INLINE void prefetch(std::uint64_t low) {
    const std::uint64_t corner = 3 * find(low);
    prefetch_indices(corner);
    normals_.prefetch(corner);
  }
  /// Finds where triangle `low` is read, and sets what is not fetched in lanes.
  HWY_INLINE void find_sources(std::uint64_t low, bool wants_normals, std::size_t lane,
                               LitSources& from, LitLanes& out) {
    const std::uint64_t t = find(low);
    const bool in_lanes = !wants_normals || normals_.data != nullptr || is_flat_;
    if (!is_list_ || !in_lanes) return ask_draw(t, wants_normals, lane, from, out);
    if (wants_normals && is_flat_) {
      // All positions of a group have one type.
      if (from.flat == 0) from.wide = is_wide_;
      if (from.wide != is_wide_) return ask_draw(t, wants_normals, lane, from, out);
    }
    std::uint32_t vertex[3];
    vertices(3 * t, vertex);
    for (std::size_t c = 0; c < 3; ++c) from.vertex[c][lane] = projected(vertex[c]);
    if (wants_normals && is_flat_) {
      const std::uint64_t bit = std::uint64_t{1} << lane;
      for (std::size_t c = 0; c < 3; ++c) {
        from.position[c][lane] = position(vertex[c], from.place_copy[c][lane]);
        from.normal[c][lane] = from.vertex[c][lane];  // read, but not used
      }
      from.flat |= bit;
      from.finished |= bit;
    } else if (wants_normals) {
      for (std::size_t c = 0; c < 3; ++c)
        from.normal[c][lane] =
            normals_.at(normals_.number(3 * t + c, vertex[c]), from.normal_copy[c][lane]);
    }
    from.turns[lane] = turns_;
    from.turned |= std::uint64_t{turns_ != nullptr} << lane;
    if (!view_.colored) return;
    LitTriangle triangle;
    fetch_attributes(view_, *look_, t, vertex, false, triangle);
    set_corners(triangle.color, lane, out.color);
  }
  /// Sets the normals of a triangle where some are zero or not finite.
  HWY_NOINLINE void fill_in(std::uint64_t low, std::size_t lane, LitLanes& out) {
    const std::uint64_t t = find(low);
    std::uint32_t vertex[3];
    draw_->vertices(t, vertex);
    LitTriangle triangle;
    fetch_attributes(view_, *look_, t, vertex, true, triangle);
    set_corners(triangle.normal, lane, out.normal);
  }

 private:
  /// The number of triangle `low` in its draw.
  HWY_INLINE std::uint64_t find(std::uint64_t low) {
    const std::uint64_t id = kIdMask - low;
    if (is_other(id)) look_at(frame_.draw_of(id));
    return id - draw_->first_id;
  }
  HWY_NOINLINE void look_at(const Draw& draw) {
    is_list_ = begin(draw, scene_.of(frame_, draw));
    turns_ = look_->identity ? nullptr : look_;
    normals_ = {};
    is_flat_ = false;
    copy_ = ~std::uint64_t{0};
    if (!is_list_) return;
    const MeshView& mesh = *look_->mesh;
    if (!mesh.normals.empty()) {
      (void)normals_.look_at(mesh.normals);
      return;
    }
    is_wide_ = mesh.positions.is_wide();
    is_flat_ = is_wide_ || mesh.positions.is_packed();
  }
  [[nodiscard]] HWY_INLINE const float* position(std::uint32_t vertex, float (&copy)[4]) const {
    const ArrayView<Vec3>& positions = look_->mesh->positions;
    const void* const at = positions.address(vertex);
    if (is_wide_ || vertex + std::size_t{1} != positions.size())
      return static_cast<const float*>(at);
    std::memcpy(copy, at, sizeof(Vec3));
    return copy;
  }
  static HWY_INLINE void set_corners(const Vec3 (&corner)[3], std::size_t lane,
                                     float (&out)[3][3][kLanes]) {
    for (int c = 0; c < 3; ++c) {
      out[c][0][lane] = corner[c].x;
      out[c][1][lane] = corner[c].y;
      out[c][2][lane] = corner[c].z;
    }
  }
  HWY_NOINLINE void ask_draw(std::uint64_t t, bool wants_normals, std::size_t lane,
                             LitSources& from, LitLanes& out) {
    const Draw::OfCopy part = draw_->of_copy(t);
    std::uint32_t vertex[3];
    draw_->vertices(t, vertex);
    for (int c = 0; c < 3; ++c) {
      const ProjectedVertex v = frame_.vertex(*draw_, vertex[c]);
      std::memcpy(from.place_copy[c][lane], &v, sizeof v);
      from.vertex[c][lane] = from.place_copy[c][lane];
      vertex[c] -= draw_->first_vertex_of(part.copy);
    }
    if (draw_->is_copied() && copy_ != part.copy) {
      look_of_copy_ = look_->of(look_->copies[part.copy]);
      copy_ = part.copy;
    }
    LitTriangle triangle;
    fetch_attributes(view_, draw_->is_copied() ? look_of_copy_ : *look_, part.primitive, vertex,
                     wants_normals, triangle);
    for (int c = 0; c < 3 && wants_normals; ++c) {
      std::memcpy(from.normal_copy[c][lane], &triangle.normal[c], sizeof(Vec3));
      from.normal[c][lane] = from.normal_copy[c][lane];
    }
    from.finished |= std::uint64_t{1} << lane;
    if (view_.colored) set_corners(triangle.color, lane, out.color);
  }

  const LitScene& scene_;
  const LitView view_;
  bool is_list_ = false;  ///< lanes can read it; else ask the draw
  bool is_flat_ = false;  ///< the mesh has no normals
  bool is_wide_ = false;  ///< float64 positions
  const LitDraw* turns_ = nullptr;
  PackedValues normals_;
  std::uint64_t copy_ = 0;  ///< the copy whose matrix and colour look_of_copy_ has
  LitDraw look_of_copy_;
};

/// fetch_weights.
HWY_INLINE void fetch_weights(const LitSources& from, std::size_t n, LitLanes& out) {
  const F32 d;
  const ProjectedCorners corner(from.vertex, n);
  const Edges<F> e(corner);
  const F det = e.determinant();
  const F extent = (e.x1 * e.x1 + e.y1 * e.y1) + (e.x2 * e.x2 + e.y2 * e.y2);
  const F w0 = corner.inv_w(0), w1 = corner.inv_w(1), w2 = corner.inv_w(2);
  const F smallest = min_of(w0, min_of(w1, w2));
  const F largest = max_of(w0, max_of(w1, w2));
  const auto thick =
      hn::Or(hn::Not(extent > set(128.0F)), extent < set(lit_detail::kThin) * hn::Abs(det));
  const auto level = smallest > set(lit_detail::kSteep) * largest;
  out.exact = (~bits_of(hn::And(thick, level)) | corner.clipped()) & ((std::uint64_t{1} << n) - 1);
  const F inv_det = set(1) / det;
  hn::Store(in_px<F>(corner.x(0)), d, out.x0);
  hn::Store(in_px<F>(corner.y(0)), d, out.y0);
  hn::Store(e.y2 * inv_det, d, out.p1);
  hn::Store(hn::Neg(e.x2) * inv_det, d, out.q1);
  hn::Store(hn::Neg(e.y1) * inv_det, d, out.p2);
  hn::Store(e.x1 * inv_det, d, out.q2);
  hn::Store(w0 / largest, d, out.inv_w[0]);
  hn::Store(w1 / largest, d, out.inv_w[1]);
  hn::Store(w2 / largest, d, out.inv_w[2]);
}

struct Wide3 {
  Wide x, y, z;
};

/// The three doubles at each address, transposed.
HWY_INLINE Wide3 load_transposed_wide(const float* const (&at)[kLanes]) {
  const hn::Full128<double> d2;
  const auto half = [&](std::size_t first, D& to_x, D& to_y, D& to_z) HWY_ATTR {
    V128 x[kQuads], y[kQuads], z[kQuads];
    for (std::size_t q = 0; q < kQuads; ++q) {
      const auto* const a = reinterpret_cast<const double*>(at[first + 2 * q]);
      const auto* const b = reinterpret_cast<const double*>(at[first + 2 * q + 1]);
      const auto xy_a = hn::LoadU(d2, a), xy_b = hn::LoadU(d2, b);
      const auto yz_a = hn::LoadU(d2, a + 1), yz_b = hn::LoadU(d2, b + 1);
      x[q] = hn::BitCast(F128{}, hn::InterleaveLower(d2, xy_a, xy_b));
      y[q] = hn::BitCast(F128{}, hn::InterleaveUpper(d2, xy_a, xy_b));
      z[q] = hn::BitCast(F128{}, hn::InterleaveUpper(d2, yz_a, yz_b));
    }
    to_x = hn::BitCast(F64{}, joined(x));
    to_y = hn::BitCast(F64{}, joined(y));
    to_z = hn::BitCast(F64{}, joined(z));
  };
  Wide3 v;
  half(0, v.x.lower, v.y.lower, v.z.lower);
  half(kHalf, v.x.upper, v.y.upper, v.z.upper);
  return v;
}

/// face_normal.
HWY_INLINE V3 face_normals(const Wide3& a, const Wide3& b, const Wide3& c) {
  const Wide ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
  const Wide vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
  const Wide nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  const auto larger = [](D p, D q) HWY_ATTR { return hn::IfThenElse(hn::Lt(p, q), q, p); };
  const auto largest = [&](D x, D y, D z)
                           HWY_ATTR { return larger(larger(hn::Abs(x), hn::Abs(y)), hn::Abs(z)); };
  const Wide most{largest(nx.lower, ny.lower, nz.lower), largest(nx.upper, ny.upper, nz.upper)};
  const auto scaled = [&](const Wide& n) HWY_ATTR {
    const D zero = hn::Zero(F64{});
    return rounded({hn::IfThenElseZero(hn::Gt(most.lower, zero), hn::Div(n.lower, most.lower)),
                    hn::IfThenElseZero(hn::Gt(most.upper, zero), hn::Div(n.upper, most.upper))});
  };
  return {scaled(nx), scaled(ny), scaled(nz)};
}

/// The normals of flat lanes; reads n lanes.
HWY_INLINE V3 fetch_planes(LitSources& from, std::size_t n) {
  const auto one = static_cast<std::size_t>(std::countr_zero(from.flat));
  for (std::size_t i = 0; i < kLanes; ++i)
    if ((from.flat >> i & 1) == 0)  // the result is unused
      for (int c = 0; c < 3; ++c) from.position[c][i] = from.position[c][one];
  const auto corner = [&](int c) HWY_ATTR {
    if (from.wide) return load_transposed_wide(from.position[c]);
    const V4 p = load_transposed(from.position[c], n);
    return Wide3{wide(p.x), wide(p.y), wide(p.z)};
  };
  return face_normals(corner(0), corner(1), corner(2));
}

/// Corner `c` of the normals, in world space. Returns the lanes where it is zero or not finite.
HWY_INLINE std::uint64_t fetch_normals(const LitSources& from, std::size_t n, const V3& planes,
                                       int c, LitLanes& out) {
  const V4 v = load_transposed(from.normal[c], n);
  V3 normal = choose(mask_of(from.flat), planes, V3{v.x, v.y, v.z});
  const F ax = hn::Abs(normal.x), ay = hn::Abs(normal.y), az = hn::Abs(normal.z);
  // safe_normal leaves these unchanged; NaN fails all comparisons.
  const F most = set(1e15F);
  const auto bounded = hn::And(ax < most, hn::And(ay < most, az < most));
  const auto safe = hn::And(bounded, max_of(ax, max_of(ay, az)) > set(1e-15F));
  const std::uint64_t all = (std::uint64_t{1} << n) - 1;  // lanes behind may hold NaN
  std::uint64_t nothing = 0;
  if (std::uint64_t rest = all & ~from.finished & ~bits_of(safe); rest != 0) {
    float(&to)[3][kLanes] = out.normal[c];
    store(normal, to);
    for (; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rest));
      const Vec3 own = safe_normal({to[0][i], to[1][i], to[2][i]});
      to[0][i] = own.x, to[1][i] = own.y, to[2][i] = own.z;
      if (own.x == 0 && own.y == 0 && own.z == 0) nothing |= std::uint64_t{1} << i;
    }
    normal = load(to);
  }
  for (std::uint64_t rest = from.turned; rest != 0;) {
    const LitDraw* const draw = from.turns[std::countr_zero(rest)];
    std::uint64_t own = 0;
    for (std::uint64_t r = rest; r != 0; r &= r - 1)
      own |= (r & -r) & (0 - std::uint64_t{from.turns[std::countr_zero(r)] == draw});
    rest &= ~own;
    normal = choose(mask_of(own), turned(draw->normal_matrix, normal), normal);
  }
  store(normal, out.normal[c]);
  return nothing;
}

/// Finds where triangles low[0, n), 0 < n ≤ kLanes, are read, and their colours. Lanes from n to
/// `end` read the first triangle.
HWY_INLINE void find_all_sources(LitOfTriangle& finder, const std::uint64_t* low, std::size_t n,
                                 std::size_t end, bool wants_normals, LitSources& from,
                                 LitLanes& out) {
  from.finished = from.flat = from.turned = 0;
  from.wide = false;
  from.finder = &finder;
  from.low = low;
  from.count = n;
  for (std::size_t i = 0; i < n; ++i) finder.find_sources(low[i], wants_normals, i, from, out);
  for (std::size_t i = n; i < end; ++i)
    for (int c = 0; c < 3; ++c) {
      from.vertex[c][i] = from.vertex[c][0];
      if (wants_normals) from.normal[c][i] = from.normal[c][0];
    }
}

/// Prefetches what fetch_triangles reads.
HWY_INLINE void prefetch_sources(const LitSources& from, std::size_t n, bool wants_normals) {
  for (int c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < n; ++i) {
      __builtin_prefetch(from.vertex[c][i]);
      if ((from.flat >> i & 1) != 0)
        __builtin_prefetch(from.position[c][i]);
      else if (wants_normals)
        __builtin_prefetch(from.normal[c][i]);
    }
}

HWY_INLINE void fetch_triangles(LitSources& from, std::size_t n, bool wants_normals,
                                LitLanes& out) {
  fetch_weights(from, n, out);
  if (!wants_normals) return;
  V3 planes{set(0), set(0), set(0)};
  if (from.flat != 0) planes = fetch_planes(from, n);
  std::uint64_t nothing = 0;
  for (int c = 0; c < 3; ++c) nothing |= fetch_normals(from, n, planes, c, out);
  for (std::uint64_t rest = nothing; rest != 0; rest &= rest - 1)
    if (const auto i = static_cast<std::size_t>(std::countr_zero(rest)); i < from.count)
      from.finder->fill_in(from.low[i], i, out);
}

/// Sets up triangles low[0, n), 0 < n ≤ kLanes.
HWY_INLINE void fetch_triangles(LitOfTriangle& finder, const std::uint64_t* low, std::size_t n,
                                bool wants_normals, LitLanes& out) {
  LitSources from;
  find_all_sources(finder, low, n, (n + 3) / 4 * 4, wants_normals, from, out);
  fetch_triangles(from, n, wants_normals, out);
}

struct Lookup : FloatLookup {
  /// weights_of.
  HWY_INLINE CornerWeights weights(const LitLanes& t, F px, F py) const {
    const F dx = px - (*this)(t.x0), dy = py - (*this)(t.y0);
    const F l1 = (*this)(t.p1) * dx + (*this)(t.q1) * dy;
    const F l2 = (*this)(t.p2) * dx + (*this)(t.q2) * dy;
    return {(set(1) - l1 - l2) * (*this)(t.inv_w[0]), l1 * (*this)(t.inv_w[1]),
            l2 * (*this)(t.inv_w[2])};
  }
  HWY_INLINE V3 sum(const CornerWeights& w, const float (&v)[3][3][kLanes]) const {
    return (*this)(v[0]) * w.b0 + (*this)(v[1]) * w.b1 + (*this)(v[2]) * w.b2;
  }
  HWY_INLINE V3 color(const CornerWeights& w, const float (&v)[3][3][kLanes]) const {
    return mixed_color(w, (*this)(v[0]), (*this)(v[1]), (*this)(v[2]));
  }
};

/// Float64 weights, rounded, of one triangle at kLanes points.
HWY_INLINE CornerWeights exact_weights(const WeightPlanes& planes, const Wide& x, const Wide& y) {
  Wide b[3];
  shares_at(planes, x, y, b);
  return {rounded(b[0]), rounded(b[1]), rounded(b[2])};
}

HWY_INLINE WeightPlanes planes_of(const FrameGeometry& frame, std::uint64_t id) {
  const Draw& draw = frame.draw_of(id);
  return weight_planes(frame, draw, id - draw.first_id);
}

/// Depths of kLanes pixels; undefined where a pixel has no surface.
HWY_INLINE F depths(const std::uint64_t* keys) {
  HWY_ALIGN float depth[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) depth[i] = depth_of_key(keys[i]);
  return hn::Load(F32{}, depth);
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_SHADE_LIT_SEEN_INL_HPP
