// SPDX-License-Identifier: BSD-3-Clause
// Ambient occlusion and its blur with Highway, per instruction set. A lane is a pixel of a row. It
// follows the plain kernels (occlusion.cpp) operation by operation, to the same bits.
#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/overlay/effects/occlusion_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>

#include <rastrum/overlay/effects/occlusion.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::overlay::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kPatternLanes>;
using I = hn::RebindToSigned<D>;
using V = hn::Vec<D>;

struct Position {
  V x, y, z;
};

struct Pixels {
  V px, py;  ///< centres
  Position p;
  V nx, ny, nz, reach, bias;
  V width, height;  ///< of the picture
  hn::Vec<I> place;
};

HWY_INLINE V across_of(const OcclusionFrame& f, V px, V py) {
  const D d;
  V along = hn::Mul(hn::Set(d, f.ux), px);
  // Only skewed cameras have this term. Adding 0 would change no bit.
  if (f.uy != 0) along = hn::Add(along, hn::Mul(hn::Set(d, f.uy), py));
  return hn::Add(along, hn::Set(d, f.u0));
}
HWY_INLINE V down_of(const OcclusionFrame& f, V py) {
  const D d;
  return hn::Add(hn::Mul(hn::Set(d, f.vy), py), hn::Set(d, f.v0));
}

HWY_INLINE Position position(const OcclusionFrame& f, V px, V py, V depth) {
  const D d;
  const V u = across_of(f, px, py), v = down_of(f, py);
  const V e = hn::Mul(depth, hn::Set(d, f.per_radius));
  if (!f.perspective) return {u, v, hn::Neg(e)};
  return {hn::Mul(u, e), hn::Mul(v, e), hn::Neg(e)};
}

HWY_INLINE V sum_of(V a, V b, V c) {
  return hn::Add(hn::Add(a, b), c);
}

/// The difference to a neighbour, for normal_from_depth. `found`: there is a surface.
struct Difference {
  V x, y, z;
  hn::Mask<D> found;
};

/// As in normal_from_depth.
template <bool kAcross>
HWY_INLINE Difference difference(const OcclusionFrame& f, const Pixels& at, V depth, V after,
                                 V before) {
  const D d;
  const V one = hn::Set(d, 1.0F);
  const V apart_after = hn::Abs(hn::Sub(after, depth)),
          apart_before = hn::Abs(hn::Sub(before, depth));
  // Comparisons with NaN are false, so a NaN is never near.
  const auto has_after = hn::Lt(apart_after, hn::Set(d, kFarthest));
  const V least = hn::IfThenElse(has_after, apart_after, hn::Set(d, kFarthest));
  const auto is_before = hn::Lt(apart_before, least);
  const auto found = hn::Or(is_before, has_after);
  const V there = hn::IfThenElse(is_before, before, after);
  const V step = hn::IfThenElse(is_before, hn::Neg(one), one);
  const Position q = kAcross ? position(f, hn::Add(at.px, step), at.py, there)
                             : position(f, at.px, hn::Add(at.py, step), there);
  // p − q is −(q − p), also after rounding.
  return {hn::Mul(hn::Sub(q.x, at.p.x), step), hn::Mul(hn::Sub(q.y, at.p.y), step),
          hn::Mul(hn::Sub(q.z, at.p.z), step), found};
}

/// normal_from_depth of the pixels from (x, y) on. All have neighbours on all sides.
HWY_INLINE void normals_from_depth(const OcclusionFrame& f, int x, int y, V depth, Pixels& at) {
  const D d;
  const float* row = f.depth.row(y) + x;
  const auto a = difference<true>(f, at, depth, hn::LoadU(d, row + 1), hn::LoadU(d, row - 1));
  const auto b = difference<false>(f, at, depth, hn::LoadU(d, f.depth.row(y + 1) + x),
                                   hn::LoadU(d, f.depth.row(y - 1) + x));
  const auto minor = [](V p, V q, V r, V s)
                         HWY_ATTR { return hn::Sub(hn::Mul(p, q), hn::Mul(r, s)); };
  const V nx = minor(b.y, a.z, b.z, a.y), ny = minor(b.z, a.x, b.x, a.z),
          nz = minor(b.x, a.y, b.y, a.x);
  const V square = sum_of(hn::Mul(nx, nx), hn::Mul(ny, ny), hn::Mul(nz, nz));
  const auto has = hn::And(hn::And(a.found, b.found), hn::Gt(square, hn::Zero(d)));
  const V length = hn::Sqrt(square);
  at.nx = hn::IfThenElseZero(has, hn::Div(nx, length));
  at.ny = hn::IfThenElseZero(has, hn::Div(ny, length));
  at.nz = hn::IfThenElseZero(has, hn::Div(nz, length));
}

/// Sample by sample.
struct Samples {
  static constexpr int kCapacity = kMostSamples * kPatternLanes;
  HWY_ALIGN std::int32_t places[kCapacity];  ///< offsets from f.depth.data
  HWY_ALIGN float depths[kCapacity];
  HWY_ALIGN float u[kCapacity];  ///< Lens; NaN beyond the picture
  HWY_ALIGN float v[kCapacity];
};

/// `kBorder`: samples may lie outside the picture. `pattern`: its first vector.
template <bool kBorder>
HWY_INLINE void find_samples(const OcclusionFrame& f, const Pixels& at, const float* pattern,
                             Samples& samples) {
  const D d;
  const I di;
  const auto stride = hn::Set(di, f.stride);
  const std::size_t lanes = hn::Lanes(d), count = static_cast<std::size_t>(f.samples) * lanes;
  for (std::size_t i = 0; i < count; i += lanes, pattern += 2 * kPatternLanes) {
    // Whole numbers below 2^23, so sums of them are exact.
    const V dx = hn::Round(hn::Mul(hn::Load(d, pattern), at.reach)),
            dy = hn::Round(hn::Mul(hn::Load(d, pattern + kPatternLanes), at.reach));
    const V qx = hn::Add(at.px, dx), qy = hn::Add(at.py, dy);
    auto place =
        hn::Add(at.place, hn::Add(hn::Mul(hn::NearestInt(dy), stride), hn::NearestInt(dx)));
    V u = across_of(f, qx, qy);
    if constexpr (kBorder) {
      const V zero = hn::Zero(d);
      const auto inside = hn::And(hn::And(hn::Gt(qx, zero), hn::Lt(qx, at.width)),
                                  hn::And(hn::Gt(qy, zero), hn::Lt(qy, at.height)));
      place = hn::IfThenElseZero(hn::RebindMask(di, inside), place);
      u = hn::IfThenElse(inside, u, hn::NaN(d));
    }
    hn::Store(place, di, samples.places + i);
    hn::Store(u, d, samples.u + i);
    hn::Store(down_of(f, qy), d, samples.v + i);
  }
}

template <bool kPerspective>
HWY_INLINE V taken(const OcclusionFrame& f, const Pixels& at, const Samples& samples) {
  const D d;
  const V one = hn::Set(d, 1.0F), farthest = hn::Set(d, kFarthest);
  const V per_radius = hn::Set(d, f.per_radius);
  const V away = hn::Neg(at.nz);  // z grows towards the viewer, distances do not
  const std::size_t lanes = hn::Lanes(d), count = static_cast<std::size_t>(f.samples) * lanes;
  V sum = hn::Zero(d);
  for (std::size_t i = 0; i < count; i += lanes) {
    const V depth = hn::Load(d, samples.depths + i), e = hn::Mul(depth, per_radius);
    V qx = hn::Load(d, samples.u + i), qy = hn::Load(d, samples.v + i);
    if constexpr (kPerspective) {
      qx = hn::Mul(qx, e);
      qy = hn::Mul(qy, e);
    }
    const V vx = hn::Sub(qx, at.p.x), vy = hn::Sub(qy, at.p.y), vz = hn::Add(e, at.p.z);
    const V vv = sum_of(hn::Mul(vx, vx), hn::Mul(vy, vy), hn::Mul(vz, vz));
    const V vn = sum_of(hn::Mul(vx, at.nx), hn::Mul(vy, at.ny), hn::Mul(vz, away));
    // Comparisons with NaN are false, which leaves out samples outside the picture.
    const auto takes =
        hn::And(hn::And(hn::Lt(depth, farthest), hn::Lt(vv, one)), hn::Gt(vn, at.bias));
    // Mostly no sample takes light: surfaces are flat or bend away.
    if (hn::AllFalse(d, takes)) continue;
    const V near = hn::Sub(one, vv);
    const V light = hn::Div(hn::Mul(hn::Mul(hn::Mul(near, near), near), hn::Sub(vn, at.bias)),
                            hn::Add(vv, hn::Set(d, kOcclusionEpsilon)));
    sum = hn::IfThenElse(takes, hn::Add(sum, light), sum);
  }
  return sum;
}

bool occlusion(const OcclusionFrame& f, int y, int begin, int end, float* out) {
  const D d;
  const I di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const V one = hn::Set(d, 1.0F), half = hn::Set(d, 0.5F), farthest = hn::Set(d, kFarthest);
  const bool own_normals = f.normals.empty();
  Pixels at;
  at.py = hn::Set(d, static_cast<float>(y) + 0.5F);
  at.width = hn::Set(d, static_cast<float>(f.depth.width));
  at.height = hn::Set(d, static_cast<float>(f.depth.height));
  Samples samples;
  bool some = false;
  int x = begin;
  for (; x + lanes <= end; x += lanes) {
    const V depth = hn::LoadU(d, f.depth.row(y) + x);
    const auto there = hn::Lt(depth, farthest);
    if (hn::AllFalse(d, there)) {
      hn::StoreU(one, d, out + x);
      continue;
    }
    some = true;
    if (own_normals &&
        (x == 0 || x + lanes == f.depth.width || y == 0 || y + 1 == f.depth.height)) {
      (void)occlusion_plain(f, y, x, x + lanes, out);
      continue;
    }
    const auto column = hn::Iota(di, x);
    at.px = hn::Add(hn::ConvertTo(d, column), half);
    at.p = position(f, at.px, at.py, depth);
    if (own_normals)
      normals_from_depth(f, x, y, depth, at);
    else
      hn::LoadInterleaved3(d, &f.normals(x, y).x, at.nx, at.ny, at.nz);
    const V spread = hn::Set(d, f.reach_px);
    // 0 without a surface, so that such pixels read nothing far away.
    at.reach = hn::IfThenElseZero(
        there, hn::Min(f.perspective ? hn::Div(spread, depth) : spread, hn::Set(d, f.most_px)));
    at.bias = hn::Sub(hn::Set(d, kOcclusionBias), hn::Mul(at.p.z, hn::Set(d, kBiasPerDistance)));
    at.place = hn::Add(column, hn::Set(di, y * f.stride));
    // An offset is less than the reach, and rounding adds at most 1/2.
    const int reach = static_cast<int>(hn::GetLane(hn::MaxOfLanes(d, at.reach))) + 2;
    const bool border =
        x < reach || x + lanes + reach > f.depth.width || y < reach || y + reach >= f.depth.height;
    const float* pattern = f.offsets(y, 0, 0) + x % kPatternLanes;
    if (border)
      find_samples<true>(f, at, pattern, samples);
    else
      find_samples<false>(f, at, pattern, samples);
    load_each(f.depth.data, samples.places, f.samples * lanes, samples.depths);
    const V sum = f.perspective ? taken<true>(f, at, samples) : taken<false>(f, at, samples);
    const V left = hn::Max(hn::Sub(one, hn::Mul(hn::Set(d, f.weight), sum)), hn::Zero(d));
    hn::StoreU(hn::IfThenElse(there, left, one), d, out + x);
  }
  return occlusion_plain(f, y, x, end, out) || some;
}

void blur(const OcclusionFrame& f, const float* in, int y, BlurTaps taps, int begin, int end,
          float* out) {
  const D d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const V one = hn::Set(d, 1.0F), zero = hn::Zero(d), farthest = hn::Set(d, kFarthest);
  const V per_radius = hn::Set(d, f.per_radius), sharpness = hn::Set(d, kBlurSharpness);
  const int dx = taps.down ? 0 : 1, dy = 1 - dx, width = f.depth.width;
  // The plain kernel does pixels whose taps leave the picture.
  const int first = std::min(end, std::max(begin, 2 * dx));
  blur_plain(f, in, y, taps, begin, first, out);
  const bool rows_inside = !taps.down || (y >= 2 && y + 2 < f.depth.height);
  int x = first;
  for (; rows_inside && x + lanes + 2 * dx <= width && x + lanes <= end; x += lanes) {
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
      sum = hn::Add(sum, hn::Mul(weight, hn::LoadU(d, in + x + i * taps.step)));
      weights = hn::Add(weights, weight);
    }
    hn::StoreU(hn::IfThenElse(there, hn::Div(sum, weights), one), d, out + x);
  }
  blur_plain(f, in, y, taps, x, end, out);
}

}  // namespace
}  // namespace rastrum::overlay::HWY_NAMESPACE
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
