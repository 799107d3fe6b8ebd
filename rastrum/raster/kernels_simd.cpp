// The pipeline's kernels with Highway, compiled once per instruction set. Each repeats the
// operations of its scalar twin (kernels.cpp and the headers it uses) in the same order, so it
// gives the same bits. Vectors have 4 or 8 lanes: a row of a block is 8 samples.

// SSSE3 adds nothing over the scalar build that SSE4 does not; AVX3_DL nothing that these kernels
// use.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/kernels_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include <rastrum/raster/color.hpp>
#include <rastrum/raster/coverage.hpp>
#include <rastrum/raster/kernels_simd.hpp>
#include <rastrum/raster/setup.hpp>

// The scalar kernels stand in for Highway's baseline target.
#if HWY_TARGET != HWY_SCALAR
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F32 = hn::CappedTag<float, 8>;
using I32 = hn::RebindToSigned<F32>;
using U32 = hn::RebindToUnsigned<F32>;
using F64 = hn::CappedTag<double, 4>;
using I64 = hn::CappedTag<std::int64_t, 4>;
using F = hn::Vec<F32>;
using I = hn::Vec<I32>;
using D = hn::Vec<F64>;
constexpr std::size_t kLanes = hn::MaxLanes(F32{});
constexpr std::size_t kLanes64 = hn::MaxLanes(F64{});
constexpr std::size_t kHalves = kLanes / kLanes64;

// ---------------------------------------------------------------------------------------- project

HWY_INLINE F row_times(const float (&m)[4], F x, F y, F z) {
  const F32 d;
  const F xy = hn::Add(hn::Mul(hn::Set(d, m[0]), x), hn::Mul(hn::Set(d, m[1]), y));
  return hn::Add(hn::Add(xy, hn::Mul(hn::Set(d, m[2]), z)), hn::Set(d, m[3]));
}

HWY_INLINE void project_lanes(F x, F y, F z, const Mat4& m, Viewport viewport,
                              ProjectedVertex* out) {
  const F32 d;
  const I32 di;
  const F cx = row_times(m.m[0], x, y, z);
  const F cy = row_times(m.m[1], x, y, z);
  const F cz = row_times(m.m[2], x, y, z);
  const F cw = row_times(m.m[3], x, y, z);
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
  hn::StoreInterleaved4(hn::IfThenElse(oki, x8, hn::Set(di, kNeedsClip)), y8,
                        hn::BitCast(di, hn::IfThenElseZero(ok, depth)),
                        hn::BitCast(di, hn::IfThenElseZero(ok, inv_w)), di,
                        reinterpret_cast<std::int32_t*>(out));
}

void project(const Vec3* positions, std::size_t n, const Mat4& m, Viewport viewport,
             ProjectedVertex* out) noexcept {
  const F32 d;
  F x, y, z;
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    hn::LoadInterleaved3(d, &positions[i].x, x, y, z);
    project_lanes(x, y, z, m, viewport, out + i);
  }
  if (i == n) return;
  Vec3 rest[kLanes] = {};
  ProjectedVertex projected[kLanes];
  std::copy_n(positions + i, n - i, rest);
  hn::LoadInterleaved3(d, &rest[0].x, x, y, z);
  project_lanes(x, y, z, m, viewport, projected);
  std::copy_n(projected, n - i, out + i);
}

// ------------------------------------------------------------------------------------------ setup

/// Corner vertices of kLanes triangles, transposed.
struct Corners {
  I x, y;
  F depth;
};

using I128 = hn::Full128<std::int32_t>;

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

HWY_INLINE Corners load_corners(const ProjectedVertex* v, const std::uint32_t* index) {
  const F32 d;
  hn::Vec<I128> x, y, depth;
  transpose4(v, index, x, y, depth);
#if HWY_MAX_BYTES >= 32
  const I32 di;
  hn::Vec<I128> x1, y1, depth1;
  transpose4(v, index + 4, x1, y1, depth1);
  return {hn::Combine(di, x1, x), hn::Combine(di, y1, y),
          hn::BitCast(d, hn::Combine(di, depth1, depth))};
#else
  return {x, y, hn::BitCast(d, depth)};
#endif
}

HWY_INLINE D half_to_double(I v, std::size_t half) {
  const F64 d;
#if HWY_MAX_BYTES >= 32
  const hn::Half<I32> dh;
  return hn::PromoteTo(d, half == 0 ? hn::LowerHalf(dh, v) : hn::UpperHalf(dh, v));
#else
  const hn::Half<I32> dh;
  return hn::PromoteTo(
      d, half == 0 ? hn::LowerHalf(dh, v) : hn::LowerHalf(dh, hn::ConcatUpperUpper(I32{}, v, v)));
#endif
}

HWY_INLINE D half_to_double(F v, std::size_t half) {
  const F64 d;
  const hn::Half<F32> dh;
#if HWY_MAX_BYTES >= 32
  return hn::PromoteTo(d, half == 0 ? hn::LowerHalf(dh, v) : hn::UpperHalf(dh, v));
#else
  return hn::PromoteTo(
      d, half == 0 ? hn::LowerHalf(dh, v) : hn::LowerHalf(dh, hn::ConcatUpperUpper(F32{}, v, v)));
#endif
}

/// The indices of kLanes triangles by corner, and whether all are in range.
HWY_INLINE bool load_indices(const SetupInput& in, std::uint32_t offset,
                             std::uint32_t (&index)[3][kLanes]) {
  const U32 d;
  const std::uint64_t t = in.first + offset;
  if (in.indices == nullptr) {
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      for (std::size_t c = 0; c < 3; ++c)
        index[c][lane] = static_cast<std::uint32_t>((t + lane) * 3 + c);
    return (t + kLanes) * 3 <= in.vertex_count;
  }
  hn::Vec<U32> i0, i1, i2;
  hn::LoadInterleaved3(d, in.indices + t * 3, i0, i1, i2);
  hn::StoreU(i0, d, index[0]);
  hn::StoreU(i1, d, index[1]);
  hn::StoreU(i2, d, index[2]);
  const auto largest = hn::Max(i0, hn::Max(i1, i2));
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

template <class M>
HWY_INLINE std::uint32_t lane_bits(M mask) {
  std::uint8_t bits = 0;
  hn::StoreMaskBits(I32{}, mask, &bits);
  return bits & ((1U << kLanes) - 1);
}

/// Triangles by lane.
struct Classes {
  std::uint32_t drawn = 0;  ///< may cover a sample
  std::uint32_t none = 0;   ///< micro triangles that would be drawn, but cover no sample
  std::uint32_t slow = 0;   ///< need the clipper
  HWY_ALIGN std::uint32_t micro[kLanes] = {};  ///< covered samples of micro triangles, 0 for others
};

/// Negates v in the lanes where m is −1.
HWY_INLINE I negate_if(I v, I m) {
  return hn::Sub(hn::Xor(v, m), m);
}

/// Coverage of micro triangles, a lane each: the sign bits of the edge functions at kMicroSize²
/// samples from (x0, y0) on. Boxes of up to 5 px keep every product far inside int32.
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
    const auto top_left = hn::Or(hn::Gt(ea, zero), hn::And(hn::Eq(ea, zero), hn::Gt(eb, zero)));
    const I at = hn::Add(hn::Mul(ea, hn::Sub(px, from.x)), hn::Mul(eb, hn::Sub(py, from.y)));
    value[i] = hn::Sub(at, hn::IfThenZeroElse(top_left, hn::Set(d, 1)));
    dx[i] = hn::ShiftLeft<kSubpixelBits>(ea);
    dy[i] = hn::ShiftLeft<kSubpixelBits>(eb);
  };
  edge(0, a, b);
  edge(1, b, c);
  edge(2, c, a);
  I outside = zero;
  // Backwards, so that shifting the collected bits left leaves the first sample in bit 0.
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

HWY_INLINE Classes classify(const Corners& a, const Corners& b, const Corners& c,
                            const SetupInput& in) {
  const I32 d;
  Classes classes;
  const I needs_clip = hn::Set(d, kNeedsClip);
  const auto clip =
      hn::Or(hn::Eq(a.x, needs_clip), hn::Or(hn::Eq(b.x, needs_clip), hn::Eq(c.x, needs_clip)));
  const I before = hn::Set(d, kHalfPixel - 1);
  const I half = hn::Set(d, kHalfPixel);
  // First and last sample of the box; inclusive.
  const I x0 = hn::ShiftRight<kSubpixelBits>(hn::Add(min3_lanes(a.x, b.x, c.x), before));
  const I y0 = hn::ShiftRight<kSubpixelBits>(hn::Add(min3_lanes(a.y, b.y, c.y), before));
  const I x1 = hn::ShiftRight<kSubpixelBits>(hn::Sub(max3_lanes(a.x, b.x, c.x), half));
  const I y1 = hn::ShiftRight<kSubpixelBits>(hn::Sub(max3_lanes(a.y, b.y, c.y), half));
  const auto empty =
      hn::Or(hn::Gt(hn::Max(x0, hn::Set(d, in.view.x0)), hn::Min(x1, hn::Set(d, in.view.x1 - 1))),
             hn::Gt(hn::Max(y0, hn::Set(d, in.view.y0)), hn::Min(y1, hn::Set(d, in.view.y1 - 1))));
  constexpr std::uint32_t kAll = (1U << kLanes) - 1;
  classes.slow = lane_bits(clip);
  const std::uint32_t in_view = kAll & ~(lane_bits(empty) | classes.slow);
  if (in_view == 0) return classes;

  const I dx1 = hn::Sub(b.x, a.x), dy1 = hn::Sub(b.y, a.y);
  const I dx2 = hn::Sub(c.x, a.x), dy2 = hn::Sub(c.y, a.y);
  const I size = hn::Set(d, kMicroSize);
  const auto small = hn::And(hn::Lt(hn::Sub(x1, x0), size), hn::Lt(hn::Sub(y1, y0), size));
  const std::uint32_t micro = (in.flags & kTested) != 0 ? 0U : lane_bits(small) & in_view;
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
  if (micro != in_view) {
    // Twice the area, exact in float64: differences have 25 bits, products 50.
    std::uint32_t large_culled = 0;
    for (std::size_t h = 0; h < kHalves; ++h) {
      const F64 dd;
      const D area = hn::Sub(hn::Mul(half_to_double(dx1, h), half_to_double(dy2, h)),
                             hn::Mul(half_to_double(dx2, h), half_to_double(dy1, h)));
      const D zero = hn::Zero(dd);
      auto out = hn::Eq(area, zero);
      if (in.cull == Cull::back) out = hn::Or(out, hn::Gt(area, zero));
      if (in.cull == Cull::front) out = hn::Or(out, hn::Lt(area, zero));
      std::uint8_t bits = 0;
      hn::StoreMaskBits(dd, out, &bits);
      large_culled |= (bits & ((1U << kLanes64) - 1)) << (h * kLanes64);
    }
    culled |= large_culled & ~micro;
  }
  classes.drawn = in_view & ~culled & ~classes.none;
  return classes;
}

/// The covered samples of a micro triangle as fragments. By value, so that it stays in registers.
HWY_INLINE std::uint32_t write_fragments(const Piece p, std::uint32_t mask, const SetupInput& in,
                                         BinFragment* out) {
  const int first_x = (min3(p.x[0], p.x[1], p.x[2]) + kHalfPixel - 1) >> kSubpixelBits;
  const int first_y = (min3(p.y[0], p.y[1], p.y[2]) + kHalfPixel - 1) >> kSubpixelBits;
  std::uint32_t n = 0;
  for (; mask != 0; mask &= mask - 1) {
    const int sample = std::countr_zero(mask);
    const int x = first_x + sample % kMicroSize, y = first_y + sample / kMicroSize;
    if (x < in.view.x0 || x >= in.view.x1 || y < in.view.y0 || y >= in.view.y1) continue;
    const auto ux = static_cast<std::uint32_t>(x), uy = static_cast<std::uint32_t>(y);
    out[n++] = {make_word(depth_at(p, x, y), p.low), uy / kBinSize * in.bin_columns + ux / kBinSize,
                (uy % kBinSize / kBlockSize * kBlocksPerBinRow + ux % kBinSize / kBlockSize) * 64 +
                    uy % kBlockSize * kBlockSize + ux % kBlockSize};
  }
  return n;
}

/// Triangles that wait until there are kLanes of them: a third of a closed mesh survives culling.
struct Waiting {
  std::uint32_t count = 0;
  std::uint32_t index[3][2 * kLanes];
  std::uint32_t triangle[2 * kLanes];
  std::uint32_t micro[2 * kLanes];

  void add(const std::uint32_t (&corners)[3][kLanes], std::size_t lane, std::uint32_t t,
           std::uint32_t micro_mask) {
    for (std::size_t c = 0; c < 3; ++c) index[c][count] = corners[c][lane];
    triangle[count] = t;
    micro[count++] = micro_mask;
  }
  /// Forgets the first n, which are all or kLanes.
  void drop(std::uint32_t n) {
    count -= n;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t c = 0; c < 3; ++c) index[c][i] = index[c][i + n];
      triangle[i] = triangle[i + n];
      micro[i] = micro[i + n];
    }
  }
};

/// Sets up the first `n` ≤ kLanes waiting triangles.
HWY_INLINE void make_pieces(const SetupInput& in, Waiting& waiting, std::uint32_t n, Piece* pieces,
                            BinFragment* fragments, SetupOutput& out) {
  std::uint32_t index[3][kLanes];
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < kLanes; ++i) index[c][i] = waiting.index[c][i < n ? i : 0];
  const F32 df;
  const I32 di;
  const Corners a = load_corners(in.vertices, index[0]);
  const Corners b = load_corners(in.vertices, index[1]);
  const Corners c = load_corners(in.vertices, index[2]);
  const I dx1 = hn::Sub(b.x, a.x), dy1 = hn::Sub(b.y, a.y);
  const I dx2 = hn::Sub(c.x, a.x), dy2 = hn::Sub(c.y, a.y);
  HWY_ALIGN float zx[kLanes], zy[kLanes], sign[kLanes];
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
    hn::StoreU(hn::DemoteTo(dh, gx), dh, zx + h * kLanes64);
    hn::StoreU(hn::DemoteTo(dh, gy), dh, zy + h * kLanes64);
    hn::StoreU(hn::DemoteTo(dh, det), dh, sign + h * kLanes64);
  }
  // |det| ≥ 1, so its sign survives the rounding to float32.
  const auto keep = hn::RebindMask(di, hn::Gt(hn::LoadU(df, sign), hn::Zero(df)));
  const I sx = hn::IfThenElse(keep, b.x, c.x), sy = hn::IfThenElse(keep, b.y, c.y);
  const I tx = hn::IfThenElse(keep, c.x, b.x), ty = hn::IfThenElse(keep, c.y, b.y);
  HWY_ALIGN std::int32_t first[kLanes * 4], second[kLanes * 4];
  hn::StoreInterleaved4(a.x, sx, tx, a.y, di, first);
  hn::StoreInterleaved4(sy, ty, hn::BitCast(di, a.depth), hn::BitCast(di, hn::LoadU(df, zx)), di,
                        second);
  const I128 d128;
  for (std::uint32_t i = 0; i < n; ++i) {
    Piece& piece = pieces[out.pieces];
    auto* words = reinterpret_cast<std::int32_t*>(&piece);
    hn::Store(hn::Load(d128, first + i * 4), d128, words);
    hn::Store(hn::Load(d128, second + i * 4), d128, words + 4);
    piece.zy = zy[i];
    piece.flags = in.flags;
    piece.low = kIdMask - (in.first_id + in.first + waiting.triangle[i]);
    if (waiting.micro[i] == 0) {
      ++out.pieces;
      continue;
    }
    ++out.micro;
    out.fragments += write_fragments(piece, waiting.micro[i], in, fragments + out.fragments);
  }
  waiting.drop(n);
}

SetupOutput setup(const SetupInput& in, Piece* pieces, BinFragment* fragments,
                  std::uint32_t* slow) noexcept {
  SetupOutput result;
  Waiting waiting;
  std::uint32_t index[3][kLanes];
  std::uint32_t i = 0;
  for (; i + kLanes <= in.count; i += kLanes) {
    if (!load_indices(in, i, index)) {
      result.index_in_range = false;
      return result;
    }
    const Corners a = load_corners(in.vertices, index[0]);
    const Corners b = load_corners(in.vertices, index[1]);
    const Corners c = load_corners(in.vertices, index[2]);
    const Classes classes = classify(a, b, c, in);
    for (std::uint32_t rest = classes.slow; rest != 0; rest &= rest - 1)
      slow[result.slow++] = i + static_cast<std::uint32_t>(std::countr_zero(rest));
    result.micro += static_cast<std::uint32_t>(std::popcount(classes.none));
    for (std::uint32_t rest = classes.drawn; rest != 0; rest &= rest - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
      waiting.add(index, lane, i + lane, classes.micro[lane]);
    }
    if (waiting.count >= kLanes) make_pieces(in, waiting, kLanes, pieces, fragments, result);
  }
  if (waiting.count != 0) make_pieces(in, waiting, waiting.count, pieces, fragments, result);
  if (i == in.count) return result;
  // The last few triangles of a draw take the scalar way, which is the same arithmetic.
  SetupInput rest = in;
  rest.first += i;
  rest.count -= i;
  const SetupOutput tail =
      kernels(Isa::scalar)
          .setup(rest, pieces + result.pieces, fragments + result.fragments, slow + result.slow);
  for (std::uint32_t t = 0; t < tail.slow; ++t) slow[result.slow + t] += i;
  result.pieces += tail.pieces;
  result.slow += tail.slow;
  result.index_in_range = tail.index_in_range;
  return result;
}

// ------------------------------------------------------------------------------------------ cover

/// cover_8x8 from the three edges' values at the block's first sample, clamped to int32.
HWY_INLINE std::uint64_t cover_block(const std::int32_t (&base)[3], const I (&steps)[3][8 / kLanes],
                                     const std::int32_t (&b)[3]) {
  const I32 d;
  std::uint64_t mask = 0;
  for (std::size_t part = 0; part < 8 / kLanes; ++part) {
    I e0 = hn::Add(hn::Set(d, base[0]), steps[0][part]);
    I e1 = hn::Add(hn::Set(d, base[1]), steps[1][part]);
    I e2 = hn::Add(hn::Set(d, base[2]), steps[2][part]);
    const I b0 = hn::Set(d, b[0]), b1 = hn::Set(d, b[1]), b2 = hn::Set(d, b[2]);
    for (std::size_t row = 0; row < 8; ++row) {
      // A negative value of any edge sets the sign bit: outside.
      const I any = hn::Or(hn::Or(e0, e1), e2);
      std::uint8_t outside = 0;
      hn::StoreMaskBits(d, hn::Lt(any, hn::Zero(d)), &outside);
      const std::uint64_t inside = static_cast<std::uint64_t>(~outside) & ((1U << kLanes) - 1);
      mask |= inside << (row * 8 + part * kLanes);
      e0 = hn::Add(e0, b0);
      e1 = hn::Add(e1, b1);
      e2 = hn::Add(e2, b2);
    }
  }
  return mask;
}

/// Whether every edge value at the samples of blocks that the piece's box touches fits int32: with
/// differences up to 2^14 (64 px) and samples up to 8 px outside, |E| < 2 · 2^14 · (2^14 + 2^11) <
/// 2^30.
HWY_INLINE bool is_small(const Piece& p) {
  constexpr int kMost = 1 << 14;
  return max3(p.x[0], p.x[1], p.x[2]) - min3(p.x[0], p.x[1], p.x[2]) < kMost &&
         max3(p.y[0], p.y[1], p.y[2]) - min3(p.y[0], p.y[1], p.y[2]) < kMost;
}

/// The blocks of a small piece: its three edges are set up in the lanes of one vector.
template <class Add>
HWY_INLINE void small_cover(const Piece& p, int bx0, int by0, int bx1, int by1, const Add& add) {
  const I32 d;
  const int px = bx0 * (kBlockSize * kSubpixels) + kHalfPixel;
  const int py = by0 * (kBlockSize * kSubpixels) + kHalfPixel;
  std::int32_t row_base[3], a[3], b[3];
  I steps[3][8 / kLanes];
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    a[i] = p.y[i] - p.y[j];
    b[i] = p.x[j] - p.x[i];
    const std::int32_t not_top_left = (a[i] > 0 || (a[i] == 0 && b[i] > 0)) ? 0 : 1;
    row_base[i] = (a[i] * (px - p.x[i]) + b[i] * (py - p.y[i]) - not_top_left) >> kSubpixelBits;
    for (std::size_t part = 0; part < 8 / kLanes; ++part)
      steps[i][part] =
          hn::Mul(hn::Set(d, a[i]), hn::Iota(d, static_cast<std::int32_t>(part * kLanes)));
  }
  for (int by = by0; by <= by1; ++by) {
    std::int32_t base[3] = {row_base[0], row_base[1], row_base[2]};
    for (int bx = bx0; bx <= bx1; ++bx) {
      add(bx, by, cover_block(base, steps, b));
      for (int i = 0; i < 3; ++i) base[i] += a[i] * kBlockSize;
    }
    for (int i = 0; i < 3; ++i) row_base[i] += b[i] * kBlockSize;
  }
}

std::size_t cover(const PieceList& in, std::size_t& cursor, Rect bin, Block* out,
                  std::size_t capacity, std::uint64_t& fragments) noexcept {
  constexpr std::int64_t kClamp = std::int64_t{1} << 30;
  const I32 d;
  const bool cut = bin.x1 % kBlockSize != 0 || bin.y1 % kBlockSize != 0;
  std::size_t n = 0;
  for (; cursor < in.count && n + kBlocksPerBin <= capacity; ++cursor) {
    if (cursor + 6 < in.count) __builtin_prefetch(in.pieces + in.list[cursor + 6].piece);
    const std::uint32_t index = in.list[cursor].piece;
    const Piece& piece = in.pieces[index];
    const Rect box = sample_bounds(piece.x, piece.y, bin);
    if (box.empty()) continue;
    const int bx0 = box.x0 / kBlockSize, by0 = box.y0 / kBlockSize;
    const int bx1 = (box.x1 - 1) / kBlockSize, by1 = (box.y1 - 1) / kBlockSize;
    const auto add = [&](int bx, int by, std::uint64_t mask) HWY_ATTR {
      if (cut) mask &= samples_inside(bin, bx, by);
      out[n] = {index, static_cast<std::uint16_t>(bx), static_cast<std::uint16_t>(by), mask};
      n += mask != 0;
      fragments += hwy::PopCount(mask);
    };
    if (is_small(piece)) {
      small_cover(piece, bx0, by0, bx1, by1, add);
      continue;
    }
    std::int32_t b[3];
    std::int64_t row_base[3], block_dx[3], block_dy[3], reach[3];
    I steps[3][8 / kLanes];
    for (int i = 0; i < 3; ++i) {
      const Edge e = edge_function(piece, i);
      b[i] = e.b;
      row_base[i] =
          e.base + std::int64_t{e.a} * (bx0 * kBlockSize) + std::int64_t{e.b} * (by0 * kBlockSize);
      block_dx[i] = std::int64_t{e.a} * kBlockSize;
      block_dy[i] = std::int64_t{e.b} * kBlockSize;
      // The largest value in a block, relative to its first sample: below 0 there, no sample is in.
      reach[i] = 7 * (std::int64_t{std::max(e.a, 0)} + std::max(e.b, 0));
      for (std::size_t part = 0; part < 8 / kLanes; ++part)
        steps[i][part] =
            hn::Mul(hn::Set(d, e.a), hn::Iota(d, static_cast<std::int32_t>(part * kLanes)));
    }
    for (int by = by0; by <= by1; ++by) {
      std::int64_t base[3] = {row_base[0], row_base[1], row_base[2]};
      for (int bx = bx0; bx <= bx1; ++bx) {
        if (base[0] + reach[0] >= 0 && base[1] + reach[1] >= 0 && base[2] + reach[2] >= 0) {
          const std::int32_t clamped[3] = {
              static_cast<std::int32_t>(std::clamp(base[0], -kClamp, kClamp)),
              static_cast<std::int32_t>(std::clamp(base[1], -kClamp, kClamp)),
              static_cast<std::int32_t>(std::clamp(base[2], -kClamp, kClamp))};
          add(bx, by, cover_block(clamped, steps, b));
        }
        for (int i = 0; i < 3; ++i) base[i] += block_dx[i];
      }
      for (int i = 0; i < 3; ++i) row_base[i] += block_dy[i];
    }
  }
  return n;
}

// ---------------------------------------------------------------------------------------- maximum

HWY_INLINE void maximum_row(F depth, std::uint64_t row_bits, std::uint64_t low, std::size_t part,
                            std::uint64_t* words) {
  const F32 df;
  const U32 du;
  const I64 d64;
  const hn::RebindToUnsigned<I64> du64;
  const hn::Half<U32> dh;
  depth = hn::Min(hn::IfThenElseZero(hn::Gt(depth, hn::Zero(df)), depth), hn::Set(df, 1.0F));
  const auto bits = hn::BitCast(du, depth);
  for (std::size_t h = 0; h < kHalves; ++h) {
#if HWY_MAX_BYTES >= 32
    const auto half = h == 0 ? hn::LowerHalf(dh, bits) : hn::UpperHalf(dh, bits);
#else
    const auto half =
        h == 0 ? hn::LowerHalf(dh, bits) : hn::LowerHalf(dh, hn::ConcatUpperUpper(du, bits, bits));
#endif
    const auto word = hn::Or(hn::ShiftLeft<kIdBits>(hn::PromoteTo(du64, half)), hn::Set(du64, low));
    const std::size_t column = part * kLanes + h * kLanes64;
    const auto mask_bits = static_cast<std::uint8_t>((row_bits >> column) & ((1U << kLanes64) - 1));
    // LoadMaskBits reads whole bytes.
    std::uint8_t mask_memory[8] = {mask_bits};
    const auto mask = hn::LoadMaskBits(d64, mask_memory);
    auto* place = reinterpret_cast<std::int64_t*>(words + column);
    // Words stay below 2^63, so the signed maximum, which AVX2 has, is the maximum.
    const auto candidate = hn::IfThenElseZero(mask, hn::BitCast(d64, word));
    hn::Store(hn::Max(hn::Load(d64, place), candidate), d64, place);
  }
}

void maximum(const Piece* pieces, const Block* blocks, std::size_t n, Rect bin,
             std::uint64_t* words) noexcept {
  constexpr float kPxPerSubpixel = 1.0F / kSubpixels;
  const F32 d;
  const int column0 = bin.x0 / kBlockSize;
  const int row0 = bin.y0 / kBlockSize;
  for (std::size_t i = 0; i < n; ++i) {
    const Block& block = blocks[i];
    const Piece& p = pieces[block.piece];
    std::uint64_t* out = words + ((block.by - row0) * kBlocksPerBinRow + (block.bx - column0)) * 64;
    const float x0 = static_cast<float>(p.x[0]) * kPxPerSubpixel;
    const float y0 = static_cast<float>(p.y[0]) * kPxPerSubpixel;
    F along_x[8 / kLanes];
    for (std::size_t part = 0; part < 8 / kLanes; ++part) {
      const F column = hn::Iota(
          d, static_cast<float>(block.bx * kBlockSize) + static_cast<float>(part * kLanes));
      const F dx = hn::Sub(hn::Add(column, hn::Set(d, 0.5F)), hn::Set(d, x0));
      along_x[part] = hn::Add(hn::Set(d, p.z0), hn::Mul(hn::Set(d, p.zx), dx));
    }
    for (std::uint64_t rest = block.mask; rest != 0;) {
      const int row = std::countr_zero(rest) / 8;
      const std::uint64_t row_bits = rest >> (row * 8) & 255;
      rest &= ~(std::uint64_t{255} << (row * 8));
      const float dy = (static_cast<float>(block.by * kBlockSize + row) + 0.5F) - y0;
      const F along_y = hn::Set(d, p.zy * dy);
      for (std::size_t part = 0; part < 8 / kLanes; ++part)
        maximum_row(hn::Add(along_x[part], along_y), row_bits, p.low, part, out + row * 8);
    }
  }
}

// ----------------------------------------------------------------------------------- store_opaque

HWY_INLINE hn::Vec<U32> quantize_lanes(const float* c) {
  const F32 d;
  const F v = hn::Load(d, c);
  const F low = hn::IfThenElseZero(hn::Gt(v, hn::Zero(d)), v);
  const F clamped = hn::Min(low, hn::Set(d, 1.0F));
  return hn::BitCast(U32{}, hn::NearestInt(hn::Mul(clamped, hn::Set(d, 255.0F))));
}

/// Lanes of the low bits of `bits`.
HWY_INLINE hn::Mask<U32> lane_mask(std::uint64_t bits) {
  // LoadMaskBits reads whole bytes.
  const std::uint8_t memory[8] = {static_cast<std::uint8_t>(bits & ((1U << kLanes) - 1))};
  return hn::LoadMaskBits(U32{}, memory);
}

void store_opaque(const BlockColors& colors, std::uint64_t covered, Rgba8 background, Rgba8* out,
                  std::ptrdiff_t stride) noexcept {
  const U32 d;
  const auto behind = hn::Set(d, std::bit_cast<std::uint32_t>(background));
  for (int row = 0; row < kBlockSize; ++row)
    for (std::size_t part = 0; part < 8; part += kLanes) {
      const std::size_t i = static_cast<std::size_t>(row) * 8 + part;
      auto pixel =
          hn::Or(quantize_lanes(colors.r + i), hn::ShiftLeft<8>(quantize_lanes(colors.g + i)));
      pixel = hn::Or(pixel, hn::ShiftLeft<16>(quantize_lanes(colors.b + i)));
      pixel = hn::Or(pixel, hn::Set(d, 0xff000000U));
      hn::StoreU(hn::IfThenElse(lane_mask(covered >> i), pixel, behind), d,
                 reinterpret_cast<std::uint32_t*>(out + row * stride + static_cast<int>(part)));
    }
}

std::uint64_t covered(const std::uint64_t* words) noexcept {
  const hn::RebindToUnsigned<I64> d;
  std::uint64_t mask = 0;
  for (std::size_t i = 0; i < 64; i += kLanes64) {
    std::uint8_t empty = 0;
    hn::StoreMaskBits(d, hn::Eq(hn::Load(d, words + i), hn::Zero(d)), &empty);
    mask |= static_cast<std::uint64_t>(~empty & ((1U << kLanes64) - 1)) << i;
  }
  return mask;
}

// Referred to by the table below through its address.
extern const Kernels kTable;
const Kernels kTable{project, setup, cover, maximum, covered, store_opaque};

}  // namespace HWY_NAMESPACE
}  // namespace rastrum::raster
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET != HWY_SCALAR

#if HWY_ONCE
namespace rastrum::raster {

const Kernels* simd_kernels(Isa isa) noexcept {
  switch (isa) {
#if HWY_TARGETS & HWY_SSE4
    case Isa::sse4:
      return &N_SSE4::kTable;
#endif
#if HWY_TARGETS & HWY_AVX2
    case Isa::avx2:
      return &N_AVX2::kTable;
#endif
#if HWY_TARGETS & HWY_AVX3
    case Isa::avx512:
      return &N_AVX3::kTable;
#endif
#if HWY_TARGETS & HWY_NEON
    case Isa::neon:
      return &N_NEON::kTable;
#endif
    default:
      return nullptr;
  }
}

}  // namespace rastrum::raster
#endif
