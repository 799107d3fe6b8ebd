// Surfaces of triangles with Highway, compiled once per instruction set; see the header. A pixel a
// lane of float64.
#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/resolve/surface_lanes_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <cstddef>

#include <rastrum/raster/resolve/surface_lanes.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2
namespace hn = hwy::HWY_NAMESPACE;

using F64 = hn::CappedTag<double, 8>;
using I64 = hn::RebindToSigned<F64>;
using F32 = hn::Rebind<float, F64>;
using D = hn::Vec<F64>;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(F64{}));
static_assert(64 % kLanes == 0);

/// A vector in each lane.
struct Vectors {
  D x, y, z;
};

HWY_INLINE D set(double v) {
  return hn::Set(F64{}, v);
}
HWY_INLINE D dot(D x, D y, D z, const Vectors& v) {
  return x * v.x + y * v.y + z * v.z;
}
template <class Row>
HWY_INLINE D row_of(const Row& m, const Vectors& v) {
  return dot(set(double{m[0]}), set(double{m[1]}), set(double{m[2]}), v);
}
HWY_INLINE void store(const Vectors& v, Vec3* to) {
  const F32 df;
  hn::StoreInterleaved3(hn::DemoteTo(df, v.x), hn::DemoteTo(df, v.y), hn::DemoteTo(df, v.z), df,
                        &to->x);
}

/// Number `number` of each lane's triangle.
struct Gathered {
  const double* all;
  hn::Vec<I64> place;
  HWY_INLINE D operator()(std::size_t number) const {
    return hn::GatherIndex(F64{}, all + number, place);
  }
};
/// The same where all lanes have one.
struct Shared {
  const double* triangle;
  HWY_INLINE D operator()(std::size_t number) const { return set(triangle[number]); }
};

/// shares_at.
template <class Numbers>
HWY_INLINE void shares(const Numbers& number, D x, D y, D (&b)[3]) {
  using T = SurfaceRun::Triangle;
  constexpr std::size_t kR = offsetof(T, r) / 8, kP = offsetof(T, p) / 8, kQ = offsetof(T, q) / 8;
  const D zero = hn::Zero(F64{}), one = set(1);
  const D dx = x - number(0), dy = y - number(1);
  D sum = zero, inside = zero;
  for (std::size_t c = 0; c < 3; ++c) {
    b[c] = number(kR + c) + number(kP + c) * dx + number(kQ + c) * dy;
    sum = sum + b[c];
  }
  for (D& share : b) {
    share = share / sum;
    share = hn::IfThenElseZero(share > zero, hn::IfThenElse(share < one, share, one));
    inside = inside + share;
  }
  for (D& share : b) share = share / inside;
}

/// Σ bᵢ vᵢ of the corners' vectors that begin at number `first`.
template <class Numbers>
HWY_INLINE Vectors interpolate(const Numbers& number, std::size_t first, const D (&b)[3]) {
  const auto axis = [&](std::size_t a) HWY_ATTR {
    return number(first + a) * b[0] + number(first + 3 + a) * b[1] + number(first + 6 + a) * b[2];
  };
  return {axis(0), axis(1), axis(2)};
}

template <class Numbers>
HWY_INLINE void pixels(SurfaceRun& run, int k, const Numbers& number) {
  using T = SurfaceRun::Triangle;
  const F64 d;
  const F32 df;
  const D x = hn::LoadU(d, run.x + k), y = hn::LoadU(d, run.y + k);
  D b[3];
  shares(number, x, y, b);
  hn::StoreU(hn::DemoteTo(df, b[1]), df, run.b1 + k);
  hn::StoreU(hn::DemoteTo(df, b[2]), df, run.b2 + k);
  if (run.object_to_world != nullptr) {
    const Vectors p = interpolate(number, offsetof(T, position) / 8, b);
    const auto& m = run.object_to_world->m;
    store({row_of(m[0], p) + set(m[0][3]), row_of(m[1], p) + set(m[1][3]),
           row_of(m[2], p) + set(m[2][3])},
          run.position + k);
  }
}

void fill(SurfaceRun& run) noexcept {
  const auto* const all = reinterpret_cast<const double*>(run.triangles);
  // Lanes beyond the last pixel repeat it.
  for (int k = run.n; k < run.n + kLanes; ++k) {
    run.x[k] = run.x[run.n - 1];
    run.y[k] = run.y[run.n - 1];
    run.place[k] = run.place[run.n - 1];
  }
  // Gathering what a triangle has takes three times as long as all that is computed of it: so as
  // soon as a few lanes have one triangle they are computed alone, and what is written beyond them
  // is written again.
  constexpr int kAlone = kLanes == 8 ? 3 : 1;
  for (int k = 0; k < run.n;) {
    const std::int64_t first = run.place[k];
    int end = k + 1;
    while (end < run.n && run.place[end] == first) ++end;
    if (end - k < kAlone) {
      pixels(run, k, Gathered{all, hn::LoadU(I64{}, run.place + k)});
      k += kLanes;
      continue;
    }
    for (; k < end; k += kLanes) pixels(run, k, Shared{all + first});
    k = end;
  }
}

std::uint64_t same(const std::uint64_t* keys, std::uint64_t id) noexcept {
  using U64 = hn::RebindToUnsigned<I64>;
  const U64 d;
  const auto wanted = hn::Set(d, kIdMask - id), ids = hn::Set(d, kIdMask);
  std::uint64_t found = 0;
  for (int i = 0; i < 64; i += kLanes) {
    std::uint8_t bits = 0;
    hn::StoreMaskBits(d, hn::Eq(hn::And(hn::LoadU(d, keys + i), ids), wanted), &bits);
    found |= std::uint64_t{bits & ((1U << kLanes) - 1)} << i;
  }
  return found;
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::raster {

SurfaceLanes surface_lanes(Isa isa) noexcept {
  static constexpr SurfaceLanes kKernels[] = RASTRUM_BY_ISA(fill, nullptr);
  return kKernels[static_cast<std::size_t>(isa)];
}

SameId same_id(Isa isa) noexcept {
  static constexpr SameId kKernels[] = RASTRUM_BY_ISA(same, nullptr);
  return kKernels[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::raster
#endif
