// Normals of spheres with Highway, compiled once per instruction set; see the header.

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/shade/sphere_lanes_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <rastrum/raster/kernels/lanes-inl.hpp>
#include <rastrum/raster/shade/sphere_lanes.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster {
namespace HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2

#include <rastrum/raster/kernels/wide_lanes-inl.hpp>
#include <rastrum/raster/setup/quadric_depth-inl.hpp>
#undef RASTRUM_LAMBDA
#undef RASTRUM_LANES

constexpr int kStep = static_cast<int>(kLanes64);
constexpr unsigned kStepBits = (1U << kStep) - 1;

std::uint64_t samples_of(const std::uint64_t* keys, std::uint64_t low) noexcept {
  const hn::RebindToUnsigned<I64> d;
  const auto id = hn::Set(d, low), mask = hn::Set(d, kIdMask);
  std::uint64_t found = 0;
  for (std::size_t i = 0; i < 64; i += kLanes64) {
    std::uint8_t bits = 0;
    hn::StoreMaskBits(d, hn::Eq(hn::And(hn::Load(d, keys + i), mask), id), &bits);
    found |= std::uint64_t{bits & kStepBits} << i;
  }
  return found;
}

void fill(const QuadricSurface& sphere, const float (&to_world)[3][3], Vec3 base,
          const VisibleBlock& block, std::uint64_t mask, LitBlock& out) noexcept {
  const F64 d;
  const hn::Rebind<float, F64> df;
  const hn::RebindToUnsigned<I64> d64;
  const Quadric& q = sphere.quadric;
  const RayFrame& r = sphere.rays;
  const WideVec centre = wide(sphere.shape.p0);
  constexpr double kPx = 1.0 / kSubpixels;
  const double at_x = sphere.place.x[0] * kPx, at_y = sphere.place.y[0] * kPx;
  const float bases[3] = {base.x, base.y, base.z};
  const W one = wide(1), zero = wide(0);
  for (int first = 0; first < 64; first += kStep) {
    const auto bits = static_cast<unsigned>(mask >> first) & kStepBits;
    if (bits == 0) continue;
    const double dy = (block.y0 + first / kBlockSize + 0.5) - at_y;
    const W dx =
        hn::Iota(d, static_cast<double>(block.x0 + first % kBlockSize)) + wide(0.5) - wide(at_x);
    const QuadricRow row(q, dy);
    const Roots roots = roots_of(q.part[0], row.part[0], dx);
    // Which of the two surfaces it is, its depth tells.
    auto depth = hn::DemoteTo(df, wide(q.depth0) + roots.enters);
    depth = hn::Min(hn::IfThenElseZero(hn::Gt(depth, hn::Zero(df)), depth), hn::Set(df, 1.0F));
    const auto seen = hn::ShiftRight<kIdBits>(hn::Load(d64, block.keys + first));
    const auto front = hn::PromoteTo(d64, hn::BitCast(hn::RebindToUnsigned<decltype(df)>(), depth));
    const WideMask is_front = both(roots.real, hn::RebindMask(d, hn::Eq(seen, front)));
    const W e = choose(is_front, roots.enters, roots.leaves);

    const auto at = [&](double o, double x, double y, double along) HWY_ATTR {
      return ((wide(o) + wide(x) * dx) + wide(y * dy)) + wide(along) * e;
    };
    const WideVec h{at(r.o.v.x, r.x.v.x, r.y.v.x, r.depth.v.x),
                    at(r.o.v.y, r.x.v.y, r.y.v.y, r.depth.v.y),
                    at(r.o.v.z, r.x.v.z, r.y.v.z, r.depth.v.z)};
    const W h_w = at(r.o.w, r.x.w, r.y.w, r.depth.w);
    const WideVec p = (h - centre * h_w) * (one / h_w);
    const W length = square_root(dot(p, p));
    const WideMask has_length = below(zero, length);
    const WideVec unit = p * (one / length);
    const auto narrow = [&](W v, W otherwise)
                            HWY_ATTR { return hn::DemoteTo(df, choose(has_length, v, otherwise)); };
    const auto x = narrow(unit.x, zero), y = narrow(unit.y, zero), z = narrow(unit.z, one);
    const std::uint8_t memory[8] = {static_cast<std::uint8_t>(bits)};
    const auto lanes = hn::LoadMaskBits(df, memory);
    for (int i = 0; i < 3; ++i) {
      const float* const m = to_world[i];
      const auto n = hn::Set(df, m[0]) * x + hn::Set(df, m[1]) * y + hn::Set(df, m[2]) * z;
      hn::Store(hn::IfThenElse(lanes, n, hn::Load(df, out.n[i] + first)), df, out.n[i] + first);
      hn::Store(hn::IfThenElse(lanes, hn::Set(df, bases[i]), hn::Load(df, out.base[i] + first)), df,
                out.base[i] + first);
    }
  }
}

constexpr SphereLanes kSphereLanes{samples_of, fill};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace rastrum::raster
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::raster {

const SphereLanes* sphere_lanes(Isa isa) noexcept {
  static constexpr const SphereLanes* kLanes[] = RASTRUM_BY_ISA(kSphereLanes, nullptr);
  return kLanes[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::raster
#endif
