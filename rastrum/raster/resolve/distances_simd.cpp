// SPDX-License-Identifier: BSD-3-Clause
// Distances of a block with Highway, compiled once per instruction set: float64, a pixel a lane,
// with distances_plain's operations and bits.
#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/resolve/distances_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <rastrum/raster/resolve/distances.hpp>
#include <rastrum/raster/resolve/surface_point.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using F64 = hn::CappedTag<double, 8>;
using F32 = hn::Rebind<float, F64>;
using D = hn::Vec<F64>;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(F64{}));

HWY_INLINE D line(double at0, double slope, D t) {
  const F64 d;
  return hn::Add(hn::Set(d, at0), hn::Mul(hn::Set(d, slope), t));
}

/// SurfaceScene::ray_length at the centres (x, y).
HWY_INLINE D ray_length(const SurfaceScene& scene, D x, double y) {
  const F64 d;
  const ViewRays& r = scene.lit.rays;
  const auto component = [&](float at0, float by_x, float by_y) HWY_ATTR {
    return hn::Neg(hn::Add(line(double{at0}, double{by_x}, x), hn::Set(d, double{by_y} * y)));
  };
  const D vx = component(r.d.x, r.dx.x, r.dy.x), vy = component(r.d.y, r.dx.y, r.dy.y),
          vz = component(r.d.z, r.dx.z, r.dy.z);
  const auto sum = [](D a, D b, D c) HWY_ATTR { return hn::Add(hn::Add(a, b), c); };
  const auto& z = scene.to_camera.m[2];
  return hn::Div(hn::Sqrt(sum(hn::Mul(vx, vx), hn::Mul(vy, vy), hn::Mul(vz, vz))),
                 sum(hn::Mul(hn::Set(d, z[0]), vx), hn::Mul(hn::Set(d, z[1]), vy),
                     hn::Mul(hn::Set(d, z[2]), vz)));
}

void distances(const SurfaceScene& scene, const std::uint64_t* keys, int x0, int y0, float nothing,
               float* view_depth, float* distance) {
  const F64 d;
  const F32 df;
  const hn::RebindToUnsigned<F64> du64;
  const hn::RebindToUnsigned<F32> du32;
  const DistanceByDepth& by = scene.distance_by_depth;
  const D p = hn::Set(d, by.p), q = hn::Set(d, by.q), r = hn::Set(d, by.r), s = hn::Set(d, by.s);
  const auto nowhere = hn::Set(df, nothing);
  for (int i = 0; i < 64; i += kLanes) {
    const auto bits = hn::TruncateTo(du32, hn::ShiftRight<kIdBits>(hn::Load(du64, keys + i)));
    const auto depth = hn::BitCast(df, bits);
    const auto there = hn::Gt(depth, hn::Zero(df));
    const D wide = hn::PromoteTo(d, depth);
    const D z = hn::Div(hn::Sub(p, hn::Mul(wide, q)), hn::Add(hn::Mul(wide, r), s));
    hn::Store(hn::IfThenElse(there, hn::DemoteTo(df, z), nowhere), df, view_depth + i);
    if (distance == nullptr) continue;
    const D x = hn::Add(hn::Iota(d, static_cast<double>(x0 + i % kBlockSize)), hn::Set(d, 0.5));
    const D along = hn::Mul(z, ray_length(scene, x, y0 + i / kBlockSize + 0.5));
    hn::Store(hn::IfThenElse(there, hn::DemoteTo(df, along), nowhere), df, distance + i);
  }
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::raster {

DistanceKernel distance_kernel(Isa isa) noexcept {
  static constexpr DistanceKernel kKernels[] = RASTRUM_BY_ISA(distances, &distances_plain);
  return kKernels[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::raster
#endif
