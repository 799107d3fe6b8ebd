// SPDX-License-Identifier: BSD-3-Clause
// Deferred quadrics with Highway, compiled once per instruction set. Setup finds boxes and depths
// in lanes. A bin makes its visible quadrics in lanes too, and raises its keys by each, several
// columns of a row at once. The bodies are the scalar form's (rules/quadric_form.inl,
// rules/quadric_depth.inl), so the bits are the same.

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/bin/bin_quadrics_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include <rastrum/raster/kernels/kernels_simd.hpp>
#include <rastrum/raster/kernels/wide_lanes-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2

constexpr int kStep = static_cast<int>(kLanes64);
constexpr auto kStepBits = static_cast<unsigned>((1U << kStep) - 1);

struct Balls {
  WideBall first, second;
};
/// The balls about the ends of the first kLanes64 of `count` shapes; repeats the last shape.
HWY_INLINE Balls load_balls(const QuadricShape* shapes, std::uint32_t count) {
  HWY_ALIGN double v[8][kLanes64];
  for (std::uint32_t lane = 0; lane < kLanes64; ++lane) {
    const QuadricShape& s = shapes[std::min(lane, count - 1)];
    v[0][lane] = s.p0.x;
    v[1][lane] = s.p0.y;
    v[2][lane] = s.p0.z;
    v[3][lane] = s.r0;
    v[4][lane] = s.p1.x;
    v[5][lane] = s.p1.y;
    v[6][lane] = s.p1.z;
    v[7][lane] = s.r1;
  }
  const F64 d;
  const auto load = [&](int i) HWY_ATTR { return hn::Load(d, v[i]); };
  return {{{load(0), load(1), load(2)}, load(3)}, {{load(4), load(5), load(6)}, load(7)}};
}

HWY_INLINE unsigned bits_of(WideMask mask) {
  std::uint8_t bits = 0;
  hn::StoreMaskBits(F64{}, mask, &bits);
  return bits & kStepBits;
}

SetupOutput defer(const QuadricInput& in, Piece* pieces, std::uint32_t* slow) noexcept {
  const hn::Rebind<std::int32_t, F64> di;
  const hn::Rebind<float, F64> df;
  SetupOutput out;
  for (std::uint32_t i = 0; i < in.count;) {
    // Tubes have spheres among their segments.
    const bool two = has_two_ends(in.shapes[i].kind);
    std::uint32_t n = 1;
    while (n < kLanes64 && i + n < in.count && has_two_ends(in.shapes[i + n].kind) == two) ++n;
    const Balls balls = load_balls(in.shapes + i, n);
    const WidePlace p = place_of(*in.eye, balls.first, two ? &balls.second : nullptr);
    const unsigned seen = bits_of(both(p.is_seen, opposite(p.is_hidden))) & ((1U << n) - 1);
    const unsigned plain = bits_of(both(p.is_ahead, opposite(p.asks_near))) & seen;
    HWY_ALIGN std::int32_t corner[4][kLanes64];
    HWY_ALIGN float highest[kLanes64];
    const WideRange across = corners_of(p.across), down = corners_of(p.down);
    hn::Store(hn::DemoteTo(di, across.least), di, corner[0]);
    hn::Store(hn::DemoteTo(di, across.most), di, corner[1]);
    hn::Store(hn::DemoteTo(di, down.least), di, corner[2]);
    hn::Store(hn::DemoteTo(di, down.most), di, corner[3]);
    hn::Store(hn::DemoteTo(df, bounds_of(p.depths).most), df, highest);
    for (unsigned rest = seen; rest != 0; rest &= rest - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
      const std::uint32_t number = in.numbers[i + lane];
      if ((plain >> lane & 1) == 0) {
        slow[out.slow++] = number;
        continue;
      }
      Piece& piece = pieces[out.pieces];
      piece.x[0] = piece.x[1] = corner[0][lane];
      piece.x[2] = corner[1][lane];
      piece.y[0] = piece.y[1] = corner[2][lane];
      piece.y[2] = corner[3][lane];
      set_quadric(piece, nullptr);
      piece.z0 = highest[lane];
      piece.flags = in.flags | kQuadric | kDeferred;
      piece.low = kIdMask - (in.first_id + number);
      out.pieces += !sample_bounds(piece.x, piece.y, in.view).empty();
    }
    i += n;
  }
  return out;
}

/// A quadric with its origin, px.
struct PlacedQuadric {
  Quadric quadric;
  double x, y;
  bool is_finite;
};

/// Adds each lane's part, with `limits` limits, to its quadric, and all numbers to `sum`.
HWY_INLINE void add_part(const WidePart& part, int limits, W& sum, PlacedQuadric (&out)[kLanes64]) {
  const W w[10] = {part.b,  part.bx,  part.by,  part.d,   part.dx,
                   part.dy, part.dxx, part.dxy, part.dyy, part.inverse_a};
  HWY_ALIGN double v[16][kLanes64];
  const auto store = [&](W number, double* to) HWY_ATTR {
    hn::Store(number, F64{}, to);
    sum = sum + number;
  };
  for (int k = 0; k < 10; ++k) store(w[k], v[k]);
  unsigned is_least[2] = {};
  for (int k = 0; k < limits; ++k) {
    const WideLimit& l = part.limits[k];
    store(l.at, v[10 + 3 * k]);
    store(l.x, v[11 + 3 * k]);
    store(l.y, v[12 + 3 * k]);
    is_least[k] = bits_of(l.is_least);
  }
  for (std::size_t lane = 0; lane < kLanes64; ++lane) {
    Quadric& q = out[lane].quadric;
    QuadricPart& to = q.part[q.part_count++];
    to.b = v[0][lane];
    to.bx = v[1][lane];
    to.by = v[2][lane];
    to.d = v[3][lane];
    to.dx = v[4][lane];
    to.dy = v[5][lane];
    to.dxx = v[6][lane];
    to.dxy = v[7][lane];
    to.dyy = v[8][lane];
    to.inverse_a = v[9][lane];
    to.limit_count = static_cast<std::uint32_t>(limits);
    for (int k = 0; k < limits; ++k)
      to.limits[k] = {v[10 + 3 * k][lane], v[11 + 3 * k][lane], v[12 + 3 * k][lane],
                      (is_least[k] >> lane & 1) != 0};
  }
}

HWY_NOINLINE void make_quadrics(const QuadricBatch& batch, std::uint32_t first,
                                PlacedQuadric (&out)[kLanes64]) {
  const F64 d;
  const bool two = has_two_ends(batch.kind);
  const Balls balls = load_balls(batch.shapes + first, batch.count - first);
  const WidePlace p = place_of(*batch.eye, balls.first, two ? &balls.second : nullptr);
  HWY_ALIGN double x[kLanes64], y[kLanes64], depth0[kLanes64];
  hn::Store(p.x * wide(1.0 / kSubpixels), d, x);
  hn::Store(p.y * wide(1.0 / kSubpixels), d, y);
  hn::Store(p.depth0, d, depth0);
  for (std::size_t lane = 0; lane < kLanes64; ++lane) {
    out[lane].x = x[lane];
    out[lane].y = y[lane];
    Quadric& q = out[lane].quadric;
    q.depth0 = depth0[lane];
    q.nearest = 1 - q.depth0;
    q.part_count = 0;
    q.is_open = false;
  }
  const WideRays rays = rays_of(*batch.eye, p.x, p.y, p.depth0);
  W sum = p.depth0;
  const auto add = [&](const WidePart& part, int limits)
                       HWY_ATTR { add_part(part, limits, sum, out); };
  if (batch.kind != QuadricKind::cone) add(ball_part(rays, balls.first, p.reach), 0);
  if (batch.kind == QuadricKind::hull) add(ball_part(rays, balls.second, p.reach), 0);
  if (two) {
    Balls ends = balls;
    if (batch.kind == QuadricKind::hull) {
      const TouchingCone cone = touching_cone(balls.first, balls.second);
      ends = {cone.first, cone.second};
    }
    add(cone_part(rays, ends.first, ends.second, p.reach), 2);
  }
  const unsigned finite = bits_of(hn::Eq(sum - sum, wide(0)));
  for (std::size_t lane = 0; lane < kLanes64; ++lane) {
    Quadric& q = out[lane].quadric;
    q.is_plain = !two && q.part[0].inverse_a > 0;
    out[lane].is_finite = (finite >> lane & 1) != 0;
  }
}

/// surface_at for the side that faces the viewer, of a quadric that is not open. Skips parts that
/// no lane's ray meets.
HWY_INLINE Surface front_at(const Quadric& q, const QuadricRow& row, W dx) {
  Surface s{wide(0), below(wide(0), wide(0))};
  for (std::uint32_t k = 0; k < q.part_count; ++k) {
    const QuadricPart& p = q.part[k];
    if (p.inverse_a > 0 && !is_any(at_most(wide(0), discriminant_of(p, row.part[k], dx)))) continue;
    const Inside i = inside_part(p, row.part[k], dx);
    const WideMask two = both(i.any, s.covered);
    s.e = choose(two, greater(s.e, i.e.most), choose(i.any, i.e.most, s.e));
    s.covered = either(s.covered, i.any);
  }
  return {s.e, both(s.covered, at_most(s.e, wide(q.nearest)))};
}

/// Raises keys by one quadric, whose surface_of(row, dx) is in front.
template <class SurfaceOf>
HWY_INLINE void raise_one(const PlacedQuadric& placed, const DeferredInBin& at, Rect bin,
                          const DepthBounds* bounds, const SurfaceView& surface,
                          const SurfaceOf& surface_of, RaisedKeys& out) {
  const hn::Rebind<float, F64> df;
  const I64 d64;
  const Quadric& q = placed.quadric;
  const W depth0 = wide(q.depth0);
  const auto low = hn::Set(d64, static_cast<std::int64_t>(at.low));
  for (int by = at.y0 / kBlockSize; by <= (at.y1 - 1) / kBlockSize; ++by)
    for (int bx = at.x0 / kBlockSize; bx <= (at.x1 - 1) / kBlockSize; ++bx) {
      const int number = by * kBlocksPerBinRow + bx;
      if (bounds != nullptr && at.highest < bounds->block[number]) {
        ++out.hidden_blocks;
        continue;
      }
      const int x0 = bin.x0 + bx * kBlockSize, y0 = bin.y0 + by * kBlockSize;
      std::uint64_t* const block = surface.block(x0 / kBlockSize, y0 / kBlockSize);
      const int begin = std::max<int>(at.x0 - bx * kBlockSize, 0);
      const int end = std::min<int>(at.x1 - bx * kBlockSize, kBlockSize);
      const unsigned wanted = (0xFFU << begin) & (0xFFU >> (kBlockSize - end));
      W columns[kBlockSize / kLanes64];
      for (int k = 0; k < kBlockSize / kStep; ++k)
        columns[k] =
            hn::Iota(F64{}, static_cast<double>(x0 + k * kStep)) + wide(0.5) - wide(placed.x);
      unsigned any = 0;
      const int first_row = std::max<int>(at.y0 - by * kBlockSize, 0);
      const int end_row = std::min<int>(at.y1 - by * kBlockSize, kBlockSize);
      for (int row = first_row; row < end_row; ++row) {
        const QuadricRow r(q, (y0 + row + 0.5) - placed.y);
        for (int k = 0; k < kBlockSize / kStep; ++k) {
          const unsigned columns_wanted = wanted >> (k * kStep) & kStepBits;
          if (columns_wanted == 0) continue;
          const Surface s = surface_of(r, columns[k]);
          const unsigned covered = bits_of(s.covered) & columns_wanted;
          if (covered == 0) continue;
          any |= covered;
          out.fragments += static_cast<unsigned>(std::popcount(covered));
          auto depth = hn::DemoteTo(df, depth0 + s.e);
          depth =
              hn::Min(hn::IfThenElseZero(hn::Gt(depth, hn::Zero(df)), depth), hn::Set(df, 1.0F));
          const auto high =
              hn::PromoteTo(d64, hn::BitCast(hn::RebindToSigned<decltype(df)>(), depth));
          const auto key = hn::And(hn::Or(hn::ShiftLeft<kIdBits>(high), low),
                                   hn::Load(d64, kLaneTable.keep[covered]));
          auto* const place = reinterpret_cast<std::int64_t*>(block + row * kBlockSize + k * kStep);
          hn::Store(hn::Max(hn::Load(d64, place), key), d64, place);
        }
      }
      out.blocks |= std::uint64_t{any != 0} << number;
    }
}

RaisedKeys raise(const QuadricBatch& batch, Rect bin, const DepthBounds* bounds,
                 const SurfaceView& surface) noexcept {
  RaisedKeys out;
  for (std::uint32_t first = 0; first < batch.count; first += kLanes64) {
    PlacedQuadric quadrics[kLanes64];
    make_quadrics(batch, first, quadrics);
    for (std::uint32_t i = first; i < batch.count && i < first + kLanes64; ++i) {
      const PlacedQuadric& placed = quadrics[i - first];
      const Quadric& q = placed.quadric;
      const auto raise_by = [&](const auto& surface_of) HWY_ATTR {
        raise_one(placed, batch.places[i], bin, bounds, surface, surface_of, out);
      };
      if (!placed.is_finite) continue;
      if (q.is_plain)
        raise_by([&](const QuadricRow& row, W dx) HWY_ATTR {
          const Roots r = roots_of(q.part[0], row.part[0], dx);
          return Surface{r.enters, r.real};
        });
      else
        raise_by([&](const QuadricRow& row, W dx) HWY_ATTR { return front_at(q, row, dx); });
    }
  }
  return out;
}

void fill(Kernels& table) {
  table.defer = defer;
  table.raise = raise;
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::raster {

FillKernels fill_quadric_kernels(Isa isa) noexcept {
  static constexpr FillKernels kFill[] = RASTRUM_BY_ISA(fill, nullptr);
  return kFill[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::raster
#endif
