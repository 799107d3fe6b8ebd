// SPDX-License-Identifier: BSD-3-Clause
// Triangles in lanes, once per instruction set: vertices, boxes, depths, and which of them a bin's
// depth bounds hide (for cover_simd.cpp, sampled_keys_simd.cpp). Include it after lanes-inl.hpp,
// outside of any namespace.
#if defined(RASTRUM_RASTER_COVER_TRIANGLE_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_COVER_TRIANGLE_LANES_INL_HPP
#undef RASTRUM_RASTER_COVER_TRIANGLE_LANES_INL_HPP
#else
#define RASTRUM_RASTER_COVER_TRIANGLE_LANES_INL_HPP
#endif

#include <hwy/highway.h>

#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/kernels/lanes-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {  // each source has its own

/// Numbers [4 part, 4 part + 4) of kLanes pieces, or other structs, as four vectors.
template <class Numbers>
HWY_INLINE void load_numbers(const Numbers* const (&pieces)[kLanes], int part, I (&out)[4]) {
  const I32 d;
  const hn::Repartition<std::int64_t, I32> d64;
  const auto block = [&](std::size_t lane) HWY_ATTR {
    return hn::Load(I128{}, reinterpret_cast<const std::int32_t*>(pieces[lane]) + part * 4);
  };
  const auto load = [&](std::size_t lane) HWY_ATTR {
#if HWY_MAX_BYTES >= 32
    return hn::Combine(d, block(lane + 4), block(lane));
#else
    return block(lane);
#endif
  };
  // In blocks of four lanes.
  const I v0 = load(0), v1 = load(1), v2 = load(2), v3 = load(3);
  const auto low01 = hn::BitCast(d64, hn::InterleaveLower(d, v0, v1));
  const auto low23 = hn::BitCast(d64, hn::InterleaveLower(d, v2, v3));
  const auto high01 = hn::BitCast(d64, hn::InterleaveUpper(d, v0, v1));
  const auto high23 = hn::BitCast(d64, hn::InterleaveUpper(d, v2, v3));
  out[0] = hn::BitCast(d, hn::InterleaveLower(d64, low01, low23));
  out[1] = hn::BitCast(d, hn::InterleaveUpper(d64, low01, low23));
  out[2] = hn::BitCast(d, hn::InterleaveLower(d64, high01, high23));
  out[3] = hn::BitCast(d, hn::InterleaveUpper(d64, high01, high23));
}

/// kLanes triangles: vertices, first and last samples of boxes, depths and flags.
struct Triangles {
  I x[3], y[3];
  I x0, y0, x1, y1;
  F z0, zx, zy;
  I flags;
};

/// `reach`: the largest distance of samples from pixel centres, n.8.
HWY_INLINE void find_boxes(Triangles& t, int reach = 0) {
  const I32 d;
  const I before = hn::Set(d, kHalfPixel - 1 - reach), half = hn::Set(d, kHalfPixel - reach);
  const auto least = [](const I(&v)[3]) HWY_ATTR { return hn::Min(v[0], hn::Min(v[1], v[2])); };
  const auto most = [](const I(&v)[3]) HWY_ATTR { return hn::Max(v[0], hn::Max(v[1], v[2])); };
  t.x0 = hn::ShiftRight<kSubpixelBits>(hn::Add(least(t.x), before));
  t.y0 = hn::ShiftRight<kSubpixelBits>(hn::Add(least(t.y), before));
  t.x1 = hn::ShiftRight<kSubpixelBits>(hn::Sub(most(t.x), half));
  t.y1 = hn::ShiftRight<kSubpixelBits>(hn::Sub(most(t.y), half));
}
HWY_INLINE Triangles load_triangles(const Piece* const (&pieces)[kLanes], int reach = 0) {
  I first[4], second[4], third[4];
  load_numbers(pieces, 0, first);
  load_numbers(pieces, 1, second);
  load_numbers(pieces, 2, third);
  Triangles t{{first[0], first[1], first[2]},
              {first[3], second[0], second[1]},
              {},
              {},
              {},
              {},
              hn::BitCast(F32{}, second[2]),
              hn::BitCast(F32{}, second[3]),
              hn::BitCast(F32{}, third[0]),
              third[1]};
  find_boxes(t, reach);
  return t;
}

HWY_INLINE bool knows_depths(const DepthBounds& bounds) {
  const F32 d;
  F most = hn::Zero(d);
  for (std::size_t i = 0; i < kBlocksPerBin; i += kLanes)
    most = hn::Max(most, hn::LoadU(d, bounds.block + i));
  return !hn::AllTrue(d, hn::Eq(most, hn::Zero(d)));
}

/// The lowest bound of 2 × 2 blocks, from each block of a bin on.
struct SquareBounds {
  static constexpr std::size_t kPitch = 2 * kBlocksPerBinRow;
  HWY_ALIGN float lowest[kBlocksPerBinRow * kPitch];

  HWY_INLINE void find(const DepthBounds& bounds) {
    const F32 d;
    for (std::size_t row = 0; row < kBlocksPerBinRow; ++row) {
      float* const out = lowest + row * kPitch;
      const float* const upper = bounds.block + row * kBlocksPerBinRow;
      const float* const lower = row + 1 < kBlocksPerBinRow ? upper + kBlocksPerBinRow : upper;
      for (std::size_t i = 0; i < kBlocksPerBinRow; i += kLanes)
        hn::Store(hn::Min(hn::LoadU(d, upper + i), hn::LoadU(d, lower + i)), d, out + i);
      out[kBlocksPerBinRow] = out[kBlocksPerBinRow - 1];
      for (std::size_t i = 0; i < kBlocksPerBinRow; i += kLanes)
        hn::Store(hn::Min(hn::Load(d, out + i), hn::LoadU(d, out + i + 1)), d, out + i);
    }
  }
};

/// Lanes of triangles that are hidden in `bin`: HiddenTest::hides_piece in lanes, by the bounds of
/// the blocks that a box touches, if those are at most 4 × 4. `reach` as for load_triangles.
HWY_INLINE std::uint32_t hidden_lanes(const Triangles& t, Rect bin, const SquareBounds& bounds,
                                      int reach = 0) {
  constexpr float kPxPerSubpixel = 1.0F / kSubpixels;
  const float beside = static_cast<float>(reach) * kPxPerSubpixel;
  const F32 d;
  const I32 di;
  const auto inside = [&](I v, int begin, int end) HWY_ATTR {
    return hn::Min(hn::Max(v, hn::Set(di, begin)), hn::Set(di, end - 1));
  };
  const I x0 = inside(t.x0, bin.x0, bin.x1), x1 = inside(t.x1, bin.x0, bin.x1);
  const I y0 = inside(t.y0, bin.y0, bin.y1), y1 = inside(t.y1, bin.y0, bin.y1);
  // highest_depth, not clamped.
  const auto farther = [&](F slope, I first, I last, I origin) HWY_ATTR {
    const auto rises = hn::RebindMask(di, hn::Gt(slope, hn::Zero(d)));
    const F place = hn::IfThenElse(hn::Gt(slope, hn::Zero(d)), hn::Set(d, 0.5F + beside),
                                   hn::Set(d, 0.5F - beside));
    const F px = hn::Add(hn::ConvertTo(d, hn::IfThenElse(rises, last, first)), place);
    return hn::Mul(slope,
                   hn::Sub(px, hn::Mul(hn::ConvertTo(d, origin), hn::Set(d, kPxPerSubpixel))));
  };
  const F depth =
      hn::Add(hn::Add(t.z0, farther(t.zx, x0, x1, t.x[0])), farther(t.zy, y0, y1, t.y[0]));

  const I column = hn::ShiftRight<3>(hn::Sub(x0, hn::Set(di, bin.x0)));
  const I last_column = hn::ShiftRight<3>(hn::Sub(x1, hn::Set(di, bin.x0)));
  const I row = hn::ShiftRight<3>(hn::Sub(y0, hn::Set(di, bin.y0)));
  const I last_row = hn::ShiftRight<3>(hn::Sub(y1, hn::Set(di, bin.y0)));
  const I one = hn::Set(di, 1), four = hn::Set(di, 4);
  const I right = hn::Max(hn::Sub(last_column, one), column);
  const I down = hn::Max(hn::Sub(last_row, one), row);
  const auto lowest = [&](I r, I c) HWY_ATTR {
    static_assert(SquareBounds::kPitch == 16);
    return hn::GatherIndex(d, bounds.lowest, hn::Add(hn::ShiftLeft<4>(r), c));
  };
  F bound = lowest(row, column);
  // A gather takes as long as a dozen other operations, and small boxes lie in one square.
  if (!hn::AllTrue(di, hn::And(hn::Eq(right, column), hn::Eq(down, row))))
    bound = hn::Min(hn::Min(bound, lowest(row, right)),
                    hn::Min(lowest(down, column), lowest(down, right)));
  const auto few =
      hn::And(hn::Lt(hn::Sub(last_column, column), four), hn::Lt(hn::Sub(last_row, row), four));
  const auto triangle =
      hn::Eq(hn::And(t.flags, hn::Set(di, static_cast<std::int32_t>(kLine | kPoint | kQuadric))),
             hn::Zero(di));
  const auto is_finite = [&](F v) HWY_ATTR { return hn::Eq(hn::Sub(v, v), hn::Zero(d)); };
  const auto below = hn::And(hn::Gt(bound, hn::Zero(d)), hn::Lt(depth, bound));
  return lane_bits(hn::And(few, triangle)) &
         lane_bits(hn::RebindMask(di, hn::And(below, hn::And(is_finite(t.zx), is_finite(t.zy)))));
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_COVER_TRIANGLE_LANES_INL_HPP
