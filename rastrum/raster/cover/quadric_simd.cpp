// Coverage and depth of quadrics with Highway, compiled once per instruction set: the body that the
// scalar form has (setup/quadric_depth-inl.hpp), several columns of a row at once.

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/cover/quadric_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include <rastrum/raster/cover/quadric_kernels-inl.hpp>
#include <rastrum/raster/kernels/lanes-inl.hpp>
#include <rastrum/raster/setup/quadric.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster {
namespace HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2

using W = D;
using WideMask = hn::Mask<F64>;
HWY_INLINE W wide(double v) {
  return hn::Set(F64{}, v);
}
HWY_INLINE W square_root(W v) {
  return hn::Sqrt(v);
}
HWY_INLINE W lesser(W a, W b) {
  return hn::Min(a, b);
}
HWY_INLINE W greater(W a, W b) {
  return hn::Max(a, b);
}
HWY_INLINE WideMask at_most(W a, W b) {
  return hn::Le(a, b);
}
HWY_INLINE WideMask both(WideMask a, WideMask b) {
  return hn::And(a, b);
}
HWY_INLINE WideMask either(WideMask a, WideMask b) {
  return hn::Or(a, b);
}
HWY_INLINE W choose(WideMask mask, W yes, W no) {
  return hn::IfThenElse(mask, yes, no);
}
#define RASTRUM_LANES HWY_INLINE
#include <rastrum/raster/setup/quadric_depth-inl.hpp>
#undef RASTRUM_LANES

/// Where the samples of a block lie from the place of a quadric's piece, px.
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

}  // namespace

std::uint64_t quadric_mask(const Piece& piece, int bx, int by, Rect within) noexcept {
  const Quadric& q = quadric_of(piece);
  const bool away = (piece.flags & kFacesAway) != 0;
  const QuadricSamples samples(piece);
  const int x0 = bx * kBlockSize, y0 = by * kBlockSize;
  const int first = std::max(within.x0 - x0, 0) / kStep * kStep;
  const int last = std::min(within.x1 - x0, kBlockSize);
  std::uint64_t mask = 0;
  for (int row = std::max(within.y0 - y0, 0); row < std::min(within.y1 - y0, kBlockSize); ++row) {
    const QuadricRow r(q, samples.row(y0 + row));
    for (int column = first; column < last; column += kStep) {
      std::uint8_t bits = 0;
      hn::StoreMaskBits(F64{}, surface_at(q, r, away, samples.columns(x0 + column)).covered, &bits);
      mask |= static_cast<std::uint64_t>(bits & ((1U << kLanes64) - 1))
              << (row * kBlockSize + column);
    }
  }
  return mask & samples_inside(within, bx, by);
}

void quadric_keys(const Piece& piece, const Block& block, std::uint64_t* keys) noexcept {
  const Quadric& q = quadric_of(piece);
  const bool away = (piece.flags & kFacesAway) != 0;
  const QuadricSamples samples(piece);
  const hn::Rebind<float, F64> df;
  const hn::RebindToUnsigned<I64> d64;
  const W depth0 = wide(q.depth0);
  for (std::uint64_t rest = block.mask; rest != 0;) {
    const int row = std::countr_zero(rest) / kBlockSize;
    rest &= ~(std::uint64_t{255} << (row * kBlockSize));
    const QuadricRow r(q, samples.row(block.by * kBlockSize + row));
    for (int column = 0; column < kBlockSize; column += kStep) {
      const W e = surface_at(q, r, away, samples.columns(block.bx * kBlockSize + column)).e;
      auto depth = hn::DemoteTo(df, depth0 + e);
      depth = hn::Min(hn::IfThenElseZero(hn::Gt(depth, hn::Zero(df)), depth), hn::Set(df, 1.0F));
      const auto high =
          hn::PromoteTo(d64, hn::BitCast(hn::RebindToUnsigned<decltype(df)>(), depth));
      hn::Store(hn::Or(hn::ShiftLeft<kIdBits>(high), hn::Set(d64, piece.low)), d64,
                keys + row * kBlockSize + column);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace rastrum::raster
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
