// Ambient occlusion and its blur with Highway, compiled once per instruction set: pixels of a row
// lie in lanes. It gives the plain kernels' bits (occlusion.cpp), operation by operation.
#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/overlay/effects/occlusion_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>

#include <rastrum/overlay/effects/occlusion.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::overlay {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kPatternLanes>;
using I = hn::RebindToSigned<D>;
using V = hn::Vec<D>;

struct Position {
  V x, y, z;
};

HWY_INLINE Position position(const OcclusionFrame& f, V px, V py, V depth) {
  const D d;
  const V u = hn::Add(hn::Add(hn::Mul(hn::Set(d, f.ux), px), hn::Mul(hn::Set(d, f.uy), py)),
                      hn::Set(d, f.u0));
  const V v = hn::Add(hn::Mul(hn::Set(d, f.vy), py), hn::Set(d, f.v0));
  const V e = hn::Mul(depth, hn::Set(d, f.per_radius));
  const V s = f.perspective ? e : hn::Set(d, 1.0F);
  return {hn::Mul(u, s), hn::Mul(v, s), hn::Neg(e)};
}

HWY_INLINE V sum_of(V a, V b, V c) {
  return hn::Add(hn::Add(a, b), c);
}

void occlusion(const OcclusionFrame& f, int y, int begin, int end, float* out) {
  const D d;
  const I di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const V one = hn::Set(d, 1.0F), zero = hn::Zero(d), half = hn::Set(d, 0.5F);
  const V farthest = hn::Set(d, kFarthest), epsilon = hn::Set(d, kOcclusionEpsilon);
  const auto width = hn::Set(di, f.depth.width), height = hn::Set(di, f.depth.height);
  const auto none = hn::Set(di, -1), stride = hn::Set(di, static_cast<int>(f.depth.stride));
  const auto row = hn::Set(di, y);
  const V py = hn::Add(hn::ConvertTo(d, row), half);
  int x = begin;
  for (; x + lanes <= end; x += lanes) {
    const V depth = hn::LoadU(d, f.depth.row(y) + x);
    const auto there = hn::Lt(depth, farthest);
    if (hn::AllFalse(d, there)) {
      hn::StoreU(one, d, out + x);
      continue;
    }
    const auto column = hn::Iota(di, x);
    const Position p = position(f, hn::Add(hn::ConvertTo(d, column), half), py, depth);
    V nx, ny, nz;
    hn::LoadInterleaved3(d, &f.normals(x, y).x, nx, ny, nz);
    const V spread = hn::Set(d, f.reach_px);
    const V reach = hn::Min(f.perspective ? hn::Div(spread, depth) : spread, hn::Set(d, f.most_px));
    const V bias = hn::Sub(hn::Set(d, kOcclusionBias), hn::Mul(p.z, hn::Set(d, kBiasPerDistance)));
    V sum = zero;
    for (int k = 0; k < f.samples; ++k) {
      const int lane = x % kPatternLanes;
      const auto qx =
          hn::Add(column, hn::NearestInt(hn::Mul(hn::LoadU(d, f.offsets(y, k, 0) + lane), reach)));
      const auto qy =
          hn::Add(row, hn::NearestInt(hn::Mul(hn::LoadU(d, f.offsets(y, k, 1) + lane), reach)));
      const auto inside = hn::And(hn::And(hn::Gt(qx, none), hn::Lt(qx, width)),
                                  hn::And(hn::Gt(qy, none), hn::Lt(qy, height)));
      const auto place = hn::IfThenElseZero(inside, hn::Add(hn::Mul(qy, stride), qx));
      const V q_depth = hn::GatherIndex(d, f.depth.data, place);
      const auto counts = hn::And(hn::RebindMask(d, inside), hn::Lt(q_depth, farthest));
      const Position q = position(f, hn::Add(hn::ConvertTo(d, qx), half),
                                  hn::Add(hn::ConvertTo(d, qy), half), q_depth);
      const V vx = hn::Sub(q.x, p.x), vy = hn::Sub(q.y, p.y), vz = hn::Sub(q.z, p.z);
      const V vv = sum_of(hn::Mul(vx, vx), hn::Mul(vy, vy), hn::Mul(vz, vz));
      const V vn = sum_of(hn::Mul(vx, nx), hn::Mul(vy, ny), hn::Mul(vz, nz));
      const V near = hn::Max(hn::Sub(one, vv), zero);
      const V takes =
          hn::Div(hn::Mul(hn::Mul(hn::Mul(near, near), near), hn::Max(hn::Sub(vn, bias), zero)),
                  hn::Add(vv, epsilon));
      sum = hn::IfThenElse(counts, hn::Add(sum, takes), sum);
    }
    const V left = hn::Max(hn::Sub(one, hn::Mul(hn::Set(d, f.weight), sum)), zero);
    hn::StoreU(hn::IfThenElse(there, left, one), d, out + x);
  }
  occlusion_plain(f, y, x, end, out);
}

void blur(const OcclusionFrame& f, ImageView<const float> in, int y, int dx, int dy, int begin,
          int end, float* out) {
  const D d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const V one = hn::Set(d, 1.0F), zero = hn::Zero(d), farthest = hn::Set(d, kFarthest);
  const V per_radius = hn::Set(d, f.per_radius), sharpness = hn::Set(d, kBlurSharpness);
  // What reaches beyond the picture is left to the plain form.
  const int first = std::min(end, std::max(begin, 2 * dx));
  blur_plain(f, in, y, dx, dy, begin, first, out);
  const bool rows_inside = dy == 0 || (y >= 2 && y + 2 < in.height);
  int x = first;
  for (; rows_inside && x + lanes + 2 * dx <= in.width && x + lanes <= end; x += lanes) {
    const V depth = hn::LoadU(d, f.depth.row(y) + x);
    const auto there = hn::Lt(depth, farthest);
    if (hn::AllFalse(d, there)) {
      hn::StoreU(one, d, out + x);
      continue;
    }
    V sum = zero, weights = zero;
    for (int i = -2; i <= 2; ++i) {
      const V q_depth = hn::LoadU(d, f.depth.row(y + i * dy) + x + i * dx);
      const V apart = hn::Mul(hn::Abs(hn::Sub(q_depth, depth)), per_radius);
      const V share = hn::Set(d, i == -2 || i == 2 ? 0.5F : 1.0F);
      const V weight = hn::Mul(share, hn::Max(hn::Sub(one, hn::Mul(apart, sharpness)), zero));
      sum = hn::Add(sum, hn::Mul(weight, hn::LoadU(d, in.row(y + i * dy) + x + i * dx)));
      weights = hn::Add(weights, weight);
    }
    hn::StoreU(hn::IfThenElse(there, hn::Div(sum, weights), one), d, out + x);
  }
  blur_plain(f, in, y, dx, dy, x, end, out);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace rastrum::overlay
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::overlay {

OcclusionKernel occlusion_kernel(Isa isa) noexcept {
  static constexpr OcclusionKernel kKernels[] = RASTRUM_BY_ISA(occlusion, &occlusion_plain);
  return kKernels[static_cast<std::size_t>(isa)];
}

BlurKernel blur_kernel(Isa isa) noexcept {
  static constexpr BlurKernel kKernels[] = RASTRUM_BY_ISA(blur, &blur_plain);
  return kKernels[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::overlay
#endif
