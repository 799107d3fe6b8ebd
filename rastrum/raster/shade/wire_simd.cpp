// Shader::wireframe with Highway, compiled once per instruction set: a block at a time. Its
// triangles are found first, each once, and set up several at a time, a triangle a lane; then each
// visits the rows of its samples, a sample a lane. The operations are those of wire.cpp and
// interpolate.hpp.

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/shade/wire_simd.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include <rastrum/raster/shade/lit_constants.hpp>
#include <rastrum/raster/shade/wire.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2
namespace hn = hwy::HWY_NAMESPACE;

using F64 = hn::CappedTag<double, 8>;
using U64 = hn::RebindToUnsigned<F64>;
using F32 = hn::Rebind<float, F64>;
using I32 = hn::Rebind<std::int32_t, F64>;
using D = hn::Vec<F64>;
using F = hn::Vec<F32>;
constexpr std::size_t kLanes = hn::MaxLanes(F64{});
constexpr std::size_t kGroups = 8 / kLanes;  ///< vectors in a row of a block
constexpr std::uint64_t kLaneBits = (std::uint64_t{1} << kLanes) - 1;

struct Planes {
  alignas(64) double p[3][64], q[3][64], r[3][64];

  void set(std::size_t k, const WeightPlanes& w) {
    for (int i = 0; i < 3; ++i) {
      p[i][k] = w.p[i];
      q[i][k] = w.q[i];
      r[i][k] = w.r[i];
    }
  }
};

/// The triangles of a block, a column each, in no order that matters.
struct WireBlock {
  std::uint64_t seen[64];  ///< samples
  std::uint64_t id[64];
  const Draw* draw[64];
  std::uint32_t vertex[64][3];
  alignas(64) std::int32_t x[3][64], y[3][64];  ///< n.8
  alignas(64) float inv_w[3][64];
  alignas(64) double x0[64], y0[64];  ///< where planes begin
  Planes weights;                     ///< as weight_planes has them
  Planes distances;                   ///< the same in px from the edges
  std::uint64_t clipped = 0;          ///< columns whose planes were set one by one
  std::size_t n = 0;
};

template <class Tag>
HWY_INLINE hn::Mask<Tag> lanes_of(Tag d, std::uint64_t bits) {
  // LoadMaskBits reads whole bytes.
  const std::uint8_t memory[8] = {static_cast<std::uint8_t>(bits & kLaneBits)};
  return hn::LoadMaskBits(d, memory);
}

/// The low parts of a block's keys.
struct LowParts {
  hn::Vec<U64> v[64 / kLanes];

  explicit HWY_INLINE LowParts(const std::uint64_t* keys) {
    const U64 d;
    for (std::size_t i = 0; i < 64 / kLanes; ++i)
      v[i] = hn::And(hn::Load(d, keys + i * kLanes), hn::Set(d, kIdMask));
  }
  /// The samples whose keys end in `low`.
  [[nodiscard]] HWY_INLINE std::uint64_t samples_of(std::uint64_t low) const {
    const U64 d;
    const auto wanted = hn::Set(d, low);
    std::uint64_t found = 0;
    for (std::size_t i = 0; i < 64 / kLanes; ++i) {
      std::uint8_t bits = 0;
      hn::StoreMaskBits(d, hn::Eq(v[i], wanted), &bits);
      found |= (bits & kLaneBits) << (i * kLanes);
    }
    return found;
  }
};

/// A loop for each step, so that what is read at random is waited for by several triangles at once.
void find_triangles(const FrameGeometry& frame, const VisibleBlock& block, WireBlock& w) {
  const LowParts parts(block.keys);
  const Draw* draw = nullptr;
  for (std::uint64_t rest = block.covered; rest != 0; ++w.n) {
    const std::uint64_t low = block.keys[std::countr_zero(rest)] & kIdMask;
    const std::uint64_t id = kIdMask - low;
    if (draw == nullptr || id < draw->first_id || id - draw->first_id >= draw->primitive_count)
      draw = &frame.draw_of(id);
    w.draw[w.n] = draw;
    w.id[w.n] = id;
    if (draw->mesh == nullptr && !draw->is_copied() && !draw->indices.empty())
      hwy::Prefetch(draw->indices.data() + static_cast<std::size_t>(id - draw->first_id) * 3);
    w.seen[w.n] = parts.samples_of(low) & rest;
    rest &= ~w.seen[w.n];
  }
  for (std::size_t k = 0; k < w.n; ++k) {
    w.draw[k]->vertices(w.id[k] - w.draw[k]->first_id, w.vertex[k]);
    if (const ProjectedVertex* const all = frame.projected_of(*w.draw[k]))
      for (const std::uint32_t v : w.vertex[k]) hwy::Prefetch(all + v);
  }
  for (std::size_t k = 0; k < w.n; ++k) {
    bool is_clipped = false;
    for (int c = 0; c < 3; ++c) {
      const ProjectedVertex v = frame.vertex(*w.draw[k], w.vertex[k][c]);
      w.x[c][k] = v.x_fx8;
      w.y[c][k] = v.y_fx8;
      w.inv_w[c][k] = v.inv_w;
      is_clipped |= v.x_fx8 == kNeedsClip;
    }
    w.clipped |= std::uint64_t{is_clipped} << k;
    if (is_clipped) w.weights.set(k, weight_planes(frame, *w.draw[k], w.vertex[k]));
  }
  // Whole vectors of triangles.
  for (std::size_t k = w.n; k % kLanes != 0; ++k)
    for (int c = 0; c < 3; ++c) {
      w.x[c][k] = w.x[c][w.n - 1];
      w.y[c][k] = w.y[c][w.n - 1];
      w.inv_w[c][k] = w.inv_w[c][w.n - 1];
    }
}

/// weight_planes of triangles [k, k + kLanes), but for those that were clipped.
HWY_INLINE void set_weights(WireBlock& w, std::size_t k) {
  const F64 d;
  const I32 di;
  const D px = hn::Set(d, 1.0 / kSubpixels);
  const auto x = [&](int c) HWY_ATTR { return hn::Load(di, w.x[c] + k); };
  const auto y = [&](int c) HWY_ATTR { return hn::Load(di, w.y[c] + k); };
  const auto inv_w = [&](int c)
                         HWY_ATTR { return hn::PromoteTo(d, hn::Load(F32{}, w.inv_w[c] + k)); };
  const auto between = [&](auto a, auto b) HWY_ATTR { return hn::PromoteTo(d, a - b) * px; };
  const D e1x = between(x(1), x(0)), e1y = between(y(1), y(0));
  const D e2x = between(x(2), x(0)), e2y = between(y(2), y(0));
  const D inv_det = hn::Set(d, 1.0) / (e1x * e2y - e2x * e1y);
  const auto unclipped = hn::Not(lanes_of(d, w.clipped >> k));
  const auto store = [&](D v, double* to) HWY_ATTR {
    if ((w.clipped >> k & kLaneBits) == 0)
      hn::Store(v, d, to + k);
    else
      hn::BlendedStore(v, unclipped, d, to + k);
  };
  const D zero = hn::Zero(d);
  hn::Store(hn::IfThenElseZero(unclipped, hn::PromoteTo(d, x(0)) * px), d, w.x0 + k);
  hn::Store(hn::IfThenElseZero(unclipped, hn::PromoteTo(d, y(0)) * px), d, w.y0 + k);
  const D p1 = e2y * inv_det, q1 = hn::Neg(e2x) * inv_det;
  const D p2 = hn::Neg(e1y) * inv_det, q2 = e1x * inv_det;
  const D w0 = inv_w(0), w1 = inv_w(1), w2 = inv_w(2);
  store(w0, w.weights.r[0]);
  store(zero, w.weights.r[1]);
  store(zero, w.weights.r[2]);
  store(hn::Neg(p1 + p2) * w0, w.weights.p[0]);
  store(hn::Neg(q1 + q2) * w0, w.weights.q[0]);
  store(p1 * w1, w.weights.p[1]);
  store(q1 * w1, w.weights.q[1]);
  store(p2 * w2, w.weights.p[2]);
  store(q2 * w2, w.weights.q[2]);
}

/// wire_share's planes of triangles [k, k + kLanes).
HWY_INLINE void set_distances(WireBlock& w, std::size_t k) {
  const F64 d;
  for (int i = 0; i < 3; ++i) {
    const D p = hn::Load(d, w.weights.p[i] + k), q = hn::Load(d, w.weights.q[i] + k);
    const D square = p * p + q * q;
    const auto has_slope = square > hn::Zero(d);
    const D scale = hn::Set(d, 1.0) / hn::Sqrt(square);
    const D r = hn::Load(d, w.weights.r[i] + k) * scale;
    hn::Store(hn::IfThenElseZero(has_slope, p * scale), d, w.distances.p[i] + k);
    hn::Store(hn::IfThenElseZero(has_slope, q * scale), d, w.distances.q[i] + k);
    hn::Store(hn::IfThenElse(has_slope, r, hn::Set(d, kNoEdge)), d, w.distances.r[i] + k);
  }
}

/// Where the samples of a block are, px.
struct Places {
  alignas(64) double x[64], y[64];

  explicit Places(const VisibleBlock& block) {
    const F64 d;
    for (std::size_t i = 0; i < 64; i += kLanes) {
      D px =
          hn::Iota(d, static_cast<double>(block.x0) + static_cast<double>(i % 8)) + hn::Set(d, 0.5);
      D py = hn::Set(d, static_cast<double>(block.y0) + static_cast<double>(i / 8) + 0.5);
      if (block.points != nullptr) {
        px = px + hn::PromoteTo(d, hn::Load(F32{}, block.points->dx + i));
        py = py + hn::PromoteTo(d, hn::Load(F32{}, block.points->dy + i));
      }
      hn::Store(px, d, x + i);
      hn::Store(py, d, y + i);
    }
  }
};

/// Calls use(first, lanes) for the vectors of a block that hold some of `samples`.
template <class Use>
HWY_INLINE void for_each_vector(std::uint64_t samples, const Use& use) {
  while (samples != 0) {
    const auto first = static_cast<std::size_t>(std::countr_zero(samples)) / kLanes * kLanes;
    use(first, samples >> first & kLaneBits);
    samples &= ~(kLaneBits << first);
  }
}

/// Distances to the nearest edge of column k at its samples. `kCentred`: those of a column of the
/// block have one x.
template <bool kCentred>
HWY_INLINE void visit(const WireBlock& w, std::size_t k, const Places& at, double* nearest) {
  const F64 d;
  const Planes& planes = w.distances;
  const D x0 = hn::Set(d, w.x0[k]), y0 = hn::Set(d, w.y0[k]);
  D q[3], along[3][kGroups];
  for (int i = 0; i < 3; ++i) q[i] = hn::Set(d, planes.q[i][k]);
  const auto set_along = [&](std::size_t first) HWY_ATTR {
    const D dx = hn::Load(d, at.x + first) - x0;
    for (int i = 0; i < 3; ++i)
      along[i][first / kLanes % kGroups] =
          hn::Set(d, planes.r[i][k]) + hn::Set(d, planes.p[i][k]) * dx;
  };
  if constexpr (kCentred)
    for (std::size_t g = 0; g < kGroups; ++g) set_along(g * kLanes);
  for_each_vector(w.seen[k], [&](std::size_t first, std::uint64_t bits) HWY_ATTR {
    if constexpr (!kCentred) set_along(first);
    const D dy = hn::Load(d, at.y + first) - y0;
    D least = hn::Set(d, kNoEdge);
    for (int i = 0; i < 3; ++i) {
      const D away = hn::Abs(along[i][first / kLanes % kGroups] + q[i] * dy);
      least = hn::IfThenElse(hn::Lt(away, least), away, least);  // NaN is no distance
    }
    hn::BlendedStore(least, lanes_of(d, bits), d, nearest + first);
  });
}

/// The base colours of column k at its samples, as wire_base has them.
void set_base(const LitScene& scene, const WireBlock& w, std::size_t k, const Places& at,
              float (&base)[3][64]) {
  const F64 d;
  const F32 df;
  const Draw& draw = *w.draw[k];
  const Draw::OfCopy triangle = draw.of_copy(w.id[k] - draw.first_id);
  std::uint32_t vertex[3];
  for (int i = 0; i < 3; ++i) vertex[i] = w.vertex[k][i] - draw.first_vertex_of(triangle.copy);
  WireColors c;
  fetch_wire_colors(scene, draw, triangle, vertex, c);
  const float own[3] = {c.base.x, c.base.y, c.base.z};
  const D x0 = hn::Set(d, w.x0[k]), y0 = hn::Set(d, w.y0[k]), zero = hn::Zero(d);
  const D one = hn::Set(d, 1.0);
  for_each_vector(w.seen[k], [&](std::size_t first, std::uint64_t bits) HWY_ATTR {
    F color[3];
    for (int i = 0; i < 3; ++i) color[i] = hn::Set(df, own[i]);
    if (c.interpolates) {
      const D dx = hn::Load(d, at.x + first) - x0, dy = hn::Load(d, at.y + first) - y0;
      D b[3];
      D sum = zero, inside = zero;
      for (int i = 0; i < 3; ++i) {
        b[i] = hn::Set(d, w.weights.r[i][k]) + hn::Set(d, w.weights.p[i][k]) * dx +
               hn::Set(d, w.weights.q[i][k]) * dy;
        sum = sum + b[i];
      }
      for (D& share : b) {
        share = share / sum;
        share = hn::IfThenElseZero(share > zero, hn::IfThenElse(share < one, share, one));
        inside = inside + share;
      }
      F mixed[3] = {hn::Zero(df), hn::Zero(df), hn::Zero(df)};
      for (int i = 0; i < 3; ++i) {
        const F share = hn::DemoteTo(df, b[i] / inside);
        const float corner[3] = {c.corner[i].x, c.corner[i].y, c.corner[i].z};
        for (int j = 0; j < 3; ++j) mixed[j] = mixed[j] + hn::Set(df, corner[j]) * share;
      }
      for (int j = 0; j < 3; ++j) color[j] = color[j] * mixed[j];
    }
    const auto lanes = lanes_of(df, bits);
    for (int j = 0; j < 3; ++j) hn::BlendedStore(color[j], lanes, df, base[j] + first);
  });
}

void shade_wires(const LitScene& scene, const FrameGeometry& frame, const VisibleBlock& block,
                 BlockColors& colors) noexcept {
  const F64 d;
  const F32 df;
  WireBlock w;
  find_triangles(frame, block, w);
  for (std::size_t k = 0; k < w.n; k += kLanes) {
    set_weights(w, k);
    set_distances(w, k);
  }
  const Places at(block);
  alignas(64) double nearest[64];
  alignas(64) float base[3][64];
  if (block.covered != ~std::uint64_t{0}) std::fill_n(nearest, 64, kNoEdge);
  for (std::size_t k = 0; k < w.n; ++k)
    if (block.points == nullptr)
      visit<true>(w, k, at, nearest);
    else
      visit<false>(w, k, at, nearest);
  if (scene.colored) {
    if (block.covered != ~std::uint64_t{0}) std::fill_n(base[0], 3 * 64, 0.0F);
    for (std::size_t k = 0; k < w.n; ++k) set_base(scene, w, k, at, base);
  }
  const float plain[3] = {kDefaultBase.x, kDefaultBase.y, kDefaultBase.z};
  const float wire[3] = {kWireColor.x, kWireColor.y, kWireColor.z};
  float* const to[3] = {colors.r, colors.g, colors.b};
  for (std::size_t i = 0; i < 64; i += kLanes) {
    const D away = hn::Load(d, nearest + i), one = hn::Set(d, 1.0);
    const F line = hn::DemoteTo(df, hn::IfThenElseZero(away < one, one - away));
    const F rest = hn::Set(df, 1.0F) - line;
    for (int c = 0; c < 3; ++c) {
      const F from = scene.colored ? hn::Load(df, base[c] + i) : hn::Set(df, plain[c]);
      hn::Store(from * rest + hn::Set(df, wire[c]) * line, df, to[c] + i);
    }
  }
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::raster {

bool shade_wire_simd(Isa isa, const LitScene& scene, const FrameGeometry& frame,
                     const VisibleBlock& block, BlockColors& colors) noexcept {
  using Shade = void (*)(const LitScene&, const FrameGeometry&, const VisibleBlock&, BlockColors&);
  static constexpr Shade kShade[] = RASTRUM_BY_ISA(shade_wires, nullptr);
  const Shade shade = kShade[static_cast<std::size_t>(isa)];
  if (shade != nullptr) shade(scene, frame, block, colors);
  return shade != nullptr;
}

}  // namespace rastrum::raster
#endif
