// SPDX-License-Identifier: BSD-3-Clause
// Projection and setup with Highway, compiled once per instruction set. Operations, order and bits
// are those of the scalar forms (projection.hpp, make_piece.hpp).

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/setup/setup_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#define RASTRUM_MOST_LANES 16  // a triangle a lane
#include <rastrum/raster/kernels/kernels_simd.hpp>
#include <rastrum/raster/kernels/lanes-inl.hpp>
#include <rastrum/raster/rules/edge_lanes-inl.hpp>
#include <rastrum/raster/rules/make_piece.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2

HWY_INLINE F row_times(const float (&m)[4], F x, F y, F z) {
  const F32 d;
  const F xy = hn::Add(hn::Mul(hn::Set(d, m[0]), x), hn::Mul(hn::Set(d, m[1]), y));
  return hn::Add(hn::Add(xy, hn::Mul(hn::Set(d, m[2]), z)), hn::Set(d, m[3]));
}

/// For positions without a place: bits of the clipper's planes that they are far outside of.
/// Whatever its roundings, the clipper keeps nothing of a triangle whose corners share a bit. 0:
/// none is known. The clipper's float64 distances are computed from these numbers. For the near
/// plane they have the same sign. For the guard band, distances of new corners are off by less than
/// 1 px · w unless a number is large.
HWY_NOINLINE I outside_planes(F x, F y, F z, F w, Viewport viewport) {
  const F32 d;
  const I32 di;
  const F one = hn::Set(d, 1.0F);
  const auto is_moderate = hn::And(
      hn::Le(hn::Max(hn::Abs(x), hn::Abs(y)), hn::Set(d, 0x1p30F)),
      hn::And(hn::Le(hn::Abs(w), hn::Set(d, 0x1p30F)), hn::Le(hn::Abs(z), hn::Set(d, 0x1p60F))));
  I planes = hn::Zero(di);
  const auto add = [&](int bit, auto is_outside) HWY_ATTR {
    const auto mask = hn::RebindMask(di, hn::And(is_outside, is_moderate));
    planes = hn::Or(planes, hn::IfThenElseZero(mask, hn::Set(di, bit)));
  };
  const auto guard = [&](int bit, F along, float half, float rest) HWY_ATTR {
    const F a = hn::Mul(along, hn::Set(d, half)), b = hn::Mul(w, hn::Set(d, rest));
    const F error = hn::Mul(hn::Add(hn::Abs(a), hn::Abs(b)), hn::Set(d, 1e-6F));
    add(bit, hn::Lt(hn::Add(hn::Add(a, b), error), hn::Neg(one)));
  };
  const float hw = viewport.half_width, hh = viewport.half_height;
  add(1, hn::Gt(z, w));
  guard(2, x, hw, hw - kGuardMinPx);
  guard(4, x, -hw, kGuardMaxPx - hw);
  guard(8, y, -hh, hh - kGuardMinPx);
  guard(16, y, hh, kGuardMaxPx - hh);
  return planes;
}

/// From clip space on. Positions without a place get outside_planes as y.
HWY_INLINE void project_lanes(F cx, F cy, F cz, F cw, Viewport viewport, ProjectedVertex* out) {
  const F32 d;
  const I32 di;
  const F inv_w = hn::Div(hn::Set(d, 1.0F), cw);
  const F hw = hn::Set(d, viewport.half_width);
  const F hh = hn::Set(d, viewport.half_height);
  const F px = hn::Add(hn::Mul(hn::Mul(cx, inv_w), hw), hw);
  const F py = hn::Sub(hh, hn::Mul(hn::Mul(cy, inv_w), hh));
  const F depth = hn::Mul(cz, inv_w);
  const F low = hn::Set(d, kGuardMinPx);
  const F high = hn::Set(d, kGuardMaxPx);
  auto ok = hn::And(hn::Gt(cw, hn::Zero(d)), hn::Le(cz, cw));
  ok = hn::And(ok, hn::And(hn::Ge(px, low), hn::Le(px, high)));
  ok = hn::And(ok, hn::And(hn::Ge(py, low), hn::Le(py, high)));
  ok = hn::And(ok, hn::Ge(depth, hn::Set(d, std::numeric_limits<float>::lowest())));
  const F scale = hn::Set(d, static_cast<float>(kSubpixels));
  const F zero = hn::Zero(d);
  const I x8 = hn::NearestInt(hn::Mul(hn::IfThenElse(ok, px, zero), scale));
  const I y8 = hn::NearestInt(hn::Mul(hn::IfThenElse(ok, py, zero), scale));
  const auto oki = hn::RebindMask(di, ok);
  I second = y8;
  if (!hn::AllTrue(d, ok))
    second = hn::IfThenElse(oki, y8, outside_planes(cx, cy, cz, cw, viewport));
  hn::StoreInterleaved4(hn::IfThenElse(oki, x8, hn::Set(di, kNeedsClip)), second,
                        hn::BitCast(di, hn::IfThenElseZero(ok, depth)),
                        hn::BitCast(di, hn::IfThenElseZero(ok, inv_w)), di,
                        reinterpret_cast<std::int32_t*>(out));
}

HWY_INLINE void project_lanes(F x, F y, F z, const Mat4& m, Viewport viewport,
                              ProjectedVertex* out) {
  project_lanes(row_times(m.m[0], x, y, z), row_times(m.m[1], x, y, z), row_times(m.m[2], x, y, z),
                row_times(m.m[3], x, y, z), viewport, out);
}

/// Whole vectors of `n` positions, then the rest with zeros.
template <class Position, class ProjectLanes>
HWY_INLINE void project_all(const Position* positions, std::size_t n, ProjectedVertex* out,
                            const ProjectLanes& project_some) {
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) project_some(positions + i, out + i);
  if (i == n) return;
  Position rest[kLanes] = {};
  ProjectedVertex projected[kLanes];
  std::copy_n(positions + i, n - i, rest);
  project_some(rest, projected);
  std::copy_n(projected, n - i, out + i);
}

void project(const Vec3* positions, std::size_t n, const Mat4& m, Viewport viewport,
             ProjectedVertex* out) noexcept {
  project_all(positions, n, out, [&](const Vec3* from, ProjectedVertex* to) HWY_ATTR {
    F x, y, z;
    hn::LoadInterleaved3(F32{}, &from->x, x, y, z);
    project_lanes(x, y, z, m, viewport, to);
  });
}

HWY_INLINE D row_times64(const double (&m)[4], D x, D y, D z) {
  const F64 d;
  const D xy = hn::Add(hn::Mul(hn::Set(d, m[0]), x), hn::Mul(hn::Set(d, m[1]), y));
  return hn::Add(hn::Add(xy, hn::Mul(hn::Set(d, m[2]), z)), hn::Set(d, m[3]));
}

void project64(const Vec3d* positions, std::size_t n, const Mat4d& m, Viewport viewport,
               ProjectedVertex* out) noexcept {
  project_all(positions, n, out, [&](const Vec3d* from, ProjectedVertex* to) HWY_ATTR {
    const F32 d;
    const hn::Half<F32> dh;
    HWY_ALIGN float clip[4][kLanes];
    for (std::size_t h = 0; h < kHalves; ++h) {
      D x, y, z;
      hn::LoadInterleaved3(F64{}, &from[h * kLanes64].x, x, y, z);
      for (std::size_t row = 0; row < 4; ++row)
        hn::Store(hn::DemoteTo(dh, row_times64(m.m[row], x, y, z)), dh, clip[row] + h * kLanes64);
    }
    project_lanes(hn::Load(d, clip[0]), hn::Load(d, clip[1]), hn::Load(d, clip[2]),
                  hn::Load(d, clip[3]), viewport, to);
  });
}

struct Corners {
  I x, y;
  F depth;
};

/// (x, y, depth, ·) of four vertices as three vectors of four.
HWY_INLINE void transpose4(const ProjectedVertex* v, const std::uint32_t* index, hn::Vec<I128>& x,
                           hn::Vec<I128>& y, hn::Vec<I128>& depth) {
  const I128 d;
  const hn::Repartition<std::int64_t, I128> d64;
  const auto load = [&](int lane) HWY_ATTR {
    return hn::LoadU(d, reinterpret_cast<const std::int32_t*>(v + index[lane]));
  };
  const auto v0 = load(0), v1 = load(1), v2 = load(2), v3 = load(3);
  const auto xy01 = hn::BitCast(d64, hn::InterleaveLower(d, v0, v1));
  const auto xy23 = hn::BitCast(d64, hn::InterleaveLower(d, v2, v3));
  const auto zw01 = hn::BitCast(d64, hn::InterleaveUpper(d, v0, v1));
  const auto zw23 = hn::BitCast(d64, hn::InterleaveUpper(d, v2, v3));
  x = hn::BitCast(d, hn::InterleaveLower(d64, xy01, xy23));
  y = hn::BitCast(d, hn::InterleaveUpper(d64, xy01, xy23));
  depth = hn::BitCast(d, hn::InterleaveLower(d64, zw01, zw23));
}

HWY_INLINE Corners load_corners(const SetupInput& in, const std::uint32_t* index) {
  const F32 d;
  const I32 di;
  hn::Vec<I128> x[kLanes / 4], y[kLanes / 4], depth[kLanes / 4];
  for (std::size_t i = 0; i < kLanes / 4; ++i)
    transpose4(in.vertices, index + 4 * i, x[i], y[i], depth[i]);
  const auto joined = [&](const hn::Vec<I128>(&v)[kLanes / 4]) HWY_ATTR {
#if HWY_MAX_BYTES >= 64
    const hn::Half<I32> dh;
    return hn::Combine(di, hn::Combine(dh, v[3], v[2]), hn::Combine(dh, v[1], v[0]));
#elif HWY_MAX_BYTES >= 32
    return hn::Combine(di, v[1], v[0]);
#else
    return v[0];
#endif
  };
  return {joined(x), joined(y), hn::BitCast(d, joined(depth))};
}

/// As seen from the samples at `by`; no corner may need the clipper.
HWY_INLINE Corners moved_lanes(Corners c, SampleOffset by) {
  const I32 d;
  c.x = hn::Sub(c.x, hn::Set(d, by.x));
  c.y = hn::Sub(c.y, hn::Set(d, by.y));
  return c;
}

/// The indices of kLanes triangles from `offset` on, by corner. Beyond the end the first one is
/// repeated. Returns whether all are in range.
HWY_INLINE bool load_indices(const SetupInput& in, std::uint32_t offset,
                             std::uint32_t (&index)[3][kLanes]) {
  const U32 d;
  const std::uint64_t t = in.first + offset;
  const std::uint32_t count = in.count - offset;
  if (in.indices == nullptr) {
    const std::uint64_t last = t + std::min<std::uint64_t>(kLanes, count);
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      for (std::size_t c = 0; c < 3; ++c)
        index[c][lane] = static_cast<std::uint32_t>((t + (lane < count ? lane : 0)) * 3 + c);
    return last * 3 <= in.vertex_count;
  }
  const std::uint32_t* from = in.indices + t * 3;
  std::uint32_t rest[3 * kLanes];
  if (count < kLanes) {
    for (std::size_t i = 0; i < 3 * kLanes; ++i) rest[i] = from[i < 3 * count ? i : i % 3];
    from = rest;
  }
  hn::Vec<U32> i0, i1, i2;
  hn::LoadInterleaved3(d, from, i0, i1, i2);
  hn::StoreU(i0, d, index[0]);
  hn::StoreU(i1, d, index[1]);
  hn::StoreU(i2, d, index[2]);
  const auto largest = hn::Max(i0, hn::Max(i1, i2));
  if (in.vertex_count == 0) return false;
  const auto last = hn::Set(
      d, static_cast<std::uint32_t>(std::min<std::size_t>(in.vertex_count - 1, 0xffffffffU)));
  return hn::AllTrue(d, hn::Eq(hn::Max(largest, last), last));
}

HWY_INLINE I min3_lanes(I a, I b, I c) {
  return hn::Min(a, hn::Min(b, c));
}
HWY_INLINE I max3_lanes(I a, I b, I c) {
  return hn::Max(a, hn::Max(b, c));
}

/// The bin of pixel (x, y), and below its place there, as in fragment_at.
HWY_INLINE I bin_of(I x, I y, std::uint32_t columns) {
  static_assert(kBinSize == 64);
  const I row = hn::Mul(hn::ShiftRight<6>(y), hn::Set(I32{}, static_cast<int>(columns)));
  return hn::Add(row, hn::ShiftRight<6>(x));
}
HWY_INLINE I pixel_in_bin(I x, I y) {
  static_assert(kBinSize == 64 && kBlockSize == 8);
  const auto part = [&](I v, int mask) HWY_ATTR { return hn::And(v, hn::Set(I32{}, mask)); };
  return hn::Or(hn::Or(hn::ShiftLeft<6>(part(y, 0x38)), hn::ShiftLeft<3>(part(x, 0x38))),
                hn::Or(hn::ShiftLeft<3>(part(y, 7)), part(x, 7)));
}

struct Classes {
  std::uint32_t drawn = 0;                     ///< may cover a sample
  std::uint32_t none = 0;                      ///< micro triangles that cover no sample
  std::uint32_t slow = 0;                      ///< need the clipper
  HWY_ALIGN std::uint32_t micro[kLanes] = {};  ///< samples that micro triangles cover, else 0
};

/// Negates v in the lanes where m is −1.
HWY_INLINE I negate_if(I v, I m) {
  return hn::Sub(hn::Xor(v, m), m);
}

/// Lanes that are culled for their winding or for having no area. Exact in float64: differences
/// have 25 bits, products 50.
HWY_INLINE std::uint32_t culled_lanes(const Corners& a, const Corners& b, const Corners& c,
                                      Cull cull) {
  const I dx1 = hn::Sub(b.x, a.x), dy1 = hn::Sub(b.y, a.y);
  const I dx2 = hn::Sub(c.x, a.x), dy2 = hn::Sub(c.y, a.y);
  std::uint32_t culled = 0;
  for (std::size_t h = 0; h < kHalves; ++h) {
    const F64 dd;
    const D area = hn::Sub(hn::Mul(half_to_double(dx1, h), half_to_double(dy2, h)),
                           hn::Mul(half_to_double(dx2, h), half_to_double(dy1, h)));
    const D zero = hn::Zero(dd);
    auto out = hn::Eq(area, zero);
    if (cull == Cull::back) out = hn::Or(out, hn::Gt(area, zero));
    if (cull == Cull::front) out = hn::Or(out, hn::Lt(area, zero));
    std::uint8_t bits = 0;
    hn::StoreMaskBits(dd, out, &bits);
    culled |= (bits & ((1U << kLanes64) - 1)) << (h * kLanes64);
  }
  return culled;
}

/// Coverage of micro triangles, one a lane: sign bits of edge functions at kMicroSize² samples from
/// (x0, y0) on. With boxes of up to 5 px all products are far inside int32.
HWY_INLINE I micro_masks(const Corners& a, const Corners& b, const Corners& c, I x0, I y0, I area) {
  const I32 d;
  const I zero = hn::Zero(d);
  const I turned = hn::ShiftRight<31>(area);
  const I px = hn::Add(hn::ShiftLeft<kSubpixelBits>(x0), hn::Set(d, kHalfPixel));
  const I py = hn::Add(hn::ShiftLeft<kSubpixelBits>(y0), hn::Set(d, kHalfPixel));
  I value[3], dx[3], dy[3];
  const auto edge = [&](int i, const Corners& from, const Corners& to) HWY_ATTR {
    const I ea = negate_if(hn::Sub(from.y, to.y), turned);
    const I eb = negate_if(hn::Sub(to.x, from.x), turned);
    value[i] = edge_lanes(ea, eb, hn::Sub(px, from.x), hn::Sub(py, from.y));
    dx[i] = hn::ShiftLeft<kSubpixelBits>(ea);
    dy[i] = hn::ShiftLeft<kSubpixelBits>(eb);
  };
  edge(0, a, b);
  edge(1, b, c);
  edge(2, c, a);
  I outside = zero;
  // Backwards, so that shifting the bits left leaves the first sample in bit 0.
  for (int i = 0; i < 3; ++i)
    value[i] = hn::Add(value[i], hn::Mul(hn::Add(dx[i], dy[i]), hn::Set(d, kMicroSize - 1)));
  for (int row = 0; row < kMicroSize; ++row) {
    I e0 = value[0], e1 = value[1], e2 = value[2];
    for (int column = 0; column < kMicroSize; ++column) {
      const I sign = hn::Or(hn::Or(e0, e1), e2);
      const I bit = hn::BitCast(d, hn::ShiftRight<31>(hn::BitCast(U32{}, sign)));
      outside = hn::Or(hn::Add(outside, outside), bit);
      e0 = hn::Sub(e0, dx[0]);
      e1 = hn::Sub(e1, dx[1]);
      e2 = hn::Sub(e2, dx[2]);
    }
    for (int i = 0; i < 3; ++i) value[i] = hn::Sub(value[i], dy[i]);
  }
  return hn::AndNot(outside, hn::Set(d, 0xFFFF));
}

/// Triangles with a corner that has no place.
HWY_INLINE std::uint32_t clipped_lanes(const Corners& a, const Corners& b, const Corners& c) {
  const I needs_clip = hn::Set(I32{}, kNeedsClip);
  return lane_bits(
      hn::Or(hn::Eq(a.x, needs_clip), hn::Or(hn::Eq(b.x, needs_clip), hn::Eq(c.x, needs_clip))));
}
/// The `clipped` triangles of which the clipper may keep something: no plane excludes all corners.
HWY_INLINE std::uint32_t left_to_clipper(const Corners& a, const Corners& b, const Corners& c,
                                         std::uint32_t clipped) {
  if (clipped == 0) return 0;
  const I32 d;
  const auto planes = [&](const Corners& v) HWY_ATTR {
    return hn::IfThenElseZero(hn::Eq(v.x, hn::Set(d, kNeedsClip)), v.y);
  };
  const I common = hn::And(planes(a), hn::And(planes(b), planes(c)));
  return clipped & lane_bits(hn::Eq(common, hn::Zero(d)));
}

/// `kCulls`: also finds culled triangles; else the caller has left them out.
template <bool kCulls>
HWY_INLINE Classes classify(const Corners& a, const Corners& b, const Corners& c,
                            const SetupInput& in) {
  const I32 d;
  Classes classes;
  const I before = hn::Set(d, kHalfPixel - 1);
  const I half = hn::Set(d, kHalfPixel);
  // First and last sample of the box, inclusive.
  const I x0 = hn::ShiftRight<kSubpixelBits>(hn::Add(min3_lanes(a.x, b.x, c.x), before));
  const I y0 = hn::ShiftRight<kSubpixelBits>(hn::Add(min3_lanes(a.y, b.y, c.y), before));
  const I x1 = hn::ShiftRight<kSubpixelBits>(hn::Sub(max3_lanes(a.x, b.x, c.x), half));
  const I y1 = hn::ShiftRight<kSubpixelBits>(hn::Sub(max3_lanes(a.y, b.y, c.y), half));
  const auto empty =
      hn::Or(hn::Gt(hn::Max(x0, hn::Set(d, in.view.x0)), hn::Min(x1, hn::Set(d, in.view.x1 - 1))),
             hn::Gt(hn::Max(y0, hn::Set(d, in.view.y0)), hn::Min(y1, hn::Set(d, in.view.y1 - 1))));
  constexpr std::uint32_t kAll = (1U << kLanes) - 1;
  const std::uint32_t clipped = clipped_lanes(a, b, c);
  classes.slow = left_to_clipper(a, b, c, clipped);
  const std::uint32_t in_view = kAll & ~(lane_bits(empty) | clipped);
  if (in_view == 0) return classes;

  const I dx1 = hn::Sub(b.x, a.x), dy1 = hn::Sub(b.y, a.y);
  const I dx2 = hn::Sub(c.x, a.x), dy2 = hn::Sub(c.y, a.y);
  const I size = hn::Set(d, kMicroSize);
  const auto small = hn::And(hn::Lt(hn::Sub(x1, x0), size), hn::Lt(hn::Sub(y1, y0), size));
  const std::uint32_t micro =
      !in.micro || (in.flags & kMayDrop) != 0 ? 0U : lane_bits(small) & in_view;
  std::uint32_t culled = 0;
  if (micro != 0) {
    const I zero = hn::Zero(d);
    const I area = hn::Sub(hn::Mul(dx1, dy2), hn::Mul(dx2, dy1));
    auto out = hn::Eq(area, zero);
    if (in.cull == Cull::back) out = hn::Or(out, hn::Gt(area, zero));
    if (in.cull == Cull::front) out = hn::Or(out, hn::Lt(area, zero));
    culled = lane_bits(out) & micro;
    const I masks = micro_masks(a, b, c, x0, y0, area);
    hn::Store(hn::BitCast(U32{}, hn::IfThenElseZero(small, masks)), U32{}, classes.micro);
    classes.none = lane_bits(hn::Eq(masks, zero)) & micro & ~culled;
  }
  if (kCulls && micro != in_view) {
    culled |= culled_lanes(a, b, c, in.cull) & ~micro;
  }
  classes.drawn = in_view & ~culled & ~classes.none;
  return classes;
}

/// Triangles that wait until there are kLanes: a third of a closed mesh survives culling.
struct Waiting {
  std::uint32_t count = 0;
  std::uint32_t index[3][2 * kLanes];
  std::uint32_t triangle[2 * kLanes];
  std::uint32_t micro[2 * kLanes];

  /// Adds the triangles `lanes` of kLanes triangles from t on. Fewer than kLanes may be waiting.
  HWY_INLINE void add(const std::uint32_t (&corners)[3][kLanes], std::uint32_t lanes,
                      std::uint32_t t, const std::uint32_t* micro_masks) {
#if HWY_MAX_BYTES >= 64
    const U32 d;
    const auto mask = lane_mask(lanes);
    // Compressed in a register: AVX-512's compressing stores take a hundred cycles on some
    // machines.
    for (std::size_t c = 0; c < 3; ++c)
      hn::StoreU(hn::Compress(hn::LoadU(d, corners[c]), mask), d, index[c] + count);
    hn::StoreU(hn::Compress(hn::Iota(d, t), mask), d, triangle + count);
    hn::StoreU(hn::Compress(hn::LoadU(d, micro_masks), mask), d, micro + count);
    count += static_cast<std::uint32_t>(std::popcount(lanes));
#else  // tables are slower than one by one
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      for (std::size_t c = 0; c < 3; ++c) index[c][count] = corners[c][lane];
      triangle[count] = t + lane;
      micro[count++] = micro_masks[lane];
    }
#endif
  }
  /// Drops the first n: all, or kLanes.
  HWY_INLINE void drop(std::uint32_t n) {
    count -= n;
    if (count == 0) return;
    const auto move = [](std::uint32_t* numbers) HWY_ATTR {
      hn::StoreU(hn::LoadU(U32{}, numbers + kLanes), U32{}, numbers);
    };
    for (std::uint32_t* const corner : {index[0], index[1], index[2]}) move(corner);
    move(triangle);
    move(micro);
  }
};

/// Numbers of kLanes pieces that all samples share, except for their moves.
struct PieceLanes {
  HWY_ALIGN std::int32_t first[kLanes * 4],
      second[kLanes * 4];  ///< the first eight numbers of a piece
  HWY_ALIGN float zx[kLanes], zy[kLanes];
  std::uint32_t facing_away;
};

HWY_INLINE void set_up_lanes(const Corners& a, const Corners& b, const Corners& c,
                             PieceLanes& out) {
  const F32 df;
  const I32 di;
  const I dx1 = hn::Sub(b.x, a.x), dy1 = hn::Sub(b.y, a.y);
  const I dx2 = hn::Sub(c.x, a.x), dy2 = hn::Sub(c.y, a.y);
  HWY_ALIGN float sign[kLanes];
  for (std::size_t h = 0; h < kHalves; ++h) {
    const F64 dd;
    const hn::Half<F32> dh;
    const D x1 = half_to_double(dx1, h), y1 = half_to_double(dy1, h);
    const D x2 = half_to_double(dx2, h), y2 = half_to_double(dy2, h);
    const D z0 = half_to_double(a.depth, h);
    const D z1 = hn::Sub(half_to_double(b.depth, h), z0);
    const D z2 = hn::Sub(half_to_double(c.depth, h), z0);
    const D det = hn::Sub(hn::Mul(x1, y2), hn::Mul(x2, y1));
    const D scale = hn::Set(dd, static_cast<double>(kSubpixels));
    const D gx = hn::Mul(hn::Div(hn::Sub(hn::Mul(z1, y2), hn::Mul(z2, y1)), det), scale);
    const D gy = hn::Mul(hn::Div(hn::Sub(hn::Mul(z2, x1), hn::Mul(z1, x2)), det), scale);
    hn::StoreU(hn::DemoteTo(dh, gx), dh, out.zx + h * kLanes64);
    hn::StoreU(hn::DemoteTo(dh, gy), dh, out.zy + h * kLanes64);
    hn::StoreU(hn::DemoteTo(dh, det), dh, sign + h * kLanes64);
  }
  // |det| ≥ 1, so its sign survives rounding to float32.
  const auto keep = hn::RebindMask(di, hn::Gt(hn::LoadU(df, sign), hn::Zero(df)));
  out.facing_away = lane_bits(keep);
  const I sx = hn::IfThenElse(keep, b.x, c.x), sy = hn::IfThenElse(keep, b.y, c.y);
  const I tx = hn::IfThenElse(keep, c.x, b.x), ty = hn::IfThenElse(keep, c.y, b.y);
  hn::StoreInterleaved4(a.x, sx, tx, a.y, di, out.first);
  hn::StoreInterleaved4(sy, ty, hn::BitCast(di, a.depth), hn::BitCast(di, hn::LoadU(df, out.zx)),
                        di, out.second);
}

/// Writes pieces of `lanes`, which may cover a sample, in order. `triangle` is by lane. kMoved:
/// moved for sample `number`.
template <bool kMoved>
HWY_INLINE void write_pieces(const SetupInput& in, const PieceLanes& from, std::uint32_t number,
                             std::uint32_t lanes, const std::uint32_t* triangle, Piece* pieces,
                             SetupOutput& out) {
  const I128 d;
  const SampleOffset at = kMoved ? in.samples[number] : SampleOffset{};
  alignas(16) const std::int32_t by[2][4] = {{at.x, at.x, at.x, at.y}, {at.y, at.y, 0, 0}};
  const std::uint32_t flags = in.flags | (in.together ? kAllSamples : 0) | number << kSampleShift;
  const auto load = [&](const std::int32_t* part, std::uint32_t i, int half) HWY_ATTR {
    const auto v = hn::Load(d, part + i * 4);
    return kMoved ? hn::Sub(v, hn::Load(d, by[half])) : v;
  };
  for (; lanes != 0; lanes &= lanes - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(lanes));
    Piece& piece = pieces[out.pieces++];
    auto* parts = reinterpret_cast<std::int32_t*>(&piece);
    hn::Store(load(from.first, i, 0), d, parts);
    hn::Store(load(from.second, i, 1), d, parts + 4);
    piece.zy = from.zy[i];
    piece.flags = flags | ((from.facing_away >> i & 1) * kFacesAway);
    piece.low = kIdMask - id_of(in, in.first + triangle[i]);
  }
}

/// Element m: the numbers of m's bits, a byte each, from the lowest on.
constexpr auto kBitsOfByte = [] {
  std::array<std::uint64_t, 256> table{};
  for (std::uint32_t m = 0; m < 256; ++m)
    for (std::uint32_t bit = 0, n = 0; bit < 8; ++bit)
      if ((m >> bit & 1) != 0) table[m] |= std::uint64_t{bit} << (8 * n++);
  return table;
}();

/// The samples in `view` of a micro triangle's mask, whose first sample is (x, y).
HWY_INLINE std::uint32_t micro_in_view(std::uint32_t mask, int x, int y, Rect view) {
  const auto between = [](int begin, int end) {
    const std::uint32_t before = (1U << std::clamp(begin, 0, kMicroSize)) - 1;
    return ((1U << std::clamp(end, 0, kMicroSize)) - 1) & ~before;
  };
  const std::uint32_t columns = between(view.x0 - x, view.x1 - x);
  const std::uint32_t rows = between(view.y0 - y, view.y1 - y);
  std::uint32_t inside = 0;
  for (int row = 0; row < kMicroSize; ++row)
    if ((rows >> row & 1) != 0) inside |= columns << (row * kMicroSize);
  return mask & inside;
}

/// The covered samples of the micro triangles of `lanes` as fragments, in order of triangles and
/// samples. Lists the samples first; then kLanes at a time look up their triangle's lane. One by
/// one took a third of the setup of a mesh of a million. Writes up to kLanes more than it returns.
HWY_INLINE std::uint32_t write_fragments(const SetupInput& in, const Corners& a, const Corners& b,
                                         const Corners& c, const PieceLanes& from,
                                         std::uint32_t lanes, const std::uint32_t* triangle,
                                         const std::uint32_t* micro, BinFragment* out) {
  const F32 df;
  const I32 di;
  const auto set = [&](int v) HWY_ATTR { return hn::Set(di, v); };
  const I before = set(kHalfPixel - 1);
  const I first_x = hn::ShiftRight<kSubpixelBits>(hn::Add(min3_lanes(a.x, b.x, c.x), before));
  const I first_y = hn::ShiftRight<kSubpixelBits>(hn::Add(min3_lanes(a.y, b.y, c.y), before));
  const auto within = [&](I first, int begin, int end) HWY_ATTR {
    return hn::And(hn::Gt(first, set(begin - 1)), hn::Lt(first, set(end - kMicroSize + 1)));
  };
  const std::uint32_t whole = lane_bits(
      hn::And(within(first_x, in.view.x0, in.view.x1), within(first_y, in.view.y0, in.view.y1)));
  HWY_ALIGN std::int32_t xs[kLanes], ys[kLanes];
  if ((lanes & ~whole) != 0) {
    hn::Store(first_x, di, xs);
    hn::Store(first_y, di, ys);
  }
  // A byte a sample: lane, row and column.
  std::uint8_t list[kLanes * kMicroSize * kMicroSize + 2 * sizeof(std::uint64_t)];
  HWY_ALIGN std::uint32_t numbers[kLanes] = {};
  std::uint32_t count = 0;
  for (std::uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
    const std::uint32_t mask =
        (whole >> i & 1) != 0 ? micro[i] : micro_in_view(micro[i], xs[i], ys[i], in.view);
    numbers[i] = in.numbers != nullptr ? in.numbers[in.first + triangle[i]] : triangle[i];
    for (std::uint32_t half = 0; half < 2; ++half) {
      const std::uint32_t bits = mask >> (8 * half) & 255;
      const std::uint64_t samples = kBitsOfByte[bits] + (16 * i + 8 * half) * 0x0101010101010101U;
      std::memcpy(list + count, &samples, sizeof samples);
      count += static_cast<std::uint32_t>(std::popcount(bits));
    }
  }
  std::memset(list + count, 0, kLanes);

  const hn::RebindToUnsigned<I64> du64;
  const F px_per_subpixel = hn::Set(df, 1.0F / kSubpixels);
  const I x0 = hn::BitCast(di, hn::Mul(hn::ConvertTo(df, a.x), px_per_subpixel));
  const I y0 = hn::BitCast(di, hn::Mul(hn::ConvertTo(df, a.y), px_per_subpixel));
  const I z0 = hn::BitCast(di, a.depth);
  const I zx = hn::BitCast(di, hn::Load(df, from.zx)), zy = hn::BitCast(di, hn::Load(df, from.zy));
  const I number = hn::BitCast(di, hn::Load(U32{}, numbers));
  const std::uint64_t low = kIdMask - in.first_id - (in.numbers != nullptr ? 0 : in.first);
  const I translucent = set((in.flags & kTranslucent) != 0 ? int{kTranslucentFragment} : 0);
  for (std::uint32_t k = 0; k < count; k += kLanes) {
    const I entry =
        hn::BitCast(di, hn::PromoteTo(U32{}, hn::LoadU(hn::Rebind<std::uint8_t, U32>{}, list + k)));
    const auto lane = hn::IndicesFromVec(di, hn::ShiftRight<4>(entry));
    const auto of = [&](I v) HWY_ATTR { return hn::TableLookupLanes(v, lane); };
    const auto float_of = [&](I v) HWY_ATTR { return hn::BitCast(df, of(v)); };
    static_assert(kMicroSize == 4);
    const I x = hn::Add(of(first_x), hn::And(entry, set(3)));
    const I y = hn::Add(of(first_y), hn::And(hn::ShiftRight<2>(entry), set(3)));
    // plane_depth_at's operations.
    const F half = hn::Set(df, 0.5F);
    const F dx = hn::Sub(hn::Add(hn::ConvertTo(df, x), half), float_of(x0));
    const F dy = hn::Sub(hn::Add(hn::ConvertTo(df, y), half), float_of(y0));
    const F depth =
        hn::Add(hn::Add(float_of(z0), hn::Mul(float_of(zx), dx)), hn::Mul(float_of(zy), dy));
    const F from_0 = hn::IfThenElseZero(hn::Gt(depth, hn::Zero(df)), depth);
    const auto bits = hn::BitCast(U32{}, hn::Min(from_0, hn::Set(df, 1.0F)));
    const auto bin = hn::BitCast(U32{}, bin_of(x, y, in.bin_columns));
    const auto pixel = hn::BitCast(U32{}, hn::Or(pixel_in_bin(x, y), translucent));
    const auto own = hn::BitCast(U32{}, of(number));
    for (std::size_t h = 0; h < kHalves; ++h) {
      const auto key = hn::Or(hn::ShiftLeft<kIdBits>(widened_half(bits, h)),
                              hn::Sub(hn::Set(du64, low), widened_half(own, h)));
      const auto place = hn::Or(widened_half(bin, h), hn::ShiftLeft<32>(widened_half(pixel, h)));
      static_assert(sizeof(BinFragment) == 16);
      hn::StoreInterleaved2(key, place, du64,
                            reinterpret_cast<std::uint64_t*>(out + k + h * kLanes64));
    }
  }
  return count;
}

/// Writes small triangles of `lanes` to `in.small`, one for each bin; returns which are small.
HWY_INLINE std::uint32_t write_small(const SetupInput& in, const Corners& a, const Corners& b,
                                     const Corners& c, const PieceLanes& from, std::uint32_t lanes,
                                     const std::uint32_t* triangle, SetupOutput& out) {
  const F32 df;
  const I32 d;
  const auto set = [&](int v) HWY_ATTR { return hn::Set(d, v); };
  const Rect view = in.bins.view;
  const I before = set(kHalfPixel - 1), half = set(kHalfPixel);
  // Relative to the view's first pixel.
  const auto first_of = [&](I p, I q, I r, int origin) HWY_ATTR {
    return hn::Sub(hn::ShiftRight<kSubpixelBits>(hn::Add(min3_lanes(p, q, r), before)),
                   set(origin));
  };
  const auto last_of = [&](I p, I q, I r, int origin) HWY_ATTR {
    return hn::Sub(hn::ShiftRight<kSubpixelBits>(hn::Sub(max3_lanes(p, q, r), half)), set(origin));
  };
  const I x0 = first_of(a.x, b.x, c.x, view.x0), x1 = last_of(a.x, b.x, c.x, view.x0);
  const I y0 = first_of(a.y, b.y, c.y, view.y0), y1 = last_of(a.y, b.y, c.y, view.y0);
  static_assert(kBinSize == 1 << 6);
  const I column = hn::ShiftRight<6>(x0), row = hn::ShiftRight<6>(y0);
  const I last_column = hn::ShiftRight<6>(x1), last_row = hn::ShiftRight<6>(y1);
  const I most = set(kMostRows);
  const auto is_small = hn::And(hn::Lt(hn::Sub(x1, x0), most), hn::Lt(hn::Sub(y1, y0), most));
  const std::uint32_t small = lanes & lane_bits(is_small);
  if (small == 0) return 0;
  const auto inside = [&](I bin, int end)
                          HWY_ATTR { return hn::And(hn::Gt(bin, set(-1)), hn::Lt(bin, set(end))); };
  const int columns = (view.x1 - view.x0 + kBinSize - 1) / kBinSize;
  const int rows = (view.y1 - view.y0 + kBinSize - 1) / kBinSize;
  const std::uint32_t in_one =
      small & lane_bits(hn::And(hn::And(hn::Eq(column, last_column), hn::Eq(row, last_row)),
                                hn::And(inside(column, columns), inside(row, rows))));
  const auto away = hn::RebindMask(d, lane_mask(from.facing_away));
  // Corners in the bin, in the order of the winding.
  constexpr int kBinBits = 6 + kSubpixelBits;
  const I origin_x = hn::Add(hn::ShiftLeft<kBinBits>(column), set(view.x0 * kSubpixels));
  const I origin_y = hn::Add(hn::ShiftLeft<kBinBits>(row), set(view.y0 * kSubpixels));
  const auto corner = [&](I x, I y) HWY_ATTR {
    return hn::Or(hn::And(hn::Sub(x, origin_x), set(0xFFFF)),
                  hn::ShiftLeft<16>(hn::Sub(y, origin_y)));
  };
  const I of_b = corner(b.x, b.y), of_c = corner(c.x, c.y);
  HWY_ALIGN std::uint32_t ids[kLanes];
  const auto first_id = static_cast<std::uint32_t>(in.first_id);
  if (in.numbers != nullptr) {
    for (std::size_t i = 0; i < kLanes; ++i)
      ids[i] = (small >> i & 1) != 0 ? first_id + in.numbers[in.first + triangle[i]] : 0;
  } else {
    const U32 du;
    hn::Store(hn::Add(hn::LoadU(du, triangle),
                      hn::Set(du, first_id + static_cast<std::uint32_t>(in.first))),
              du, ids);
  }
  const I bin = hn::Add(hn::Add(hn::Mul(row, set(columns)), column),
                        hn::IfThenElseZero(away, set(static_cast<int>(in.bins.later))));
  HWY_ALIGN std::int32_t first[kLanes * 4], second[kLanes * 4];
  hn::StoreInterleaved4(corner(a.x, a.y), hn::IfThenElse(away, of_b, of_c),
                        hn::IfThenElse(away, of_c, of_b), hn::BitCast(d, a.depth), d, first);
  hn::StoreInterleaved4(hn::BitCast(d, hn::LoadU(df, from.zx)),
                        hn::BitCast(d, hn::LoadU(df, from.zy)),
                        hn::BitCast(d, hn::Load(U32{}, ids)), bin, d, second);
  const I128 d4;
  const auto copy = [&](std::uint32_t lane) HWY_ATTR {
    auto* const to = reinterpret_cast<std::int32_t*>(in.small + out.small++);
    hn::Store(hn::Load(d4, first + lane * 4), d4, to);
    hn::Store(hn::Load(d4, second + lane * 4), d4, to + 4);
  };
  for (std::uint32_t rest = in_one; rest != 0; rest &= rest - 1)
    copy(static_cast<std::uint32_t>(std::countr_zero(rest)));
  if (small == in_one) return small;
  // One in each bin of the box: corners lie up to kMostRows px outside.
  HWY_ALIGN std::int32_t left[kLanes], top[kLanes], right[kLanes], bottom[kLanes];
  hn::Store(column, d, left);
  hn::Store(row, d, top);
  hn::Store(last_column, d, right);
  hn::Store(last_row, d, bottom);
  for (std::uint32_t rest = small & ~in_one; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
    for (int y = std::max(top[i], 0); y <= std::min(bottom[i], rows - 1); ++y)
      for (int x = std::max(left[i], 0); x <= std::min(right[i], columns - 1); ++x) {
        copy(i);
        BinTriangle& of = in.small[out.small - 1];
        const int dx = x - left[i], dy = y - top[i];
        of.bin += static_cast<std::uint32_t>(dy * columns + dx);
        for (BinTriangle::Corner& at : of.corner)
          at = {static_cast<std::int16_t>(at.x - (dx << kBinBits)),
                static_cast<std::int16_t>(at.y - (dy << kBinBits))};
      }
  }
  return small;
}

/// Writes the triangles of `lanes` as pieces, or as fragments those with a mask in `micro`. kMoved:
/// `a`, `b` and `c` are moved for sample `number`.
template <bool kMoved>
HWY_INLINE void write(const SetupInput& in, const Corners& a, const Corners& b, const Corners& c,
                      const PieceLanes& from, std::uint32_t number, std::uint32_t lanes,
                      const std::uint32_t* triangle, const std::uint32_t* micro, Piece* pieces,
                      BinFragment* fragments, SetupOutput& out) {
  const U32 d;
  const std::uint32_t small =
      lanes & ~lane_bits(hn::RebindMask(I32{}, hn::Eq(hn::LoadU(d, micro), hn::Zero(d))));
  std::uint32_t large = lanes & ~small;
  if (in.small != nullptr && large != 0) {
    const std::uint32_t written = write_small(in, a, b, c, from, large, triangle, out);
    out.small_triangles += static_cast<std::uint32_t>(std::popcount(written));
    large &= ~written;
  }
  if (large != 0) write_pieces<kMoved>(in, from, number, large, triangle, pieces, out);
  if (small == 0) return;
  out.micro += static_cast<std::uint32_t>(std::popcount(small));
  out.fragments +=
      write_fragments(in, a, b, c, from, small, triangle, micro, fragments + out.fragments);
}

/// Lanes of triangles whose box has a sample of the view.
HWY_INLINE std::uint32_t seen_lanes(const Corners& a, const Corners& b, const Corners& c,
                                    const SetupInput& in) {
  const I32 d;
  const I left = min3_lanes(a.x, b.x, c.x), right = max3_lanes(a.x, b.x, c.x);
  const I top = min3_lanes(a.y, b.y, c.y), bottom = max3_lanes(a.y, b.y, c.y);
  // Whether the box has no sample that lies `at` from its pixel's centre.
  const auto empty = [&](I least, I most, int at, int begin, int end) HWY_ATTR {
    const I first = hn::ShiftRight<kSubpixelBits>(hn::Add(least, hn::Set(d, kHalfPixel - 1 - at)));
    const I last = hn::ShiftRight<kSubpixelBits>(hn::Sub(most, hn::Set(d, kHalfPixel + at)));
    return hn::Gt(hn::Max(first, hn::Set(d, begin)), hn::Min(last, hn::Set(d, end - 1)));
  };
  std::uint32_t seen = 0;
  for (const SampleOffset at : in.samples)
    seen |= ~lane_bits(hn::Or(empty(left, right, at.x, in.view.x0, in.view.x1),
                              empty(top, bottom, at.y, in.view.y0, in.view.y1)));
  return seen;
}

// The functions below are out of line because setup would have several copies: inlined it was 67 KB
// of code instead of 25, and no faster.

/// The triangles of `lanes` for several samples, each with its own classes.
HWY_NOINLINE void write_sampled(const SetupInput& in, const Corners& a, const Corners& b,
                                const Corners& c, const PieceLanes& set_up, std::uint32_t lanes,
                                const std::uint32_t* triangle, Piece* pieces,
                                BinFragment* fragments, SetupOutput& out) {
  std::uint32_t seen = 0;
  if (in.together) {
    seen = lanes & seen_lanes(a, b, c, in);
    write_pieces<false>(in, set_up, 0, seen, triangle, pieces, out);
  }
  for (std::uint32_t s = 0; !in.together && s < in.samples.size(); ++s) {
    const SampleOffset at = in.samples[s];
    const Corners at_a = moved_lanes(a, at), at_b = moved_lanes(b, at), at_c = moved_lanes(c, at);
    const Classes classes = classify<false>(at_a, at_b, at_c, in);
    const std::uint32_t none = classes.none & lanes;
    out.micro += static_cast<std::uint32_t>(std::popcount(none));
    seen |= (classes.drawn & lanes) | none;
    write<true>(in, at_a, at_b, at_c, set_up, s, classes.drawn & lanes, triangle, classes.micro,
                pieces, fragments, out);
  }
  for (; seen != 0; seen &= seen - 1) {
    const std::uint32_t bit = in.first_seen + triangle[std::countr_zero(seen)];
    in.seen[bit / 64] |= std::uint64_t{1} << bit % 64;
  }
}

/// Sets up the triangles of `lanes` and writes them. `micro`: with one sample only.
HWY_NOINLINE void make_pieces(const SetupInput& in, const Corners& a, const Corners& b,
                              const Corners& c, std::uint32_t lanes, const std::uint32_t* triangle,
                              const std::uint32_t* micro, Piece* pieces, BinFragment* fragments,
                              SetupOutput& out) {
  PieceLanes set_up;
  set_up_lanes(a, b, c, set_up);
  if (in.samples.empty())
    write<false>(in, a, b, c, set_up, 0, lanes, triangle, micro, pieces, fragments, out);
  else
    write_sampled(in, a, b, c, set_up, lanes, triangle, pieces, fragments, out);
}

/// Finds triangles that some sample may see; each sample tests the rest.
HWY_NOINLINE Classes classify_sampled(const Corners& a, const Corners& b, const Corners& c,
                                      const SetupInput& in) {
  const I32 d;
  Classes classes;
  const std::uint32_t clipped = clipped_lanes(a, b, c);
  classes.slow = left_to_clipper(a, b, c, clipped);
  // The pixels that a box touches.
  const I last = hn::Set(d, kSubpixels - 1);
  const auto outside = [&](I p, I q, I r, int first, int end) HWY_ATTR {
    const I least = min3_lanes(p, q, r), most = max3_lanes(p, q, r);
    return hn::Or(hn::Lt(hn::ShiftRight<kSubpixelBits>(hn::Add(most, last)), hn::Set(d, first)),
                  hn::Gt(hn::ShiftRight<kSubpixelBits>(least), hn::Set(d, end)));
  };
  const std::uint32_t away = lane_bits(hn::Or(outside(a.x, b.x, c.x, in.view.x0, in.view.x1),
                                              outside(a.y, b.y, c.y, in.view.y0, in.view.y1)));
  const std::uint32_t near_view = ((1U << kLanes) - 1) & ~(away | clipped);
  if (near_view != 0) classes.drawn = near_view & ~culled_lanes(a, b, c, in.cull);
  return classes;
}

/// Sets up the first `n` ≤ kLanes waiting triangles.
HWY_NOINLINE void make_pieces(const SetupInput& in, Waiting& waiting, std::uint32_t n,
                              Piece* pieces, BinFragment* fragments, SetupOutput& out) {
  for (std::uint32_t* const corner : {waiting.index[0], waiting.index[1], waiting.index[2]})
    std::fill(corner + n, corner + kLanes, corner[0]);
  const Corners a = load_corners(in, waiting.index[0]);
  const Corners b = load_corners(in, waiting.index[1]);
  const Corners c = load_corners(in, waiting.index[2]);
  make_pieces(in, a, b, c, (1U << n) - 1, waiting.triangle, waiting.micro, pieces, fragments, out);
  waiting.drop(n);
}

/// With so many of kLanes, setting up at once is cheaper than gathering them with others.
constexpr std::uint32_t kDense = kLanes - kLanes / 4;
constexpr std::uint32_t kAllLanes = (1U << kLanes) - 1;

SetupOutput setup(const SetupInput& in, Piece* pieces, BinFragment* fragments,
                  std::uint32_t* slow) noexcept {
  SetupOutput result;
  Waiting waiting;
  std::uint32_t index[3][kLanes];
  std::uint32_t i = 0;
  for (; i < in.count; i += kLanes) {
    if (!load_indices(in, i, index)) {
      result.index_in_range = false;
      return result;
    }
    const std::uint32_t there = in.count - i < kLanes ? (1U << (in.count - i)) - 1 : kAllLanes;
    const Corners a = load_corners(in, index[0]);
    const Corners b = load_corners(in, index[1]);
    const Corners c = load_corners(in, index[2]);
    const Classes classes =
        in.samples.empty() ? classify<true>(a, b, c, in) : classify_sampled(a, b, c, in);
    for (std::uint32_t rest = classes.slow & there; rest != 0; rest &= rest - 1)
      slow[result.slow++] = i + static_cast<std::uint32_t>(std::countr_zero(rest));
    result.micro += static_cast<std::uint32_t>(std::popcount(classes.none & there));
    const std::uint32_t drawn = classes.drawn & there;
    if (static_cast<std::uint32_t>(std::popcount(drawn)) >= kDense) {
      if (waiting.count != 0) make_pieces(in, waiting, waiting.count, pieces, fragments, result);
      HWY_ALIGN std::uint32_t triangle[kLanes];
      hn::Store(hn::Iota(U32{}, i), U32{}, triangle);
      make_pieces(in, a, b, c, drawn, triangle, classes.micro, pieces, fragments, result);
      continue;
    }
    if (drawn == 0) continue;
    waiting.add(index, drawn, i, classes.micro);
    if (waiting.count >= kLanes) make_pieces(in, waiting, kLanes, pieces, fragments, result);
  }
  if (waiting.count != 0) make_pieces(in, waiting, waiting.count, pieces, fragments, result);
  return result;
}

/// kLanes points of one pixel, from `in.vertices + first` on.
HWY_INLINE void one_pixel_points(const PointsInput& in, std::uint32_t first, BinFragment* fragments,
                                 std::uint32_t* slow, SetupOutput& out) {
  const F32 df;
  const I32 di;
  const auto set = [&](int v) HWY_ATTR { return hn::Set(di, v); };
  I vx, vy, bits, inv_w;
  hn::LoadInterleaved4(di, reinterpret_cast<const std::int32_t*>(in.vertices + first), vx, vy, bits,
                       inv_w);
  const std::uint32_t clipped = lane_bits(hn::Eq(vx, set(kNeedsClip)));
  // ⌈v / 256⌉ − 1, as in point_square.
  const I x = hn::ShiftRight<kSubpixelBits>(hn::Sub(vx, set(1)));
  const I y = hn::ShiftRight<kSubpixelBits>(hn::Sub(vy, set(1)));
  const auto inside = [&](I v, int begin, int end) HWY_ATTR {
    return hn::And(hn::Gt(v, set(begin - 1)), hn::Lt(v, set(end)));
  };
  std::uint32_t drawn =
      lane_bits(hn::And(inside(x, in.view.x0, in.view.x1), inside(y, in.view.y0, in.view.y1))) &
      ~clipped;
  // The depth formula without slopes.
  const F z = hn::BitCast(df, bits);
  const F depth = hn::Min(hn::IfThenElseZero(hn::Gt(z, hn::Zero(df)), z), hn::Set(df, 1.0F));
  const I flagged =
      hn::Or(pixel_in_bin(x, y),
             set((in.flags & kTranslucent) != 0 ? static_cast<int>(kTranslucentFragment) : 0));
  HWY_ALIGN std::int32_t bins[kLanes], pixels[kLanes], depths[kLanes];
  hn::Store(bin_of(x, y, in.bin_columns), di, bins);
  hn::Store(flagged, di, pixels);
  hn::Store(hn::BitCast(di, depth), di, depths);
  for (std::uint32_t rest = clipped; rest != 0; rest &= rest - 1)
    slow[out.slow++] = first + static_cast<std::uint32_t>(std::countr_zero(rest));
  const std::uint64_t low = kIdMask - (in.first_id + first);
  out.micro += static_cast<std::uint32_t>(std::popcount(drawn));
  for (; drawn != 0; drawn &= drawn - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(drawn));
    fragments[out.fragments++] = {
        std::uint64_t{static_cast<std::uint32_t>(depths[i])} << kIdBits | (low - i),
        static_cast<std::uint32_t>(bins[i]), static_cast<std::uint32_t>(pixels[i])};
  }
}

SetupOutput points(const PointsInput& in, BinFragment* fragments, std::uint32_t* slow) noexcept {
  SetupOutput out;
  std::uint32_t i = 0;
  if (in.sizes == nullptr)
    for (; i + kLanes <= in.count; i += kLanes) one_pixel_points(in, i, fragments, slow, out);
  if (i == in.count) return out;
  // Larger ones, and the last few, by the scalar form.
  PointsInput rest = in;
  rest.vertices += i;
  rest.count -= i;
  rest.first_id += i;
  const SetupOutput tail =
      kernels(Isa::scalar).points(rest, fragments + out.fragments, slow + out.slow);
  for (std::uint32_t t = 0; t < tail.slow; ++t) slow[out.slow + t] += i;
  out.fragments += tail.fragments;
  out.micro += tail.micro;
  out.slow += tail.slow;
  return out;
}

void fill(Kernels& table) {
  table.points = points;
  table.project = project;
  table.project64 = project64;
  table.setup = setup;
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::raster {

FillKernels fill_setup_kernels(Isa isa) noexcept {
  static constexpr FillKernels kFill[] = RASTRUM_BY_ISA(fill, nullptr);
  return kFill[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::raster
#endif
