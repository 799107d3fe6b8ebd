// SPDX-License-Identifier: BSD-3-Clause
// The fast path's kernels with Highway, compiled once per instruction set. Multiply and add are not
// fused, so all give the bits of kernels.cpp.
#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/terrain/kernels_simd.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <limits>

#include <rastrum/terrain/kernels.hpp>

// The scalar kernels stand in for Highway's baseline targets.
#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::terrain::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using F32 = hn::ScalableTag<float>;
using I32 = hn::RebindToSigned<F32>;
using U32 = hn::RebindToUnsigned<F32>;
using F64 = hn::ScalableTag<double>;
using HalfI32 = hn::Rebind<std::int32_t, F64>;
using HalfF32 = hn::Rebind<float, F64>;
using F = hn::Vec<F32>;
using I = hn::Vec<I32>;
using D = hn::Vec<F64>;
constexpr std::size_t kLanes = hn::MaxLanes(F32{});
constexpr std::size_t kLanes64 = hn::MaxLanes(F64{});
static_assert(kBlockColumns % kLanes == 0 && kClassicSlices % kLanes64 == 0);

bool is_power_of_two(int n) {
  return (n & (n - 1)) == 0;
}

enum class Wrap { mask, repeat, mirror, clamp, none };

/// Cells lie within ±2²³ of the camera's, where integers are exact in float32.
template <Wrap kWrap>
struct Axis {
  explicit HWY_INLINE Axis(int size)
      : size_(hn::Set(I32{}, size)),
        last_(hn::Set(I32{}, size - 1)),
        period_(hn::Set(I32{}, kWrap == Wrap::mirror ? 2 * size : size)),
        inverse_(hn::Set(F32{}, 1 / static_cast<float>(kWrap == Wrap::mirror ? 2 * size : size))) {}

  HWY_INLINE I tiled(I i) const {
    const I32 d;
    const I zero = hn::Zero(d);
    if constexpr (kWrap == Wrap::mask) return hn::And(i, last_);
    if constexpr (kWrap == Wrap::clamp || kWrap == Wrap::none)
      return hn::Min(hn::Max(i, zero), last_);
    // The quotient may be off by one.
    const I q = hn::ConvertTo(d, hn::Floor(hn::Mul(hn::ConvertTo(F32{}, i), inverse_)));
    I r = hn::Sub(i, hn::Mul(q, period_));
    r = hn::Add(r, hn::IfThenElseZero(hn::Lt(r, zero), period_));
    r = hn::Sub(r, hn::IfThenZeroElse(hn::Lt(r, period_), period_));
    if constexpr (kWrap == Wrap::mirror)
      r = hn::IfThenElse(hn::Lt(r, size_), r, hn::Sub(hn::Sub(period_, hn::Set(d, 1)), r));
    return r;
  }

 private:
  I size_, last_, period_;
  F inverse_;
};

template <Wrap kWrap, MapFilter kFilter>
void heights(const Samples& samples, const Slice& slice, std::size_t n, ColumnBlock& b) noexcept {
  const F32 d;
  const I32 di;
  const MapView& map = samples.map;
  const int level = kFilter == MapFilter::mip ? map.height_level(slice.level) : 0;
  const ImageView<const float>& image = map.heights(level);
  const float* cells = image.data;
  const Axis<kWrap> across(map.width), down(map.height);
  const I stride = hn::Set(di, image.width);
  const I cell_x = hn::Set(di, map.cell_x), cell_y = hn::Set(di, map.cell_y);
  const F z = hn::Set(d, slice.z), fx = hn::Set(d, samples.setup.fx);
  const F fy = hn::Set(d, samples.setup.fy);
  for (std::size_t i = 0; i < n; i += kLanes) {
    F x = hn::Add(fx, hn::Mul(z, hn::Load(d, b.ux + i)));
    F y = hn::Add(fy, hn::Mul(z, hn::Load(d, b.uy + i)));
    [[maybe_unused]] const F at_x = x, at_y = y;
    if constexpr (kFilter == MapFilter::bilinear) {
      x = hn::Sub(x, hn::Set(d, 0.5F));
      y = hn::Sub(y, hn::Set(d, 0.5F));
    }
    const F x0 = hn::Floor(x), y0 = hn::Floor(y);
    const I u = hn::Add(cell_x, hn::ConvertTo(di, x0)), v = hn::Add(cell_y, hn::ConvertTo(di, y0));
    if constexpr (kFilter == MapFilter::bilinear) {
      const F tx = hn::Sub(x, x0), ty = hn::Sub(y, y0);
      const I one = hn::Set(di, 1);
      const I left = across.tiled(u), right = across.tiled(hn::Add(u, one));
      const auto along = [&](I row) HWY_ATTR {
        const I first = hn::Mul(row, stride);
        const F from = hn::GatherIndex(d, cells, hn::Add(first, left));
        const F to = hn::GatherIndex(d, cells, hn::Add(first, right));
        return hn::Add(from, hn::Mul(tx, hn::Sub(to, from)));
      };
      const F above = along(down.tiled(v)), below = along(down.tiled(hn::Add(v, one)));
      hn::Store(hn::Add(above, hn::Mul(ty, hn::Sub(below, above))), d, b.heights + i);
    } else {
      I column = across.tiled(u), row = down.tiled(v);
      if constexpr (kFilter == MapFilter::mip) {
        column = hn::ShiftRightSame(column, level);
        row = hn::ShiftRightSame(row, level);
      }
      const I cell = hn::Add(hn::Mul(row, stride), column);
      hn::Store(cell, di, b.cells + i);
      // Loads take 4 % less per frame than a gather on Zen 3 (busy); not measured elsewhere.
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        b.heights[i + lane] = cells[b.cells[i + lane]];
    }
    if constexpr (kWrap == Wrap::none) {
      const auto is_on = [&](F at, I cell, int size) HWY_ATTR {
        const I c = hn::Add(cell, hn::ConvertTo(di, hn::Floor(at)));
        return hn::AndNot(hn::Lt(c, hn::Zero(di)), hn::Lt(c, hn::Set(di, size)));
      };
      const auto on = hn::And(is_on(at_x, cell_x, map.width), is_on(at_y, cell_y, map.height));
      const F there = hn::Load(d, b.heights + i);
      hn::Store(hn::IfThenElse(hn::RebindMask(d, on), there, hn::NaN(d)), d, b.heights + i);
    }
  }
}

template <Wrap kWrap>
void heights_filtered(const Samples& samples, const Slice& slice, std::size_t n,
                      ColumnBlock& b) noexcept {
  if (samples.map.filter == MapFilter::none)
    return heights<kWrap, MapFilter::none>(samples, slice, n, b);
  if (samples.map.filter == MapFilter::mip)
    return heights<kWrap, MapFilter::mip>(samples, slice, n, b);
  heights<kWrap, MapFilter::bilinear>(samples, slice, n, b);
}

void heights_tiled(const Samples& samples, const Slice& slice, std::size_t n,
                   ColumnBlock& b) noexcept {
  const MapView& map = samples.map;
  if (map.tiling == Tiling::mirror) return heights_filtered<Wrap::mirror>(samples, slice, n, b);
  if (map.tiling == Tiling::clamp) return heights_filtered<Wrap::clamp>(samples, slice, n, b);
  if (map.tiling == Tiling::none) return heights_filtered<Wrap::none>(samples, slice, n, b);
  if (is_power_of_two(map.width) && is_power_of_two(map.height))
    return heights_filtered<Wrap::mask>(samples, slice, n, b);
  heights_filtered<Wrap::repeat>(samples, slice, n, b);
}

template <Wrap kWrap>
HWY_INLINE F texels(I cell, F within, int size, float texels_a_cell) {
  const F32 d;
  const I32 di;
  const F one = hn::Set(d, 1.0F);
  const I end = hn::Set(di, size);
  if constexpr (kWrap == Wrap::mirror) {
    const I turned = Axis<Wrap::repeat>(2 * size).tiled(cell);
    const auto is_turned = hn::RebindMask(d, hn::Not(hn::Lt(turned, end)));
    within = hn::IfThenElse(is_turned, hn::Sub(one, within), within);
  }
  if constexpr (kWrap == Wrap::clamp) {
    within = hn::IfThenZeroElse(hn::RebindMask(d, hn::Lt(cell, hn::Zero(di))), within);
    within = hn::IfThenElse(hn::RebindMask(d, hn::Lt(cell, end)), within, one);
  }
  const F whole = hn::ConvertTo(d, Axis<kWrap>(size).tiled(cell));
  return hn::Mul(hn::Add(whole, within), hn::Set(d, texels_a_cell));
}

/// MapView::color_at with MapFilter::bilinear.
template <Wrap kWrap>
void colors_between(const Samples& samples, const Slice& slice, std::size_t n, const ColumnBlock& b,
                    Rgba8* colors) noexcept {
  const F32 d;
  const I32 di;
  const U32 du;
  using U = hn::Vec<U32>;
  const MapView& map = samples.map;
  const ImageView<const Rgba8>& image = map.colors(0);
  const auto* const pixels = reinterpret_cast<const std::uint32_t*>(image.data);
  const Axis<kWrap> across(image.width), down(image.height);
  const I stride = hn::Set(di, static_cast<std::int32_t>(image.stride));
  const F z = hn::Set(d, slice.z), half = hn::Set(d, 0.5F), parts = hn::Set(d, 256.0F);
  const U whole = hn::Set(du, 256U), low = hn::Set(du, 255U);
  const U clear = hn::Set(du, slice.clear), veil = hn::Set(du, 256 - slice.clear);
  const Rgba8 fog = samples.setup.fog;
  const std::uint32_t fog_of[3] = {fog.r, fog.g, fog.b};
  const I last = hn::Set(di, static_cast<std::int32_t>(kBlockColumns) - 1);
  for (std::size_t i = 0; i < n; i += kLanes) {
    const I column = hn::And(hn::Load(di, b.mark + i), last);
    const F x = hn::Add(hn::Set(d, samples.setup.fx), hn::Mul(z, hn::GatherIndex(d, b.ux, column)));
    const F y = hn::Add(hn::Set(d, samples.setup.fy), hn::Mul(z, hn::GatherIndex(d, b.uy, column)));
    const F x0 = hn::Floor(x), y0 = hn::Floor(y);
    const F u = texels<kWrap>(hn::Add(hn::Set(di, map.cell_x), hn::ConvertTo(di, x0)),
                              hn::Sub(x, x0), map.width, map.color_x);
    const F v = texels<kWrap>(hn::Add(hn::Set(di, map.cell_y), hn::ConvertTo(di, y0)),
                              hn::Sub(y, y0), map.height, map.color_y);
    const F um = hn::Sub(u, half), vm = hn::Sub(v, half);
    const F u0 = hn::Floor(um), v0 = hn::Floor(vm);
    const auto share = [&](F at, F from) HWY_ATTR {
      return hn::BitCast(du, hn::ConvertTo(di, hn::Mul(hn::Sub(at, from), parts)));
    };
    const U tx = share(um, u0), ty = share(vm, v0);
    const U sx = hn::Sub(whole, tx), sy = hn::Sub(whole, ty);
    const I one = hn::Set(di, 1), s = hn::ConvertTo(di, u0), t = hn::ConvertTo(di, v0);
    const I left = across.tiled(s), right = across.tiled(hn::Add(s, one));
    const I upper = hn::Mul(down.tiled(t), stride),
            lower = hn::Mul(down.tiled(hn::Add(t, one)), stride);
    const U c0 = hn::GatherIndex(du, pixels, hn::Add(upper, left)),
            c1 = hn::GatherIndex(du, pixels, hn::Add(upper, right)),
            c2 = hn::GatherIndex(du, pixels, hn::Add(lower, left)),
            c3 = hn::GatherIndex(du, pixels, hn::Add(lower, right));
    U mixed = hn::Set(du, 0xff000000U);
    for (int channel = 0; channel < 3; ++channel) {
      const auto of = [&](U c)
                          HWY_ATTR { return hn::And(hn::ShiftRightSame(c, 8 * channel), low); };
      const U above = hn::Add(hn::Mul(of(c0), sx), hn::Mul(of(c1), tx));
      const U below = hn::Add(hn::Mul(of(c2), sx), hn::Mul(of(c3), tx));
      const U c = hn::ShiftRight<16>(
          hn::Add(hn::Add(hn::Mul(above, sy), hn::Mul(below, ty)), hn::Set(du, 32768U)));
      const U behind = hn::ShiftRight<8>(
          hn::Add(hn::Add(hn::Mul(c, clear), hn::Mul(hn::Set(du, fog_of[channel]), veil)),
                  hn::Set(du, 128U)));
      mixed = hn::Or(mixed, hn::ShiftLeftSame(behind, 8 * channel));
    }
    hn::StoreU(mixed, du, reinterpret_cast<std::uint32_t*>(colors + i));
  }
}

void colors(const Samples& samples, const Slice& slice, std::size_t n, const ColumnBlock& b,
            Rgba8* out) noexcept {
  const MapView& map = samples.map;
  if (map.filter != MapFilter::bilinear) return colors_one_by_one(samples, slice, n, b, out);
  if (map.tiling == Tiling::mirror) return colors_between<Wrap::mirror>(samples, slice, n, b, out);
  if (map.tiling == Tiling::clamp || map.tiling == Tiling::none)  // beyond the map nothing is drawn
    return colors_between<Wrap::clamp>(samples, slice, n, b, out);
  const ImageView<const Rgba8>& image = map.colors(0);
  if (is_power_of_two(map.width) && is_power_of_two(map.height) && is_power_of_two(image.width) &&
      is_power_of_two(image.height))
    return colors_between<Wrap::mask>(samples, slice, n, b, out);
  colors_between<Wrap::repeat>(samples, slice, n, b, out);
}

HWY_INLINE std::size_t list(ColumnBlock& b, std::size_t i, std::size_t listed,
                            hn::Mask<I32> visible, I top) {
  const I32 d;
  const I column = hn::Iota(d, static_cast<std::int32_t>(i));
  const I mark =
      hn::Add(hn::Mul(top, hn::Set(d, static_cast<std::int32_t>(kBlockColumns))), column);
  const I cell = hn::Load(d, b.cells + i);
  if (hn::AllTrue(d, visible)) {
    hn::StoreU(mark, d, b.mark + listed);
    hn::StoreU(cell, d, b.cell + listed);
    return listed + kLanes;
  }
  hn::CompressStore(mark, visible, d, b.mark + listed);
  return listed + hn::CompressStore(cell, visible, d, b.cell + listed);
}

std::size_t occlude(float altitude, float rows, float horizon, std::size_t n,
                    ColumnBlock& b) noexcept {
  const F32 d;
  const F zero = hn::Zero(d), gone = hn::Set(d, -std::numeric_limits<float>::infinity());
  const F from = hn::Set(d, altitude), scale = hn::Set(d, rows), middle = hn::Set(d, horizon);
  std::size_t listed = 0;
  F deepest = gone;
  for (std::size_t i = 0; i < n; i += kLanes) {
    const F row = hn::Add(hn::Mul(hn::Sub(from, hn::Load(d, b.heights + i)), scale), middle);
    const F hidden = hn::Load(d, b.hidden + i);
    const auto visible = hn::Lt(row, hidden);
    if (hn::AllFalse(d, visible)) {
      deepest = hn::Max(deepest, hidden);
      continue;
    }
    const F top = hn::Floor(hn::IfThenElseZero(hn::And(visible, hn::Gt(row, zero)), row));
    const F left = hn::IfThenElse(visible, hn::IfThenElse(hn::Gt(top, zero), top, gone), hidden);
    deepest = hn::Max(deepest, left);
    hn::Store(left, d, b.hidden + i);
    listed = list(b, i, listed, hn::RebindMask(I32{}, visible), hn::ConvertTo(I32{}, top));
  }
  b.deepest = hn::GetLane(hn::MaxOfLanes(d, deepest));
  return listed;
}

std::size_t occlude64(double altitude, double rows, double horizon, std::size_t n,
                      ColumnBlock& b) noexcept {
  const F64 d;
  const HalfF32 half;
  const HalfI32 half_i;
  const D zero = hn::Zero(d), gone = hn::Set(d, -std::numeric_limits<double>::infinity());
  const D from = hn::Set(d, altitude), scale = hn::Set(d, rows), middle = hn::Set(d, horizon);
  std::size_t listed = 0;
  D deepest = gone;
  for (std::size_t i = 0; i < n; i += kLanes64) {
    const D ground = hn::PromoteTo(d, hn::Load(half, b.heights + i));
    const D row = hn::Add(hn::Mul(hn::Sub(from, ground), scale), middle);
    const D hidden = hn::PromoteTo(d, hn::Load(half, b.hidden + i));
    const auto visible = hn::Lt(row, hidden);
    if (hn::AllFalse(d, visible)) {
      deepest = hn::Max(deepest, hidden);
      continue;
    }
    const D top = hn::Floor(hn::IfThenElseZero(hn::And(visible, hn::Gt(row, zero)), row));
    const D left = hn::IfThenElse(visible, hn::IfThenElse(hn::Gt(top, zero), top, gone), hidden);
    deepest = hn::Max(deepest, left);
    hn::Store(hn::DemoteTo(half, left), half, b.hidden + i);
    alignas(64) std::int32_t rows_of[kLanes64];
    hn::Store(hn::DemoteTo(half_i, top), half_i, rows_of);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, visible, bits);
    for (std::size_t lane = 0; lane < kLanes64; ++lane) {
      if ((bits[0] >> lane & 1) == 0) continue;
      b.mark[listed] = rows_of[lane] * static_cast<std::int32_t>(kBlockColumns) +
                       static_cast<std::int32_t>(i + lane);
      b.cell[listed++] = b.cells[i + lane];
    }
  }
  b.deepest = static_cast<float>(hn::GetLane(hn::MaxOfLanes(d, deepest)));
  return listed;
}

void advance(std::size_t columns, const double* dx, const double* dy, double* x,
             double* y) noexcept {
  const F64 d;
  // Sums of one slice depend on each other, so two vectors of slices go at once where there are
  // two.
  constexpr std::size_t kOther = 2 * kLanes64 <= kClassicSlices ? kLanes64 : 0;
  for (std::size_t k = 0; k < kClassicSlices; k += kLanes64 + kOther) {
    const D dx0 = hn::LoadU(d, dx + k), dx1 = hn::LoadU(d, dx + k + kOther);
    const D dy0 = hn::LoadU(d, dy + k), dy1 = hn::LoadU(d, dy + k + kOther);
    D x0 = hn::LoadU(d, x + k), x1 = hn::LoadU(d, x + k + kOther);
    D y0 = hn::LoadU(d, y + k), y1 = hn::LoadU(d, y + k + kOther);
    for (std::size_t i = 0; i < columns; ++i) {
      x0 = hn::Add(x0, dx0);
      x1 = hn::Add(x1, dx1);
      y0 = hn::Add(y0, dy0);
      y1 = hn::Add(y1, dy1);
    }
    hn::StoreU(x0, d, x + k);
    hn::StoreU(x1, d, x + k + kOther);
    hn::StoreU(y0, d, y + k);
    hn::StoreU(y1, d, y + k + kOther);
  }
}

template <Wrap kWrap>
HWY_INLINE hn::Vec<HalfI32> classic_cell(D at, int size) {
  const F64 d;
  const HalfI32 di;
  const D floor = hn::Floor(at);
  if constexpr (kWrap == Wrap::mask) return hn::And(hn::DemoteTo(di, floor), hn::Set(di, size - 1));
  const D zero = hn::Zero(d), one = hn::Set(d, 1), s = hn::Set(d, size);
  if constexpr (kWrap == Wrap::clamp)
    return hn::DemoteTo(di, hn::Min(hn::Max(floor, zero), hn::Sub(s, one)));
  // Positions are below 2⁵¹, so all is exact except the quotient, which may be off by one.
  const D period = hn::Set(d, kWrap == Wrap::mirror ? 2.0 * size : size);
  const D q = hn::Floor(hn::Div(floor, period));
  D r = hn::Sub(floor, hn::Mul(q, period));
  r = hn::Add(r, hn::IfThenElseZero(hn::Lt(r, zero), period));
  r = hn::Sub(r, hn::IfThenElseZero(hn::Ge(r, period), period));
  if constexpr (kWrap == Wrap::mirror)
    r = hn::IfThenElse(hn::Lt(r, s), r, hn::Sub(hn::Sub(period, one), r));
  return hn::DemoteTo(di, r);
}

template <Wrap kWrap>
void classic_cells_tiled(const ClassicSlices& s, const MapSize& map, std::size_t n,
                         std::int32_t* cells) noexcept {
  const F64 d;
  const HalfI32 di;
  for (std::size_t k = 0; k < kClassicSlices; k += kLanes64) {
    const D dx = hn::LoadU(d, s.dx + k), dy = hn::LoadU(d, s.dy + k);
    D x = hn::LoadU(d, s.x + k), y = hn::LoadU(d, s.y + k);
    for (std::size_t i = 0; i < n; ++i) {
      const auto column = classic_cell<kWrap>(x, map.width);
      const auto row = classic_cell<kWrap>(y, map.height);
      hn::Store(hn::Add(hn::Mul(row, hn::Set(di, map.width)), column), di,
                cells + i * kClassicSlices + k);
      x = hn::Add(x, dx);
      y = hn::Add(y, dy);
    }
  }
}

void classic_cells(const ClassicSlices& s, const MapSize& map, std::size_t n,
                   std::int32_t* cells) noexcept {
  if (map.powers_of_two) return classic_cells_tiled<Wrap::mask>(s, map, n, cells);
  if (map.tiling == Tiling::mirror) return classic_cells_tiled<Wrap::mirror>(s, map, n, cells);
  if (map.tiling == Tiling::clamp) return classic_cells_tiled<Wrap::clamp>(s, map, n, cells);
  classic_cells_tiled<Wrap::repeat>(s, map, n, cells);
}

void fill(std::uint32_t* marks, int first, int last, std::size_t n, std::uint32_t* above,
          std::uint32_t* out, std::ptrdiff_t stride, bool stream) noexcept {
  const U32 d;
  const auto zero = hn::Zero(d);
  const std::size_t whole = n / kLanes * kLanes;
  for (int y = first; y < last; ++y) {
    std::uint32_t* row = marks + static_cast<std::size_t>(y) * kBlockColumns;
    std::uint32_t* to = out + y * stride;
    for (std::size_t i = 0; i < whole; i += kLanes) {
      const auto mark = hn::Load(d, row + i);
      const auto color = hn::IfThenElse(hn::Eq(mark, zero), hn::Load(d, above + i), mark);
      hn::Store(zero, d, row + i);
      hn::Store(color, d, above + i);
      if (stream)
        hn::Stream(color, d, to + i);
      else
        hn::StoreU(color, d, to + i);
    }
    for (std::size_t i = whole; i < n; ++i) {
      to[i] = above[i] = row[i] != 0 ? row[i] : above[i];
      row[i] = 0;
    }
  }
  // Streamed stores need a fence before other threads read them.
  if (stream) hwy::FlushStream();
}

constexpr Kernels kTable{heights_tiled, colors, occlude, occlude64, advance, classic_cells, fill};

}  // namespace
}  // namespace rastrum::terrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::terrain {

const Kernels& kernels(Isa isa) noexcept {
  static constexpr const Kernels* kTables[] = RASTRUM_BY_ISA(kTable, &kScalarKernels);
  return *kTables[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::terrain
#endif
