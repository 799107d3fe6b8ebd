// SPDX-License-Identifier: BSD-3-Clause
// Normals and colours of spheres and tubes with Highway, compiled once per instruction set.
// Operations and order are those of point_on (rules/quadric_surface.cpp).

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/shade/quadric_lanes_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <cmath>

#include <rastrum/raster/kernels/wide_lanes-inl.hpp>
#include <rastrum/raster/shade/quadric_lanes.hpp>
#include <rastrum/raster/surface/seen_triangles-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2

constexpr int kStep = static_cast<int>(kLanes64);
constexpr unsigned kStepBits = (1U << kStep) - 1;
using Narrow = hn::Rebind<float, F64>;

std::uint64_t samples_of(const std::uint64_t* keys, std::uint64_t low) noexcept {
  return pixels_of(keys, low, ~std::uint64_t{0});
}

HWY_INLINE WideVec choose(WideMask mask, const WideVec& yes, const WideVec& no) {
  return {choose(mask, yes.x, no.x), choose(mask, yes.y, no.y), choose(mask, yes.z, no.z)};
}
HWY_INLINE WideVec unit_or(const WideVec& v, const WideVec& otherwise) {
  const W n = square_root(dot(v, v));
  return choose(below(wide(0), n), v * (wide(1) / n), otherwise);
}

/// QuadricPoint.
struct WideOnSurface {
  WideVec normal;
  W along;
};

/// point_on for a sphere or a hull: computed once a primitive, applied where rays meet it.
class Shape {
 public:
  explicit Shape(const QuadricShape& shape)
      : shape_(shape), between_(shape.p1 - shape.p0), is_hull_(shape.kind == QuadricKind::hull) {
    if (!is_hull_) return;
    distance_ = length(between_);
    axis_ = between_ * (1 / distance_);
    sine_ = (shape.r0 - shape.r1) / distance_;
    cosine_ = std::sqrt((1 - sine_) * (1 + sine_));
  }

  [[nodiscard]] HWY_INLINE WideOnSurface at(const WideVec& h, W h_w) const {
    const WideVec p = (h - wide(shape_.p0) * h_w) * (wide(1) / h_w);
    if (!is_hull_) return {unit_or(p, wide(Vec3d{0, 0, 1})), wide(shape_.along)};
    const WideVec axis = wide(axis_);
    const W t = dot(p, axis);
    const WideVec across = p - axis * t;
    const W radius = square_root(dot(across, across));
    const WideVec outwards = unit_or(across, wide(Vec3d{}));
    // Where the cone's normal at the point meets the axis.
    const W foot = t - radius * wide(sine_) / wide(cosine_);
    const WideMask first = at_most(foot, wide(0)), second = at_most(wide(distance_), foot);
    WideOnSurface on{outwards * wide(cosine_) + axis * wide(sine_), foot / wide(distance_)};
    if (is_any(second)) {
      on.normal = choose(second, unit_or(p - wide(between_), axis), on.normal);
      on.along = choose(second, wide(1), on.along);
    }
    if (is_any(first)) {
      on.normal = choose(first, unit_or(p, axis * wide(-1)), on.normal);
      on.along = choose(first, wide(0), on.along);
    }
    return on;
  }

 private:
  const QuadricShape& shape_;
  Vec3d between_, axis_;
  double distance_ = 0, sine_ = 0, cosine_ = 0;
  bool is_hull_;
};

/// The depths, relative to depth0, of the side whose depth is the lane's key's: the side that faces
/// the viewer if both have it.
HWY_INLINE W seen_at(const Quadric& q, const QuadricRow& row, W dx, const std::uint64_t* keys) {
  const Narrow df;
  const hn::RebindToUnsigned<I64> d64;
  const Surface front = surface_at(q, row, false, dx);
  auto depth = hn::DemoteTo(df, wide(q.depth0) + front.e);
  depth = hn::Min(hn::IfThenElseZero(hn::Gt(depth, hn::Zero(df)), depth), hn::Set(df, 1.0F));
  const auto wanted = hn::ShiftRight<kIdBits>(hn::Load(d64, keys));
  const auto found = hn::PromoteTo(d64, hn::BitCast(hn::RebindToUnsigned<Narrow>(), depth));
  const WideMask is_front = both(front.covered, hn::RebindMask(F64{}, hn::Eq(wanted, found)));
  if (hn::AllTrue(F64{}, is_front)) return front.e;
  return choose(is_front, front.e, surface_at(q, row, true, dx).e);
}

void fill(const QuadricSurface& surface, const float (&to_world)[3][3], const Vec4 (&colors)[2],
          const VisibleBlock& block, std::uint64_t mask, QuadricBlock& out) noexcept {
  const F64 d;
  const Narrow df;
  const RayFrame& r = surface.rays;
  const Shape shape(surface.shape);
  constexpr double kPx = 1.0 / kSubpixels;
  const double at_x = surface.place.x[0] * kPx, at_y = surface.place.y[0] * kPx;
  const float color[4][2] = {{colors[0].x, colors[1].x},
                             {colors[0].y, colors[1].y},
                             {colors[0].z, colors[1].z},
                             {colors[0].w, colors[1].w}};
  float* const color_out[4] = {out.lit.base[0], out.lit.base[1], out.lit.base[2], out.alpha};
  for (int first = 0; first < 64; first += kStep) {
    const auto bits = static_cast<unsigned>(mask >> first) & kStepBits;
    if (bits == 0) continue;
    const double dy = (block.y0 + first / kBlockSize + 0.5) - at_y;
    const W dx =
        hn::Iota(d, static_cast<double>(block.x0 + first % kBlockSize)) + wide(0.5) - wide(at_x);
    const QuadricRow row(surface.quadric, dy);
    const W e = seen_at(surface.quadric, row, dx, block.keys + first);
    const auto at = [&](double o, double x, double y, double depth) HWY_ATTR {
      return ((wide(o) + wide(x) * dx) + wide(y * dy)) + wide(depth) * e;
    };
    const WideVec h{at(r.o.v.x, r.x.v.x, r.y.v.x, r.depth.v.x),
                    at(r.o.v.y, r.x.v.y, r.y.v.y, r.depth.v.y),
                    at(r.o.v.z, r.x.v.z, r.y.v.z, r.depth.v.z)};
    const WideOnSurface on = shape.at(h, at(r.o.w, r.x.w, r.y.w, r.depth.w));
    const auto x = hn::DemoteTo(df, on.normal.x), y = hn::DemoteTo(df, on.normal.y);
    const auto z = hn::DemoteTo(df, on.normal.z), along = hn::DemoteTo(df, on.along);
    const auto rest = hn::Set(df, 1.0F) - along;
    const std::uint8_t memory[8] = {static_cast<std::uint8_t>(bits)};
    const auto lanes = hn::LoadMaskBits(df, memory);
    const auto store = [&](auto v, float* to) HWY_ATTR {
      hn::Store(hn::IfThenElse(lanes, v, hn::Load(df, to + first)), df, to + first);
    };
    for (int i = 0; i < 3; ++i)
      store(hn::Set(df, to_world[i][0]) * x + hn::Set(df, to_world[i][1]) * y +
                hn::Set(df, to_world[i][2]) * z,
            out.lit.n[i]);
    for (int i = 0; i < 4; ++i)
      store(hn::Set(df, color[i][0]) * rest + hn::Set(df, color[i][1]) * along, color_out[i]);
  }
}

constexpr QuadricLanes kQuadricLanes{samples_of, fill};

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::raster {

const QuadricLanes* quadric_lanes(Isa isa) noexcept {
  static constexpr const QuadricLanes* kLanes[] = RASTRUM_BY_ISA(kQuadricLanes, nullptr);
  return kLanes[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::raster
#endif
