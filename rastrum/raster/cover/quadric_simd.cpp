// SPDX-License-Identifier: BSD-3-Clause
// Coverage and depth of quadrics with Highway, compiled once per instruction set: the scalar form's
// body (rules/quadric_depth.inl), several columns of a row at once.

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/cover/quadric_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include <rastrum/raster/cover/quadric_kernels-inl.hpp>
#include <rastrum/raster/kernels/wide_lanes-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2

/// A block's samples relative to a quadric's place, px.
struct QuadricSamples {
  double x0, y0;

  HWY_INLINE explicit QuadricSamples(const Piece& p)
      : x0(p.x[0] * (1.0 / kSubpixels)), y0(p.y[0] * (1.0 / kSubpixels)) {}
  [[nodiscard]] HWY_INLINE double row(int y) const { return (y + 0.5) - y0; }
  /// kLanes64 columns from x on.
  [[nodiscard]] HWY_INLINE W columns(int x) const {
    return hn::Iota(F64{}, static_cast<double>(x)) + wide(0.5) - wide(x0);
  }
};

constexpr int kStep = static_cast<int>(kLanes64);
constexpr std::uint64_t kStepBits = (std::uint64_t{1} << kStep) - 1;

/// Calls use(row, column, surface) for the steps of block (bx, by) with a bit of `wanted`. Selects
/// the kind of quadric once.
template <class Use>
HWY_INLINE void for_each_step(const Piece& piece, int bx, int by, std::uint64_t wanted,
                              const Use& use) {
  const Quadric& q = quadric_of(piece);
  const bool away = (piece.flags & kFacesAway) != 0;
  const QuadricSamples samples(piece);
  W columns[kBlockSize / kLanes64];
  for (int k = 0; k < kBlockSize / kStep; ++k)
    columns[k] = samples.columns(bx * kBlockSize + k * kStep);
  const auto each = [&](const auto& surface_of) HWY_ATTR {
    for (std::uint64_t rest = wanted; rest != 0;) {
      const int row = std::countr_zero(rest) / kBlockSize;
      const std::uint64_t bits = rest >> (row * kBlockSize) & 255U;
      rest &= ~(std::uint64_t{255} << (row * kBlockSize));
      const QuadricRow r(q, samples.row(by * kBlockSize + row));
      for (int k = 0; k < kBlockSize / kStep; ++k)
        if ((bits >> (k * kStep) & kStepBits) != 0) use(row, k * kStep, surface_of(r, columns[k]));
    }
  };
  if (!q.is_plain)
    return each([&](const QuadricRow& r, W dx) HWY_ATTR { return surface_at(q, r, away, dx); });
  each([&](const QuadricRow& r, W dx) HWY_ATTR {
    const Roots roots = roots_of(q.part[0], r.part[0], dx);
    return Surface{away ? roots.leaves : roots.enters, roots.real};
  });
}

}  // namespace

std::uint64_t quadric_mask(const Piece& piece, int bx, int by, Rect within) noexcept {
  const std::uint64_t wanted = samples_inside(within, bx, by);
  std::uint64_t mask = 0;
  for_each_step(piece, bx, by, wanted, [&](int row, int column, const Surface& s) HWY_ATTR {
    std::uint8_t bits = 0;
    hn::StoreMaskBits(F64{}, s.covered, &bits);
    mask |= (bits & kStepBits) << (row * kBlockSize + column);
  });
  return mask & wanted;
}

void quadric_keys(const Piece& piece, const Block& block, std::uint64_t* keys) noexcept {
  const hn::Rebind<float, F64> df;
  const hn::RebindToUnsigned<I64> d64;
  const W depth0 = wide(quadric_of(piece).depth0);
  const auto low = hn::Set(d64, piece.low);
  for_each_step(
      piece, block.bx, block.by, block.mask, [&](int row, int column, const Surface& s) HWY_ATTR {
        auto depth = hn::DemoteTo(df, depth0 + s.e);
        depth = hn::Min(hn::IfThenElseZero(hn::Gt(depth, hn::Zero(df)), depth), hn::Set(df, 1.0F));
        const auto high =
            hn::PromoteTo(d64, hn::BitCast(hn::RebindToUnsigned<decltype(df)>(), depth));
        hn::Store(hn::Or(hn::ShiftLeft<kIdBits>(high), low), d64, keys + row * kBlockSize + column);
      });
}

}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
