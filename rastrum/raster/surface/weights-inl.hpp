// SPDX-License-Identifier: BSD-3-Clause
// Weights of triangles' corners, a triangle a lane, and the points of pixels that they are for. The
// lit shaders use float32 where it is good enough (lit_seen-inl.hpp), all else interpolate.hpp's
// float64. Operations, order and bits are the scalar forms'.
#if defined(RASTRUM_RASTER_SURFACE_WEIGHTS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_SURFACE_WEIGHTS_INL_HPP
#undef RASTRUM_RASTER_SURFACE_WEIGHTS_INL_HPP
#else
#define RASTRUM_RASTER_SURFACE_WEIGHTS_INL_HPP
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/draws/interpolate.hpp>
#include <rastrum/raster/surface/seen_planes.hpp>
#include <rastrum/raster/surface/seen_triangles-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

using HalfF32 = hn::Half<F32>;
constexpr std::size_t kHalf = kLanes / 2;

/// kLanes numbers of float64.
struct Wide {
  D lower, upper;
};
HWY_INLINE Wide load_wide(const double* p) {
  return {hn::Load(F64{}, p), hn::Load(F64{}, p + kHalf)};
}
HWY_INLINE void store(const Wide& v, double* p) {
  hn::Store(v.lower, F64{}, p);
  hn::Store(v.upper, F64{}, p + kHalf);
}
HWY_INLINE Wide wide(double v) {
  return {hn::Set(F64{}, v), hn::Set(F64{}, v)};
}
HWY_INLINE Wide wide(F v) {
  return {hn::PromoteTo(F64{}, hn::LowerHalf(HalfF32{}, v)),
          hn::PromoteTo(F64{}, hn::UpperHalf(HalfF32{}, v))};
}
HWY_INLINE Wide wide(I v) {
  const hn::Half<I32> half;
  return {hn::PromoteTo(F64{}, hn::LowerHalf(half, v)),
          hn::PromoteTo(F64{}, hn::UpperHalf(half, v))};
}
HWY_INLINE F rounded(const Wide& v) {
  return hn::Combine(F32{}, hn::DemoteTo(HalfF32{}, v.upper), hn::DemoteTo(HalfF32{}, v.lower));
}
HWY_INLINE Wide operator+(const Wide& a, const Wide& b) {
  return {a.lower + b.lower, a.upper + b.upper};
}
HWY_INLINE Wide operator-(const Wide& a, const Wide& b) {
  return {a.lower - b.lower, a.upper - b.upper};
}
HWY_INLINE Wide operator-(const Wide& a) {
  return {hn::Neg(a.lower), hn::Neg(a.upper)};
}
HWY_INLINE Wide operator*(const Wide& a, const Wide& b) {
  return {a.lower * b.lower, a.upper * b.upper};
}
HWY_INLINE Wide operator/(const Wide& a, const Wide& b) {
  return {a.lower / b.lower, a.upper / b.upper};
}

/// The centres of a block's pixels, px from its first corner.
struct alignas(64) BlockSamples {
  float x[64], y[64];
};
constexpr BlockSamples kSample = [] {
  BlockSamples s{};
  for (int i = 0; i < 64; ++i) {
    s.x[i] = static_cast<float>(i % 8) + 0.5F;
    s.y[i] = static_cast<float>(i / 8) + 0.5F;
  }
  return s;
}();

/// Where pixels first to first + kLanes of a block are shaded, px.
struct Points {
  F px, py;

  HWY_INLINE Points(const VisibleBlock& block, std::size_t first)
      : px(set(static_cast<float>(block.x0)) + hn::Load(F32{}, kSample.x + first)),
        py(set(static_cast<float>(block.y0)) + hn::Load(F32{}, kSample.y + first)) {
    if (block.points == nullptr) return;
    px = px + hn::Load(F32{}, block.points->dx + first);
    py = py + hn::Load(F32{}, block.points->dy + first);
  }
};
/// In float64, where the sums are exact.
struct WidePoints {
  Wide x, y;

  HWY_INLINE WidePoints(const VisibleBlock& block, std::size_t first)
      : x(wide(set(static_cast<float>(block.x0)) + hn::Load(F32{}, kSample.x + first))),
        y(wide(set(static_cast<float>(block.y0)) + hn::Load(F32{}, kSample.y + first))) {
    if (block.points == nullptr) return;
    x = x + wide(hn::Load(F32{}, block.points->dx + first));
    y = y + wide(hn::Load(F32{}, block.points->dy + first));
  }
};

struct ProjectedCorners {
  V4 v[3];

  /// `at`: the addresses of ProjectedVertices; reads n lanes.
  HWY_INLINE ProjectedCorners(const float* const (&at)[3][kLanes], std::size_t n)
      : v{load_transposed(at[0], n), load_transposed(at[1], n), load_transposed(at[2], n)} {}

  /// n.8
  [[nodiscard]] HWY_INLINE I x(int c) const { return hn::BitCast(I32{}, v[c].x); }
  [[nodiscard]] HWY_INLINE I y(int c) const { return hn::BitCast(I32{}, v[c].y); }
  [[nodiscard]] HWY_INLINE F inv_w(int c) const { return v[c].w; }
  /// The lanes of clipped triangles, whose projected corners are not valid.
  [[nodiscard]] HWY_INLINE std::uint64_t clipped() const {
    const auto is_clipped = [&](int c) HWY_ATTR {
      return hn::RebindMask(F32{}, hn::Eq(x(c), hn::Set(I32{}, kNeedsClip)));
    };
    return bits_of(hn::Or(is_clipped(0), hn::Or(is_clipped(1), is_clipped(2))));
  }
};

template <class N>
N in_px(I fx8);
template <>
HWY_INLINE F in_px<F>(I fx8) {
  return hn::ConvertTo(F32{}, fx8) * set(1.0F / kSubpixels);
}
template <>
HWY_INLINE Wide in_px<Wide>(I fx8) {
  return wide(fx8) * wide(1.0 / kSubpixels);
}

/// The edges from corner 0, px, in float32 (F) or float64 (Wide).
template <class N>
struct Edges {
  N x1, y1, x2, y2;

  explicit HWY_INLINE Edges(const ProjectedCorners& c)
      : x1(in_px<N>(hn::Sub(c.x(1), c.x(0)))),
        y1(in_px<N>(hn::Sub(c.y(1), c.y(0)))),
        x2(in_px<N>(hn::Sub(c.x(2), c.x(0)))),
        y2(in_px<N>(hn::Sub(c.y(2), c.y(0)))) {}
  /// Twice the area.
  [[nodiscard]] HWY_INLINE N determinant() const { return x1 * y2 - x2 * y1; }
};

/// weight_planes of triangles first to first + kLanes; not valid for clipped ones.
template <std::size_t kCount>
HWY_INLINE void set_planes(const ProjectedCorners& corner, PlaneTable<kCount>& out,
                           std::size_t first = 0) {
  using T = PlaneTable<kCount>;
  const auto put = [&](std::size_t which, const Wide& v)
                       HWY_ATTR { store(v, out.number[which] + first); };
  const Edges<Wide> e(corner);
  const Wide inv_det = wide(1.0) / e.determinant();
  put(T::kX0, in_px<Wide>(corner.x(0)));
  put(T::kY0, in_px<Wide>(corner.y(0)));
  const Wide p1 = e.y2 * inv_det, q1 = -e.x2 * inv_det;
  const Wide p2 = -e.y1 * inv_det, q2 = e.x1 * inv_det;
  const Wide w0 = wide(corner.inv_w(0)), w1 = wide(corner.inv_w(1)), w2 = wide(corner.inv_w(2));
  const auto put_corner = [&](std::size_t c, const Wide& p, const Wide& q, const Wide& r) HWY_ATTR {
    put(T::kP + 3 * c, p);
    put(T::kQ + 3 * c, q);
    put(T::kR + 3 * c, r);
  };
  put_corner(0, -(p1 + p2) * w0, -(q1 + q2) * w0, w0);
  put_corner(1, p1 * w1, q1 * w1, wide(0.0));
  put_corner(2, p2 * w2, q2 * w2, wide(0.0));
}

/// Looks up numbers in the lanes of triangles; `place`: each pixel's lane.
struct WideLookup {
  using Indices = decltype(hn::IndicesFromVec(F64{}, hn::Zero(I64{})));
  Indices lower, upper;
  hn::Mask<F64> lower_is_far, upper_is_far;  ///< in the second half of the lanes

  explicit HWY_INLINE WideLookup(I place)
      : lower(in_half(widened(place, false))),
        upper(in_half(widened(place, true))),
        lower_is_far(is_far(widened(place, false))),
        upper_is_far(is_far(widened(place, true))) {}

  HWY_INLINE Wide operator()(const double* values) const {
    const D near = hn::Load(F64{}, values), far = hn::Load(F64{}, values + kHalf);
    return {hn::IfThenElse(lower_is_far, hn::TableLookupLanes(far, lower),
                           hn::TableLookupLanes(near, lower)),
            hn::IfThenElse(upper_is_far, hn::TableLookupLanes(far, upper),
                           hn::TableLookupLanes(near, upper))};
  }

 private:
  static HWY_INLINE hn::Vec<I64> widened(I place, bool is_upper) {
    const hn::Half<I32> half;
    return hn::PromoteTo(I64{}, is_upper ? hn::UpperHalf(half, place) : hn::LowerHalf(half, place));
  }
  static HWY_INLINE hn::Vec<I64> last() { return hn::Set(I64{}, std::int64_t{kHalf} - 1); }
  static HWY_INLINE Indices in_half(hn::Vec<I64> place) {
    return hn::IndicesFromVec(F64{}, hn::And(place, last()));
  }
  static HWY_INLINE hn::Mask<F64> is_far(hn::Vec<I64> place) {
    return hn::RebindMask(F64{}, hn::Gt(place, last()));
  }
};

/// In float32; `lane`: that of each pixel's triangle.
struct FloatLookup {
  decltype(hn::IndicesFromVec(F32{}, hn::Zero(I32{}))) lane;

  HWY_INLINE F operator()(const float* values) const {
    return hn::TableLookupLanes(hn::Load(F32{}, values), lane);
  }
  HWY_INLINE V3 operator()(const float (&v)[3][kLanes]) const {
    return {(*this)(v[0]), (*this)(v[1]), (*this)(v[2])};
  }
};

HWY_INLINE I numbers_of(const std::uint8_t* place, std::size_t first) {
  return hn::PromoteTo(I32{}, hn::Load(hn::Rebind<std::uint8_t, I32>{}, place + first));
}
/// Calls use(first, group, Lookup, mask) for each kLanes pixels from `first` with a `covered` one
/// that sees a triangle of a group of kLanes. The mask has all pixels that do, covered or not.
template <class Lookup, class Use>
HWY_INLINE void for_each_group(const std::uint8_t* place, std::size_t triangles,
                               std::uint64_t covered, const Use& use) {
  constexpr std::uint64_t kAll = (std::uint64_t{1} << kLanes) - 1;
  const I last = hn::Set(I32{}, int{kLanes} - 1);
  const std::size_t groups = (triangles + kLanes - 1) / kLanes;
  for (std::size_t first = 0; first < 64; first += kLanes) {
    const std::uint64_t wanted = covered >> first & kAll;
    if (wanted == 0) continue;
    const I number = numbers_of(place, first);
    const Lookup look(hn::And(number, last));
    for (std::size_t g = 0; g < groups; ++g) {
      const auto mine = hn::RebindMask(
          F32{},
          hn::Eq(hn::Or(number, last), hn::Set(I32{}, static_cast<int>(g * kLanes + kLanes - 1))));
      if (groups > 1 && (bits_of(mine) & wanted) == 0) continue;
      use(first, g, look, mine);
    }
  }
}

HWY_INLINE void make_shares(Wide (&b)[3]) {
  const auto in_range = [](D v) HWY_ATTR {
    const D zero = hn::Zero(F64{}), one = hn::Set(F64{}, 1.0);
    return hn::IfThenElseZero(hn::Gt(v, zero), hn::IfThenElse(hn::Lt(v, one), v, one));
  };
  const Wide sum = b[0] + b[1] + b[2];
  for (Wide& share : b) {
    share = share / sum;
    share = {in_range(share.lower), in_range(share.upper)};
  }
  const Wide inside = b[0] + b[1] + b[2];
  for (Wide& share : b) share = share / inside;
}
/// For one triangle, at kLanes points.
HWY_INLINE void shares_at(const WeightPlanes& w, const Wide& x, const Wide& y, Wide (&b)[3]) {
  const Wide dx = x - wide(w.x0), dy = y - wide(w.y0);
  for (int c = 0; c < 3; ++c) b[c] = wide(w.r[c]) + wide(w.p[c]) * dx + wide(w.q[c]) * dy;
  make_shares(b);
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_SURFACE_WEIGHTS_INL_HPP
