// The triangles that a block sees, set up for shading a lane each: as fetch_triangle
// (lit_triangle.hpp) does for one, but for kLanes at once, by the same operations in the same
// order, so it gives the same bits. Pixels then look their triangle's lane up. Their light is
// lit_light.inl.
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
#include <rastrum/raster/shade/seen_triangles-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

#define RASTRUM_LANES HWY_INLINE
#include <rastrum/raster/shade/lit_light.inl>
#undef RASTRUM_LANES

/// Calls use(constant of the shader) where light() makes its colours; returns whether it does.
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
  std::uint64_t exact;  ///< lanes whose weights are those of LitTriangle::planes
};

/// Triangles kept from one block to the next, which mostly sees other ones where they are small,
/// and the same ones where they are large.
struct SeenLanes {
  static constexpr std::size_t kGroups = 64 / kLanes;
  SeenTriangles seen;
  std::uint64_t exact;  ///< a bit for each triangle
  LitLanes lanes[kGroups];

  [[nodiscard]] std::size_t groups() const { return (seen.count + kLanes - 1) / kLanes; }
};
static_assert(sizeof(SeenLanes) <= sizeof(KeptTriangles::lanes));

class DrawOfTriangle;

/// Where the corners of a lane's triangle are read.
struct LitSources {
  DrawOfTriangle* draws;             ///< for attributes that are not read here
  const std::uint64_t* low;          ///< the triangles
  std::size_t count;                 ///< how many; later lanes are unused
  const float* vertex[3][kLanes];    ///< ProjectedVertex
  const float* normal[3][kLanes];    ///< 16 bytes may be read
  const LitDraw* turns[kLanes];      ///< of turned ones: whose matrix takes normals to the world
  std::uint64_t turned;              ///< lanes whose normals are not in the world
  std::uint64_t finished;            ///< lanes whose normals are safe
  std::uint64_t flat;                ///< lanes whose normal is their plane's
  const float* position[3][kLanes];  ///< of flat ones; 16 bytes may be read
  bool wide;                         ///< positions are float64, three each
  /// Copies of corners that cannot be read where they lie.
  alignas(16) float own_vertex[3][kLanes][4];
  alignas(16) float own_normal[3][kLanes][4];
};

/// The draws of one triangle after another, which are mostly the same, and where it is simple to
/// say what their arrays are.
class DrawOfTriangle {
 public:
  HWY_INLINE DrawOfTriangle(const LitScene& scene, const FrameGeometry& frame)
      : scene_(scene), view_(scene.view()), frame_(frame) {}

  /// Asks the cache for the indices of triangle `low`, which say what else is read.
  HWY_INLINE void prefetch(std::uint64_t low) {
    find(low);
    const std::uint64_t corner = 3 * (kIdMask - low - draw_->first_id);
    if (indices_.first != nullptr) __builtin_prefetch(word(corner));
    if (normal_indices_ != nullptr) __builtin_prefetch(normal_indices_ + corner);
  }
  /// Finds where triangle `low` is read, and sets all that is not fetched in lanes.
  HWY_INLINE void find_sources(std::uint64_t low, bool wants_normals, std::size_t lane,
                               LitSources& from, LitLanes& out) {
    find(low);
    const bool in_lanes = !wants_normals || normals_ != nullptr || is_flat_;
    if (projected_ == nullptr || !is_list_ || !in_lanes)
      return ask_draw(low, wants_normals, lane, from, out);
    if (wants_normals && is_flat_) {
      // The positions of a group are all of one type.
      if (from.flat == 0) from.wide = is_wide_;
      if (from.wide != is_wide_) return ask_draw(low, wants_normals, lane, from, out);
    }
    const std::uint64_t corner = 3 * (kIdMask - low - draw_->first_id);
    std::uint32_t vertex[3];
    for (std::size_t c = 0; c < 3; ++c) {
      vertex[c] = static_cast<std::uint32_t>(corner + c);
      if (indices_.first != nullptr) std::memcpy(&vertex[c], word(corner + c), sizeof vertex[c]);
      from.vertex[c][lane] = reinterpret_cast<const float*>(projected_ + vertex[c]);
    }
    if (wants_normals && is_flat_) {
      const std::uint64_t own = std::uint64_t{1} << lane;
      for (std::size_t c = 0; c < 3; ++c) {
        from.position[c][lane] = position(vertex[c], from.own_vertex[c][lane]);
        from.normal[c][lane] = from.vertex[c][lane];  // read, but not used
      }
      from.flat |= own;
      from.finished |= own;
    } else if (wants_normals) {
      for (std::size_t c = 0; c < 3; ++c)
        from.normal[c][lane] =
            normal(normal_indices_ != nullptr ? normal_indices_[corner + c] : vertex[c],
                   from.own_normal[c][lane]);
    }
    from.turns[lane] = turns_;
    from.turned |= std::uint64_t{turns_ != nullptr} << lane;
    if (!view_.colored) return;
    LitTriangle triangle;
    fetch_attributes(view_, *lit_, corner / 3, vertex, false, triangle);
    set_colors(triangle, lane, out);
  }
  /// Sets the normals of a triangle of which some are zero or not finite.
  HWY_NOINLINE void fill_in(std::uint64_t low, std::size_t lane, LitLanes& out) {
    find(low);
    std::uint32_t vertex[3];
    draw_->vertices(kIdMask - low - draw_->first_id, vertex);
    LitTriangle triangle;
    fetch_attributes(view_, *lit_, kIdMask - low - draw_->first_id, vertex, true, triangle);
    for (int c = 0; c < 3; ++c) {
      out.normal[c][0][lane] = triangle.normal[c].x;
      out.normal[c][1][lane] = triangle.normal[c].y;
      out.normal[c][2][lane] = triangle.normal[c].z;
    }
  }

 private:
  HWY_INLINE void find(std::uint64_t low) {
    const std::uint64_t id = kIdMask - low;
    if (draw_ == nullptr || id - draw_->first_id >= draw_->primitive_count) look_at(id);
  }
  HWY_NOINLINE void look_at(std::uint64_t id) {
    draw_ = &frame_.draw_of(id);
    lit_ = &scene_.of(frame_, *draw_);
    turns_ = lit_->identity ? nullptr : lit_;
    projected_ = frame_.projected_of(*draw_);
    indices_ = {};
    normal_indices_ = nullptr;
    normals_ = nullptr;
    is_list_ = is_flat_ = false;
    copy_ = ~std::uint64_t{0};
    if (draw_->is_copied()) return;
    const MeshView& mesh = *lit_->mesh;
    if (mesh.faces.kind != FaceKind::triangles) return;
    if (!mesh.indices.empty()) {
      indices_ = mesh.indices.words();
      if (indices_.first == nullptr) return;
    }
    is_list_ = true;
    const AttributeView<Vec3>& normals = mesh.normals;
    if (normals.empty()) {
      is_wide_ = mesh.positions.is_wide();
      is_flat_ = is_wide_ || mesh.positions.is_packed();
      return;
    }
    const bool is_indexed = !normals.indices.empty();
    if (!normals.values.is_packed()) return;
    if (is_indexed ? !normals.indices.is_packed() : normals.per != Per::vertex) return;
    if (is_indexed) normal_indices_ = normals.indices.data();
    normals_ = &normals.values.data()->x;
    last_ = normals.values.size() - 1;
  }
  [[nodiscard]] HWY_INLINE const std::byte* word(std::uint64_t corner) const {
    return indices_.first + static_cast<std::ptrdiff_t>(corner) * indices_.stride;
  }
  /// The last one is copied, since 16 bytes are read and nothing may be read behind it.
  [[nodiscard]] HWY_INLINE const float* normal(std::size_t i, float (&own)[4]) const {
    if (i != last_) return normals_ + i * 3;
    std::copy_n(normals_ + i * 3, 3, own);
    return own;
  }
  [[nodiscard]] HWY_INLINE const float* position(std::uint32_t vertex, float (&own)[4]) const {
    const ArrayView<Vec3>& positions = lit_->mesh->positions;
    const void* const at = positions.address(vertex);
    if (is_wide_ || vertex + std::size_t{1} != positions.size())
      return static_cast<const float*>(at);
    std::memcpy(own, at, sizeof(Vec3));
    return own;
  }
  static HWY_INLINE void set_colors(const LitTriangle& t, std::size_t lane, LitLanes& out) {
    for (int c = 0; c < 3; ++c) {
      out.color[c][0][lane] = t.color[c].x;
      out.color[c][1][lane] = t.color[c].y;
      out.color[c][2][lane] = t.color[c].z;
    }
  }
  HWY_NOINLINE void ask_draw(std::uint64_t low, bool wants_normals, std::size_t lane,
                             LitSources& from, LitLanes& out) {
    const Draw::OfCopy of = draw_->of_copy(kIdMask - low - draw_->first_id);
    std::uint32_t vertex[3];
    draw_->vertices(kIdMask - low - draw_->first_id, vertex);
    for (int c = 0; c < 3; ++c) {
      const ProjectedVertex own = frame_.vertex(*draw_, vertex[c]);
      std::memcpy(from.own_vertex[c][lane], &own, sizeof own);
      from.vertex[c][lane] = from.own_vertex[c][lane];
      vertex[c] -= draw_->first_vertex_of(of.copy);
    }
    if (draw_->is_copied() && copy_ != of.copy) {
      of_copy_ = lit_->of(lit_->copies[of.copy]);
      copy_ = of.copy;
    }
    LitTriangle triangle;
    fetch_attributes(view_, draw_->is_copied() ? of_copy_ : *lit_, of.primitive, vertex,
                     wants_normals, triangle);
    for (int c = 0; c < 3; ++c) {
      if (!wants_normals) continue;
      float(&n)[4] = from.own_normal[c][lane];
      n[0] = triangle.normal[c].x, n[1] = triangle.normal[c].y, n[2] = triangle.normal[c].z;
      from.normal[c][lane] = n;
    }
    from.finished |= std::uint64_t{1} << lane;
    if (view_.colored) set_colors(triangle, lane, out);
  }

  const LitScene& scene_;
  const LitView view_;
  const FrameGeometry& frame_;
  const Draw* draw_ = nullptr;
  const LitDraw* lit_ = nullptr;
  const LitDraw* turns_ = nullptr;
  std::uint64_t copy_ = 0;  ///< of a draw of copies: whose matrix and colour of_copy_ has
  LitDraw of_copy_;
  const ProjectedVertex* projected_ = nullptr;     ///< null: ask the draw
  bool is_list_ = false;                           ///< of triangles; else ask the draw
  bool is_flat_ = false;                           ///< without normals
  bool is_wide_ = false;                           ///< positions of float64
  IndexView::Words indices_{};                     ///< null: vertices in order
  const std::uint32_t* normal_indices_ = nullptr;  ///< null: the vertices'
  const float* normals_ = nullptr;
  std::size_t last_ = 0;
};

/// fetch_weights.
HWY_INLINE void fetch_weights(const LitSources& from, std::size_t n, LitLanes& out) {
  const F32 d;
  const I32 di;
  const V4 v0 = load_transposed(from.vertex[0], n);
  const V4 v1 = load_transposed(from.vertex[1], n);
  const V4 v2 = load_transposed(from.vertex[2], n);
  const auto whole = [&](F v) HWY_ATTR { return hn::BitCast(di, v); };
  const F px = set(1.0F / kSubpixels);
  const auto along = [&](F to, F begin) HWY_ATTR {
    return hn::ConvertTo(d, hn::Sub(whole(to), whole(begin))) * px;
  };
  const F e1x = along(v1.x, v0.x), e1y = along(v1.y, v0.y);
  const F e2x = along(v2.x, v0.x), e2y = along(v2.y, v0.y);
  const F det = e1x * e2y - e2x * e1y;
  const F extent = (e1x * e1x + e1y * e1y) + (e2x * e2x + e2y * e2y);
  const F smallest = min_of(v0.w, min_of(v1.w, v2.w));
  const F largest = max_of(v0.w, max_of(v1.w, v2.w));
  const auto thick =
      hn::Or(hn::Not(extent > set(128.0F)), extent < set(lit_detail::kThin) * hn::Abs(det));
  const auto level = smallest > set(lit_detail::kSteep) * largest;
  const auto needs_clip = hn::BitCast(d, hn::Set(di, kNeedsClip));
  const auto is_clipped = [&](F x) HWY_ATTR {
    return hn::RebindMask(d, hn::Eq(whole(x), whole(needs_clip)));
  };
  const auto clipped = hn::Or(is_clipped(v0.x), hn::Or(is_clipped(v1.x), is_clipped(v2.x)));
  out.exact = (~bits_of(hn::And(thick, level)) | bits_of(clipped)) & ((std::uint64_t{1} << n) - 1);
  const F inv_det = set(1) / det;
  hn::Store(hn::ConvertTo(d, whole(v0.x)) * px, d, out.x0);
  hn::Store(hn::ConvertTo(d, whole(v0.y)) * px, d, out.y0);
  hn::Store(e2y * inv_det, d, out.p1);
  hn::Store(hn::Neg(e2x) * inv_det, d, out.q1);
  hn::Store(hn::Neg(e1y) * inv_det, d, out.p2);
  hn::Store(e1x * inv_det, d, out.q2);
  hn::Store(v0.w / largest, d, out.inv_w[0]);
  hn::Store(v1.w / largest, d, out.inv_w[1]);
  hn::Store(v2.w / largest, d, out.inv_w[2]);
}

using HalfTag = hn::Rebind<float, F64>;
/// Vectors of half the lanes, in float64.
struct Wide3 {
  D x, y, z;
};

/// The three doubles at each of kLanes / 2 places, transposed.
HWY_INLINE Wide3 load_transposed_wide(const float* const* at) {
  const hn::Full128<double> d2;
  const F64 d;
  V128 x[kQuads], y[kQuads], z[kQuads];
  for (std::size_t q = 0; q < kQuads; ++q) {
    const auto* const a = reinterpret_cast<const double*>(at[2 * q]);
    const auto* const b = reinterpret_cast<const double*>(at[2 * q + 1]);
    const auto xy_a = hn::LoadU(d2, a), xy_b = hn::LoadU(d2, b);
    const auto yz_a = hn::LoadU(d2, a + 1), yz_b = hn::LoadU(d2, b + 1);
    x[q] = hn::BitCast(F128{}, hn::InterleaveLower(d2, xy_a, xy_b));
    y[q] = hn::BitCast(F128{}, hn::InterleaveUpper(d2, xy_a, xy_b));
    z[q] = hn::BitCast(F128{}, hn::InterleaveUpper(d2, yz_a, yz_b));
  }
  return {hn::BitCast(d, joined(x)), hn::BitCast(d, joined(y)), hn::BitCast(d, joined(z))};
}

/// face_normal of half the lanes.
HWY_INLINE void face_normals(const Wide3& a, const Wide3& b, const Wide3& c,
                             hn::Vec<HalfTag> (&out)[3]) {
  const D ux = hn::Sub(b.x, a.x), uy = hn::Sub(b.y, a.y), uz = hn::Sub(b.z, a.z);
  const D vx = hn::Sub(c.x, a.x), vy = hn::Sub(c.y, a.y), vz = hn::Sub(c.z, a.z);
  const D n[3] = {hn::Sub(hn::Mul(uy, vz), hn::Mul(uz, vy)),
                  hn::Sub(hn::Mul(uz, vx), hn::Mul(ux, vz)),
                  hn::Sub(hn::Mul(ux, vy), hn::Mul(uy, vx))};
  const auto larger = [](D p, D q) HWY_ATTR { return hn::IfThenElse(hn::Lt(p, q), q, p); };
  const D largest = larger(larger(hn::Abs(n[0]), hn::Abs(n[1])), hn::Abs(n[2]));
  const auto has_area = hn::Gt(largest, hn::Zero(F64{}));
  for (int axis = 0; axis < 3; ++axis)
    out[axis] = hn::DemoteTo(HalfTag{}, hn::IfThenElseZero(has_area, hn::Div(n[axis], largest)));
}

/// The normals of flat lanes; `n`: how many lanes are asked for.
HWY_INLINE V3 fetch_planes(LitSources& from, std::size_t n) {
  const auto one = static_cast<std::size_t>(std::countr_zero(from.flat));
  for (std::size_t i = 0; i < kLanes; ++i)
    if ((from.flat >> i & 1) == 0)  // their result is not used
      for (int c = 0; c < 3; ++c) from.position[c][i] = from.position[c][one];
  hn::Vec<HalfTag> low[3], high[3];
  if (from.wide) {
    const auto half = [&](std::size_t first, hn::Vec<HalfTag>(&out)[3]) HWY_ATTR {
      face_normals(load_transposed_wide(from.position[0] + first),
                   load_transposed_wide(from.position[1] + first),
                   load_transposed_wide(from.position[2] + first), out);
    };
    half(0, low);
    half(kLanes / 2, high);
  } else {
    const V4 p[3] = {load_transposed(from.position[0], n), load_transposed(from.position[1], n),
                     load_transposed(from.position[2], n)};
    const auto half = [&](bool upper, hn::Vec<HalfTag>(&out)[3]) HWY_ATTR {
      const auto wide = [&](F f) HWY_ATTR {
        return hn::PromoteTo(F64{},
                             upper ? hn::UpperHalf(HalfTag{}, f) : hn::LowerHalf(HalfTag{}, f));
      };
      const auto corner = [&](int c) HWY_ATTR {
        return Wide3{wide(p[c].x), wide(p[c].y), wide(p[c].z)};
      };
      face_normals(corner(0), corner(1), corner(2), out);
    };
    half(false, low);
    half(true, high);
  }
  const F32 d;
  return {hn::Combine(d, high[0], low[0]), hn::Combine(d, high[1], low[1]),
          hn::Combine(d, high[2], low[2])};
}

/// Corner `c` of the normals, in the world. Returns the lanes where it is zero or not finite.
HWY_INLINE std::uint64_t fetch_normals(const LitSources& from, std::size_t n, const V3& planes,
                                       int c, LitLanes& out) {
  const F32 d;
  const V4 v = load_transposed(from.normal[c], n);
  V3 normal = choose(mask_of(from.flat), planes, V3{v.x, v.y, v.z});
  const F ax = hn::Abs(normal.x), ay = hn::Abs(normal.y), az = hn::Abs(normal.z);
  // safe_normal leaves these as they are; all comparisons fail for NaN.
  const F most = set(1e15F);
  const auto bounded = hn::And(ax < most, hn::And(ay < most, az < most));
  const auto safe = hn::And(bounded, max_of(ax, max_of(ay, az)) > set(1e-15F));
  const auto store = [&](const V3& to) HWY_ATTR {
    hn::Store(to.x, d, out.normal[c][0]);
    hn::Store(to.y, d, out.normal[c][1]);
    hn::Store(to.z, d, out.normal[c][2]);
  };
  const std::uint64_t all = (std::uint64_t{1} << n) - 1;  // lanes behind may hold NaN
  std::uint64_t nothing = 0;
  if (std::uint64_t rest = all & ~from.finished & ~bits_of(safe); rest != 0) {
    store(normal);
    float(&to)[3][kLanes] = out.normal[c];
    for (; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rest));
      const Vec3 own = safe_normal({to[0][i], to[1][i], to[2][i]});
      to[0][i] = own.x, to[1][i] = own.y, to[2][i] = own.z;
      if (own.x == 0 && own.y == 0 && own.z == 0) nothing |= std::uint64_t{1} << i;
    }
    normal = {hn::Load(d, to[0]), hn::Load(d, to[1]), hn::Load(d, to[2])};
  }
  for (std::uint64_t rest = from.turned; rest != 0;) {
    const LitDraw* const draw = from.turns[std::countr_zero(rest)];
    std::uint64_t own = 0;
    for (std::uint64_t r = rest; r != 0; r &= r - 1)
      own |= (r & -r) & (0 - std::uint64_t{from.turns[std::countr_zero(r)] == draw});
    rest &= ~own;
    normal = choose(mask_of(own), turned(draw->normal_matrix, normal), normal);
  }
  store(normal);
  return nothing;
}

/// Finds where triangles low[0, n) are read, 0 < n ≤ kLanes, and their colours. Lanes behind them,
/// up to `end`, read what the first one reads.
HWY_INLINE void find_all_sources(DrawOfTriangle& of, const std::uint64_t* low, std::size_t n,
                                 std::size_t end, bool wants_normals, LitSources& from,
                                 LitLanes& out) {
  from.finished = from.flat = from.turned = 0;
  from.wide = false;
  from.draws = &of;
  from.low = low;
  from.count = n;
  for (std::size_t i = 0; i < n; ++i) of.find_sources(low[i], wants_normals, i, from, out);
  for (std::size_t i = n; i < end; ++i)
    for (int c = 0; c < 3; ++c) {
      from.vertex[c][i] = from.vertex[c][0];
      if (wants_normals) from.normal[c][i] = from.normal[c][0];
    }
}

/// Asks the cache for what fetch_triangles reads.
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

/// Sets up the n triangles of `from`.
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
      from.draws->fill_in(from.low[i], i, out);
}

/// Sets up triangles low[0, n), 0 < n ≤ kLanes.
HWY_INLINE void fetch_triangles(DrawOfTriangle& of, const std::uint64_t* low, std::size_t n,
                                bool wants_normals, LitLanes& out) {
  LitSources from;
  find_all_sources(of, low, n, (n + 3) / 4 * 4, wants_normals, from, out);
  fetch_triangles(from, n, wants_normals, out);
}

/// Looks up values of triangles' lanes; `lane`: that of each pixel's triangle.
struct Lookup {
  decltype(hn::IndicesFromVec(F32{}, hn::Zero(I32{}))) lane;

  HWY_INLINE F operator()(const float* values) const {
    return hn::TableLookupLanes(hn::Load(F32{}, values), lane);
  }
  HWY_INLINE V3 operator()(const float (&v)[3][kLanes]) const {
    return {(*this)(v[0]), (*this)(v[1]), (*this)(v[2])};
  }
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

/// Weights in float64, as shares_at has them, of kLanes fragments whose pixels' centres are px and
/// py.
HWY_INLINE CornerWeights exact_weights(const WeightPlanes& planes, const float* px,
                                       const float* py) {
  const F64 d;
  const HalfTag half;
  const D zero = hn::Zero(d), one = hn::Set(d, 1.0);
  HWY_ALIGN float b[3][kLanes];
  for (std::size_t i = 0; i < kLanes; i += kLanes / 2) {
    const D dx = hn::Sub(hn::PromoteTo(d, hn::LoadU(half, px + i)), hn::Set(d, planes.x0));
    const D dy = hn::Sub(hn::PromoteTo(d, hn::LoadU(half, py + i)), hn::Set(d, planes.y0));
    const auto share = [&](int c) HWY_ATTR {
      return hn::Add(hn::Add(hn::Set(d, planes.r[c]), hn::Mul(hn::Set(d, planes.p[c]), dx)),
                     hn::Mul(hn::Set(d, planes.q[c]), dy));
    };
    const D b0 = share(0), b1 = share(1), b2 = share(2);
    const D sum = hn::Add(hn::Add(b0, b1), b2);
    const auto cut = [&](D v) HWY_ATTR {
      v = hn::Div(v, sum);
      return hn::IfThenElseZero(hn::Gt(v, zero), hn::IfThenElse(hn::Lt(v, one), v, one));
    };
    const D c0 = cut(b0), c1 = cut(b1), c2 = cut(b2);
    const D inside = hn::Add(hn::Add(c0, c1), c2);
    hn::Store(hn::DemoteTo(half, hn::Div(c0, inside)), half, b[0] + i);
    hn::Store(hn::DemoteTo(half, hn::Div(c1, inside)), half, b[1] + i);
    hn::Store(hn::DemoteTo(half, hn::Div(c2, inside)), half, b[2] + i);
  }
  const F32 df;
  return {hn::Load(df, b[0]), hn::Load(df, b[1]), hn::Load(df, b[2])};
}

HWY_INLINE WeightPlanes planes_of(const FrameGeometry& frame, std::uint64_t id) {
  const Draw& draw = frame.draw_of(id);
  return weight_planes(frame, draw, id - draw.first_id);
}

/// Depths of kLanes pixels; of those that hold nothing they may be anything.
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
