// The lit shaders a row of samples at a time, compiled once per instruction set.
//
// The weights of a triangle are set up in scalar float32 once per run of samples that see it; where
// a row sees one triangle its setup is broadcast, otherwise lanes hold different ones, and both
// give the same bits. float32 weights lose about |longest edge|² / |twice the area| ulps to
// cancellation, so thin and clipped triangles are interpolated in float64 (interpolate.hpp)
// instead.
//
// Square roots and divisions are the exact ones: approximate reciprocals differ between makers of
// the same instruction set.

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/shaders/lit_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include <rastrum/raster/interpolate.hpp>
#include <rastrum/raster/shaders/lit_constants.hpp>

#ifndef RASTRUM_RASTER_SHADERS_LIT_SIMD_ONCE
#define RASTRUM_RASTER_SHADERS_LIT_SIMD_ONCE
namespace rastrum::raster {
namespace {

/// Weights λ₁, λ₂ as planes, 1/w, and the attributes of the three corners: one triangle, one column
/// of numbers, so that lanes can hold different triangles.
enum Column : int {
  kX0,
  kY0,
  kP1,
  kQ1,
  kP2,
  kQ2,
  kInvW0,
  kInvW1,
  kInvW2,
  kNormal,               ///< 9: corner-major
  kColor = kNormal + 9,  ///< 9
  kColumns = kColor + 9,
};

struct TriangleColumns {
  std::uint64_t low = 0;  ///< of the word; 0: none yet
  bool exact = false;     ///< interpolate with `planes`
  float value[kColumns];
  WeightPlanes planes;
};

/// Up to this ratio of squared longest edge to twice the area float32 weights are as good as 1e-5.
constexpr float kThin = 32.0F;

void put(float* to, Vec3 v) {
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}

Vec3 to_world(const LitDraw& draw, Vec3 n) {
  if (draw.identity) return n;
  const auto& m = draw.normal_matrix;
  return {m[0][0] * n.x + m[0][1] * n.y + m[0][2] * n.z,
          m[1][0] * n.x + m[1][1] * n.y + m[1][2] * n.z,
          m[2][0] * n.x + m[2][1] * n.y + m[2][2] * n.z};
}

void fetch_weights(const FrameGeometry& frame, const Draw& draw, std::uint64_t t,
                   const std::uint32_t (&vertex)[3], TriangleColumns& out) {
  const ProjectedVertex* vertices = frame.projected + draw.first_vertex;
  const ProjectedVertex &v0 = vertices[vertex[0]], &v1 = vertices[vertex[1]],
                        &v2 = vertices[vertex[2]];
  constexpr float kPx = 1.0F / kSubpixels;
  const float e1x = static_cast<float>(v1.x_fx8 - v0.x_fx8) * kPx;
  const float e1y = static_cast<float>(v1.y_fx8 - v0.y_fx8) * kPx;
  const float e2x = static_cast<float>(v2.x_fx8 - v0.x_fx8) * kPx;
  const float e2y = static_cast<float>(v2.y_fx8 - v0.y_fx8) * kPx;
  const float det = e1x * e2y - e2x * e1y;
  const float extent = (e1x * e1x + e1y * e1y) + (e2x * e2x + e2y * e2y);
  // Up to 16 px every product of edges is exact, however thin the triangle.
  out.exact = v0.x_fx8 == kNeedsClip || v1.x_fx8 == kNeedsClip || v2.x_fx8 == kNeedsClip ||
              (extent > 128.0F && !(extent < kThin * std::abs(det)));
  if (out.exact) {
    out.planes = weight_planes(frame, draw, t);
    std::fill_n(out.value, kNormal, 0.0F);
    return;
  }
  const float inv_det = 1.0F / det;
  float* v = out.value;
  v[kX0] = static_cast<float>(v0.x_fx8) * kPx;
  v[kY0] = static_cast<float>(v0.y_fx8) * kPx;
  v[kP1] = e2y * inv_det;
  v[kQ1] = -e2x * inv_det;
  v[kP2] = -e1y * inv_det;
  v[kQ2] = e1x * inv_det;
  v[kInvW0] = v0.inv_w;
  v[kInvW1] = v1.inv_w;
  v[kInvW2] = v2.inv_w;
}

void fetch_triangle(const LitScene& scene, const FrameGeometry& frame, std::uint64_t low,
                    bool wants_normals, TriangleColumns& out) {
  out.low = low;
  const std::uint64_t id = kIdMask - low;
  const Draw& draw = frame.draw_of(id);
  const LitDraw& lit = scene.draws[static_cast<std::size_t>(&draw - frame.draws.data())];
  const std::uint64_t t = id - draw.first_id;
  const std::uint32_t vertex[3] = {draw.vertex(t, 0), draw.vertex(t, 1), draw.vertex(t, 2)};
  fetch_weights(frame, draw, t, vertex, out);
  const MeshView& mesh = lit.mesh;
  float* v = out.value;
  if (wants_normals && mesh.normals.empty()) {
    const Vec3 a = mesh.positions[vertex[0]];
    const Vec3 n =
        to_world(lit, cross(mesh.positions[vertex[1]] - a, mesh.positions[vertex[2]] - a));
    for (int c = 0; c < 3; ++c) put(v + kNormal + 3 * c, n);
  } else if (wants_normals) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t i =
          mesh.normals.indices.empty() ? vertex[c] : mesh.normals.indices[t * 3 + c];
      put(v + kNormal + 3 * c, to_world(lit, mesh.normals.values[i]));
    }
  }
  if (mesh.colors.empty()) {
    for (int c = 0; c < 3; ++c) put(v + kColor + 3 * c, kDefaultBase);
    return;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t i = mesh.colors.indices.empty() ? vertex[c] : mesh.colors.indices[t * 3 + c];
    const Vec4 color = mesh.colors.values[i];
    put(v + kColor + 3 * c, {color.x, color.y, color.z});
  }
}

}  // namespace
}  // namespace rastrum::raster
#endif  // RASTRUM_RASTER_SHADERS_LIT_SIMD_ONCE

#if HWY_TARGET != HWY_SCALAR
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F32 = hn::CappedTag<float, 8>;
using F = hn::Vec<F32>;
constexpr std::size_t kLanes = hn::MaxLanes(F32{});

struct V3 {
  F x, y, z;
};

HWY_INLINE F set(float v) {
  return hn::Set(F32{}, v);
}
HWY_INLINE F dot(const V3& a, const V3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE V3 scale(const V3& a, F s) {
  return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}
HWY_INLINE V3 normalize(const V3& a) {
  const F32 d;
  const F square = dot(a, a);
  const F inverse = hn::Div(set(1.0F), hn::Sqrt(square));
  return scale(a, hn::IfThenElse(hn::Gt(square, hn::Zero(d)), inverse, set(1.0F)));
}
/// max(v, 0), and 0 for NaN.
HWY_INLINE F positive(F v) {
  return hn::IfThenElseZero(hn::Gt(v, hn::Zero(F32{})), v);
}

/// Columns of kLanes samples: one triangle for all, or one for each.
struct Lanes {
  F value[kColumns];
};

HWY_INLINE V3 corner_sum(const Lanes& lanes, int column, F b0, F b1, F b2) {
  const auto axis = [&](int i) HWY_ATTR {
    return hn::Add(
        hn::Add(hn::Mul(lanes.value[column + i], b0), hn::Mul(lanes.value[column + 3 + i], b1)),
        hn::Mul(lanes.value[column + 6 + i], b2));
  };
  return {axis(0), axis(1), axis(2)};
}

struct Row {
  const LitScene* scene;
  int x, y;  ///< of the first lane
  bool uniform;
  bool colored;  ///< some draw has colours of its own
};

/// Weights of the lanes, up to a common positive factor; `exact` lanes are overwritten in float64.
HWY_INLINE void row_weights(const Row& row, const Lanes& lanes, const TriangleColumns* triangles,
                            std::uint32_t exact, F& b0, F& b1, F& b2) {
  const F32 d;
  const F one = set(1.0F);
  const F px = hn::Add(hn::Iota(d, static_cast<float>(row.x)), set(0.5F));
  const F py = set(static_cast<float>(row.y) + 0.5F);
  const F dx = hn::Sub(px, lanes.value[kX0]);
  const F dy = hn::Sub(py, lanes.value[kY0]);
  const F l1 = hn::Add(hn::Mul(lanes.value[kP1], dx), hn::Mul(lanes.value[kQ1], dy));
  const F l2 = hn::Add(hn::Mul(lanes.value[kP2], dx), hn::Mul(lanes.value[kQ2], dy));
  b0 = hn::Mul(hn::Sub(hn::Sub(one, l1), l2), lanes.value[kInvW0]);
  b1 = hn::Mul(l1, lanes.value[kInvW1]);
  b2 = hn::Mul(l2, lanes.value[kInvW2]);
  if (exact == 0) return;
  HWY_ALIGN float b[3][kLanes];
  hn::Store(b0, d, b[0]);
  hn::Store(b1, d, b[1]);
  hn::Store(b2, d, b[2]);
  for (; exact != 0; exact &= exact - 1) {
    const int lane = std::countr_zero(exact);
    const TriangleColumns& triangle = triangles[row.uniform ? 0 : lane];
    const Weights w = weights_at(triangle.planes, row.x + lane, row.y);
    for (int c = 0; c < 3; ++c) b[c][lane] = static_cast<float>(w.b[c]);
  }
  b0 = hn::Load(d, b[0]);
  b1 = hn::Load(d, b[1]);
  b2 = hn::Load(d, b[2]);
}

template <LitModel kModel>
HWY_INLINE V3 shade_row(const Row& row, const Lanes& lanes, const TriangleColumns* triangles,
                        std::uint32_t exact) {
  const F32 d;
  F b0, b1, b2;
  row_weights(row, lanes, triangles, exact, b0, b1, b2);
  V3 base{lanes.value[kColor], lanes.value[kColor + 1], lanes.value[kColor + 2]};
  if (kModel != LitModel::normal && row.colored)
    base = scale(corner_sum(lanes, kColor, b0, b1, b2),
                 hn::Div(set(1.0F), hn::Add(hn::Add(b0, b1), b2)));
  if (kModel == LitModel::flat) return base;

  V3 n = normalize(corner_sum(lanes, kNormal, b0, b1, b2));
  const F half = set(0.5F);
  if (kModel == LitModel::normal)
    return {hn::Add(hn::Mul(n.x, half), half), hn::Add(hn::Mul(n.y, half), half),
            hn::Add(hn::Mul(n.z, half), half)};

  const ViewRays& rays = row.scene->rays;
  const F px = hn::Add(hn::Iota(d, static_cast<float>(row.x)), half);
  const float py = static_cast<float>(row.y) + 0.5F;
  const auto ray = [&](float origin, float dx, float dy) HWY_ATTR {
    return hn::Neg(hn::Add(hn::Add(set(origin), hn::Mul(set(dx), px)), set(dy * py)));
  };
  const V3 v = normalize({ray(rays.d.x, rays.dx.x, rays.dy.x), ray(rays.d.y, rays.dx.y, rays.dy.y),
                          ray(rays.d.z, rays.dx.z, rays.dy.z)});
  const F flip = hn::IfThenElse(hn::Lt(dot(n, v), hn::Zero(d)), set(-1.0F), set(1.0F));
  n = scale(n, flip);
  const V3 light{set(kLight.x), set(kLight.y), set(kLight.z)};
  const F diffuse = hn::Add(set(kAmbient), hn::Mul(set(kDiffuse), positive(dot(n, light))));
  const V3 lit = scale(base, diffuse);
  if (kModel == LitModel::lambert) return lit;
  F s = positive(
      dot(n, normalize({hn::Add(v.x, light.x), hn::Add(v.y, light.y), hn::Add(v.z, light.z)})));
  for (int i = 0; i < 5; ++i) s = hn::Mul(s, s);
  const F specular = hn::Mul(s, set(kSpecular));
  return {hn::Add(lit.x, specular), hn::Add(lit.y, specular), hn::Add(lit.z, specular)};
}

template <LitModel kModel>
void shade_block(const LitScene& scene, const FrameGeometry& frame,
                 const std::uint64_t (&words)[64], int x0, int y0, BlockColors& colors) {
  const F32 d;
  constexpr bool kNormals = kModel != LitModel::flat;
  TriangleColumns triangles[kLanes];
  HWY_ALIGN float columns[kColumns][kLanes];
  Lanes lanes;
  std::uint64_t broadcast = 0;  // low part of the triangle that `lanes` holds for a whole row
  // A lane without a surface keeps what it has; the first one must not read garbage that traps.
  std::memset(columns, 0, sizeof columns);
  for (std::size_t first = 0; first < 64; first += kLanes) {
    const std::uint64_t* row_words = words + first;
    Row row{&scene, x0 + static_cast<int>(first % 8), y0 + static_cast<int>(first / 8), true,
            scene.colored};
    std::uint64_t some = 0;
    std::uint64_t differs = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      some = row_words[lane] != 0 ? row_words[lane] : some;
    if (some == 0) continue;
    const std::uint64_t low = some & kIdMask;
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      differs |= row_words[lane] != 0 ? (row_words[lane] & kIdMask) ^ low : 0;
    row.uniform = differs == 0;

    std::uint32_t exact = 0;
    if (row.uniform) {
      if (low != broadcast) {
        if (low != triangles[0].low) fetch_triangle(scene, frame, low, kNormals, triangles[0]);
        for (int c = 0; c < kColumns; ++c) lanes.value[c] = set(triangles[0].value[c]);
        broadcast = low;
      }
      if (triangles[0].exact) exact = (1U << kLanes) - 1;
    } else {
      broadcast = 0;
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        if (row_words[lane] == 0) continue;
        const std::uint64_t lane_low = row_words[lane] & kIdMask;
        TriangleColumns& mine = triangles[lane];
        if (mine.low != lane_low) {
          if (lane > 0 && triangles[lane - 1].low == lane_low)
            mine = triangles[lane - 1];
          else
            fetch_triangle(scene, frame, lane_low, kNormals, mine);
        }
        exact |= static_cast<std::uint32_t>(mine.exact) << lane;
        for (int c = 0; c < kColumns; ++c) columns[c][lane] = mine.value[c];
      }
      for (int c = 0; c < kColumns; ++c) lanes.value[c] = hn::Load(d, columns[c]);
    }
    const V3 color = shade_row<kModel>(row, lanes, triangles, exact);
    hn::Store(color.x, d, colors.r + first);
    hn::Store(color.y, d, colors.g + first);
    hn::Store(color.z, d, colors.b + first);
  }
  for (std::size_t i = 0; i < 64; i += kLanes) hn::Store(set(1.0F), d, colors.a + i);
}

bool shade(LitModel model, const LitScene& scene, const FrameGeometry& frame,
           const std::uint64_t (&words)[64], int x0, int y0, BlockColors& colors) noexcept {
  switch (model) {
    case LitModel::flat:
      shade_block<LitModel::flat>(scene, frame, words, x0, y0, colors);
      return true;
    case LitModel::normal:
      shade_block<LitModel::normal>(scene, frame, words, x0, y0, colors);
      return true;
    case LitModel::lambert:
      shade_block<LitModel::lambert>(scene, frame, words, x0, y0, colors);
      return true;
    case LitModel::phong:
      shade_block<LitModel::phong>(scene, frame, words, x0, y0, colors);
      return true;
    default:
      return false;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace rastrum::raster
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET != HWY_SCALAR

#if HWY_ONCE
namespace rastrum::raster {

bool shade_lit_simd(Isa isa, LitModel model, const LitScene& scene, const FrameGeometry& frame,
                    const std::uint64_t (&words)[64], int x0, int y0,
                    BlockColors& colors) noexcept {
  switch (isa) {
#if HWY_TARGETS & HWY_SSE4
    case Isa::sse4:
      return N_SSE4::shade(model, scene, frame, words, x0, y0, colors);
#endif
#if HWY_TARGETS & HWY_AVX2
    case Isa::avx2:
      return N_AVX2::shade(model, scene, frame, words, x0, y0, colors);
#endif
#if HWY_TARGETS & HWY_AVX3
    case Isa::avx512:
      return N_AVX3::shade(model, scene, frame, words, x0, y0, colors);
#endif
#if HWY_TARGETS & HWY_NEON
    case Isa::neon:
      return N_NEON::shade(model, scene, frame, words, x0, y0, colors);
#endif
    default:
      return false;
  }
}

}  // namespace rastrum::raster
#endif
