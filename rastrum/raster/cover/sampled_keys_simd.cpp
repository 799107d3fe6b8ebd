// SPDX-License-Identifier: BSD-3-Clause
// Several samples at once with Highway, compiled once per instruction set: triangles raise the keys
// of all samples of a bin, a vector of pixels times four samples each, with coverage.hpp's edge
// functions and make_piece.hpp's depths at vertices moved for the samples, and with the same bits.

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/cover/sampled_keys_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <type_traits>

#include <rastrum/raster/cover/triangle_lanes-inl.hpp>
#include <rastrum/raster/kernels/depth_bounds.hpp>
#include <rastrum/raster/kernels/kernels_simd.hpp>
#include <rastrum/raster/kernels/lanes-inl.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/raster/rules/edge_lanes-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2

constexpr float kPxPerSubpixel = 1.0F / kSubpixels;
/// Pixels of a vector, with four samples each.
constexpr int kPixels = static_cast<int>(kLanes / 4);
constexpr std::uint32_t kAllLanes = (1U << kLanes) - 1;
/// Larger boxes (px) are drawn by blocks.
constexpr int kMostColumns = 16, kMostRows = 16;

/// The places of a vector's lanes: four samples of a pixel, then the next pixel's.
struct Lanes {
  HWY_ALIGN std::int32_t x[kLanes], y[kLanes];  ///< from their pixel's centre, n.8
  HWY_ALIGN std::int32_t from_first[kLanes];    ///< x from the first pixel's centre
  HWY_ALIGN float pixel[kLanes];                ///< 0, 1
  HWY_ALIGN std::int32_t pixel_number[kLanes];  ///< the same as a whole number
  HWY_ALIGN std::int32_t place[kLanes];         ///< as in SampledKeys: 1 + the sample's number
  std::int32_t offset_x[4], offset_y[4];

  explicit Lanes(const SampleOffset* four) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      x[i] = offset_x[i % 4] = four[i % 4].x;
      y[i] = offset_y[i % 4] = four[i % 4].y;
      pixel_number[i] = static_cast<std::int32_t>(i / 4);
      pixel[i] = static_cast<float>(pixel_number[i]);
      place[i] = static_cast<std::int32_t>(1 + i % 4);
      from_first[i] = x[i] + static_cast<std::int32_t>(i / 4) * kSubpixels;
    }
  }
};

/// Parts of the depth formula for the vectors of a row.
struct DepthLanes {
  F x0, y0;  ///< the moved first vertex, px
  F z0, zx, zy, pixel;

  HWY_INLINE DepthLanes(const Piece& p, const Lanes& lanes) {
    const F32 d;
    const I32 di;
    const auto origin = [&](std::int32_t v, const std::int32_t* by) HWY_ATTR {
      return hn::Mul(hn::ConvertTo(d, hn::Sub(hn::Set(di, v), hn::Load(di, by))),
                     hn::Set(d, kPxPerSubpixel));
    };
    x0 = origin(p.x[0], lanes.x);
    y0 = origin(p.y[0], lanes.y);
    z0 = hn::Set(d, p.z0);
    zx = hn::Set(d, p.zx);
    zy = hn::Set(d, p.zy);
    pixel = hn::Load(d, lanes.pixel);
  }
  HWY_INLINE F along(int x) const {
    const F32 d;
    const F px = hn::Add(hn::Add(hn::Set(d, static_cast<float>(x)), pixel), hn::Set(d, 0.5F));
    return hn::Add(z0, hn::Mul(zx, hn::Sub(px, x0)));
  }
  HWY_INLINE F down(int y) const {
    return hn::Mul(zy, hn::Sub(hn::Set(F32{}, static_cast<float>(y) + 0.5F), y0));
  }
};

struct NoPlaces {};

/// Raises the keys at `place` in the lanes of `inside`. `places`: SampledKeys', as unsigned lanes,
/// or NoPlaces for keys without.
template <class Places>
HWY_INLINE void raise(F depth, std::uint64_t low, [[maybe_unused]] Places places,
                      std::uint32_t inside, std::uint64_t* place) {
  const I64 d;
  for_each_half(depth, low, [&](std::size_t h, auto key) HWY_ATTR {
    if constexpr (!std::is_same_v<Places, NoPlaces>) key = hn::Or(key, widened_half(places, h));
    const std::uint32_t bits = inside >> (h * kLanes64) & ((1U << kLanes64) - 1);
    auto* const at = reinterpret_cast<std::int64_t*>(place + h * kLanes64);
    // Keys stay below 2^63, so the signed maximum is the maximum.
    const auto own = hn::And(hn::BitCast(d, key), hn::Load(d, kLaneTable.keep[bits]));
    hn::Store(hn::Max(hn::Load(d, at), own), d, at);
  });
}

/// The places for lanes without the centre. A clipped triangle's are unknown, because another of
/// its pieces may cover the centre.
HWY_INLINE I own_places(const Piece& p, const Lanes& lanes) {
  const I32 d;
  return (p.flags & kClipped) != 0 ? hn::Set(d, SampledKeys::kUnknownPlace)
                                   : hn::Load(d, lanes.place);
}

/// Where the primitive of four samples is shaded, in the lanes of all four: the centre if it is
/// inside the edges `centre` (all signs 0), else the `own_place` of the first sample that is not
/// `outside`.
HWY_INLINE hn::Vec<U32> places_of(I centre, I outside, I own_place) {
  const I32 d;
  const I zero = hn::Zero(d);
  I first =
      hn::IfThenElse(hn::Lt(outside, zero), hn::Set(d, SampledKeys::kUnknownPlace), own_place);
  first = hn::Min(first, hn::Shuffle2301(first));
  first = hn::Min(first, hn::Shuffle1032(first));
  return hn::BitCast(U32{}, hn::IfThenElseZero(hn::Lt(centre, zero), first));
}

/// Edges and boxes of kLanes triangles. With a box of up to 16 px the vertices and the tested
/// samples lie in a square of less than 18 px, so |E| < 2^26 fits int32.
struct SmallTriangles {
  HWY_ALIGN std::int32_t a[3][kLanes], b[3][kLanes];
  HWY_ALIGN std::int32_t value[3][kLanes];  ///< at the centre of pixel (x0, y0)
  HWY_ALIGN std::int32_t x0[kLanes], y0[kLanes], x1[kLanes], y1[kLanes];  ///< box, inclusive
  std::uint32_t lanes;  ///< small ones with a box that is not empty
  std::uint32_t large;  ///< others with a box that is not empty

  HWY_INLINE SmallTriangles(const Triangles& t, Rect bin) {
    const I32 d;
    const I half = hn::Set(d, kHalfPixel);
    // Vectors start at multiples of their width.
    const I left = hn::And(hn::Max(t.x0, hn::Set(d, bin.x0)), hn::Set(d, -kPixels));
    const I top = hn::Max(t.y0, hn::Set(d, bin.y0));
    const I right = hn::Min(t.x1, hn::Set(d, bin.x1 - 1));
    const I bottom = hn::Min(t.y1, hn::Set(d, bin.y1 - 1));
    const auto none = hn::Or(hn::Gt(hn::Max(t.x0, hn::Set(d, bin.x0)), right), hn::Gt(top, bottom));
    const auto small = hn::And(hn::Lt(hn::Sub(t.x1, t.x0), hn::Set(d, kMostColumns)),
                               hn::Lt(hn::Sub(t.y1, t.y0), hn::Set(d, kMostRows)));
    const std::uint32_t some = ~lane_bits(none);
    lanes = lane_bits(small) & some;
    large = ~lane_bits(small) & some & kAllLanes;
    hn::Store(left, d, x0);
    hn::Store(top, d, y0);
    hn::Store(right, d, x1);
    hn::Store(bottom, d, y1);
    if (lanes == 0) return;
    const I px = hn::Add(hn::ShiftLeft<kSubpixelBits>(left), half);
    const I py = hn::Add(hn::ShiftLeft<kSubpixelBits>(top), half);
    for (int i = 0; i < 3; ++i) {
      const int j = i == 2 ? 0 : i + 1;
      const I ea = hn::Sub(t.y[i], t.y[j]), eb = hn::Sub(t.x[j], t.x[i]);
      hn::Store(ea, d, a[i]);
      hn::Store(eb, d, b[i]);
      hn::Store(edge_lanes(ea, eb, hn::Sub(px, t.x[i]), hn::Sub(py, t.y[i])), d, value[i]);
    }
  }
};

/// Returns the number of samples of `bin` covered. `low`: of its keys.
template <bool kPlaces>
HWY_INLINE std::uint64_t raise_small(const Piece& p, std::uint64_t low, const SmallTriangles& t,
                                     std::size_t lane, const Lanes& lanes, int end_x,
                                     std::uint64_t* place) {
  const I32 d;
  const int x0 = t.x0[lane], y0 = t.y0[lane], y1 = t.y1[lane];
  const int vectors = (t.x1[lane] - x0) / kPixels + 1;
  const I from_first = hn::Load(d, lanes.from_first), from_y = hn::Load(d, lanes.y);
  I row[3], across[3], down[3];
  [[maybe_unused]] I beyond_centre[3];  // an edge at a sample less that at the centre
  for (int i = 0; i < 3; ++i) {
    const std::int32_t a = t.a[i][lane], b = t.b[i][lane];
    const I by_row = hn::Mul(hn::Set(d, b), from_y);
    const I there = hn::Add(hn::Mul(hn::Set(d, a), from_first), by_row);
    if constexpr (kPlaces)
      beyond_centre[i] = hn::Add(hn::Mul(hn::Set(d, a), hn::Load(d, lanes.x)), by_row);
    row[i] = hn::Add(hn::Set(d, t.value[i][lane]), there);
    across[i] = hn::Set(d, a * (kSubpixels * kPixels));
    down[i] = hn::Set(d, b * kSubpixels);
  }
  const DepthLanes depths(p, lanes);
  const I own_place = own_places(p, lanes);
  HWY_ALIGN float along[kMostColumns + 2][kLanes];
  for (int j = 0; j < vectors; ++j) hn::Store(depths.along(x0 + j * kPixels), F32{}, along[j]);
  // The last vector's pixels in the bin.
  const int beyond = x0 + vectors * kPixels - end_x;
  const std::uint32_t last = beyond > 0 ? kAllLanes >> (4 * beyond) : kAllLanes;
  std::uint64_t covered = 0;
  for (int y = y0; y <= y1; ++y, place += SampledKeys::kRow) {
    I e0 = row[0], e1 = row[1], e2 = row[2];
    const F by_row = depths.down(y);
    for (int j = 0; j < vectors; ++j) {
      const I any = hn::Or(hn::Or(e0, e1), e2);
      std::uint32_t inside = ~lane_bits(hn::Lt(any, hn::Zero(d))) & kAllLanes;
      if (j == vectors - 1) inside &= last;
      if (inside != 0) {
        covered += static_cast<std::uint64_t>(std::popcount(inside));
        const F depth = hn::Add(hn::Load(F32{}, along[j]), by_row);
        std::uint64_t* const at = place + j * kPixels * 4;
        if constexpr (kPlaces) {
          const I centre =
              hn::Or(hn::Or(hn::Sub(e0, beyond_centre[0]), hn::Sub(e1, beyond_centre[1])),
                     hn::Sub(e2, beyond_centre[2]));
          raise(depth, low, places_of(centre, any, own_place), inside, at);
        } else {
          raise(depth, low, NoPlaces{}, inside, at);
        }
      }
      e0 = hn::Add(e0, across[0]);
      e1 = hn::Add(e1, across[1]);
      e2 = hn::Add(e2, across[2]);
    }
    for (int i = 0; i < 3; ++i) row[i] = hn::Add(row[i], down[i]);
  }
  return covered;
}

/// An edge of a large triangle in steps of whole pixels, like Edge, at four samples.
struct SampledEdge {
  std::int64_t base;  ///< at the centre of pixel (0, 0)
  std::int32_t a, b;
  std::int32_t least, most;             ///< range of samples' differences from the centre
  HWY_ALIGN std::int32_t more[kLanes];  ///< by lane, relative to the first pixel's centre
  [[nodiscard]] std::int64_t at(int x, int y) const {
    return base + std::int64_t{a} * x + std::int64_t{b} * y;
  }

  SampledEdge(const Piece& p, int i, const Lanes& lanes) {
    const int j = i == 2 ? 0 : i + 1;
    a = p.y[i] - p.y[j];
    b = p.x[j] - p.x[i];
    const auto centre = edge_value<std::int64_t>(a, b, kHalfPixel - p.x[i], kHalfPixel - p.y[i]);
    base = centre >> kSubpixelBits;
    std::int32_t of_sample[4];
    for (int s = 0; s < 4; ++s) {
      const std::int64_t there =
          centre + std::int64_t{a} * lanes.offset_x[s] + std::int64_t{b} * lanes.offset_y[s];
      of_sample[s] = static_cast<std::int32_t>((there >> kSubpixelBits) - base);
    }
    least = std::min({of_sample[0], of_sample[1], of_sample[2], of_sample[3]});
    most = std::max({of_sample[0], of_sample[1], of_sample[2], of_sample[3]});
    for (std::size_t k = 0; k < kLanes; ++k)
      more[k] = of_sample[k % 4] + a * static_cast<std::int32_t>(k / 4);
  }
};

/// Raises a block's keys by a triangle. Returns the number of samples covered. A base clamped to
/// ±2^30 keeps the sign of every sum: samples and pixels add less than 2^29 + 2^27. `kFull`: the
/// triangle covers the whole block, so nothing is tested. `low`: of the keys.
template <bool kFull, bool kPlaces>
HWY_INLINE std::uint64_t raise_block(const SampledEdge (&edges)[3], const DepthLanes& depths,
                                     const Lanes& lanes, I own_place, std::uint64_t low, int x0,
                                     int y0, Rect bin, std::uint64_t* place) {
  constexpr std::int64_t kClamp = std::int64_t{1} << 30;
  constexpr int kVectors = kBlockSize / kPixels;
  constexpr bool kLooks = kPlaces && !kFull;
  const I32 d;
  I row[3], across[3], down[3];
  [[maybe_unused]] I beyond_centre[3];
  for (int i = 0; i < 3; ++i) {
    if constexpr (kLooks) {
      const I in_row = hn::Mul(hn::Set(d, edges[i].a), hn::Load(d, lanes.pixel_number));
      beyond_centre[i] = hn::Sub(hn::Load(d, edges[i].more), in_row);
    }
    const auto base = static_cast<std::int32_t>(std::clamp(edges[i].at(x0, y0), -kClamp, kClamp));
    row[i] = hn::Add(hn::Set(d, base), hn::Load(d, edges[i].more));
    across[i] = hn::Set(d, edges[i].a * kPixels);
    down[i] = hn::Set(d, edges[i].b);
  }
  HWY_ALIGN float along[kVectors][kLanes];
  for (int j = 0; j < kVectors; ++j) hn::Store(depths.along(x0 + j * kPixels), F32{}, along[j]);
  std::uint64_t covered = 0;
  const int y1 = std::min(y0 + kBlockSize, bin.y1);
  for (int y = y0; y < y1; ++y, place += SampledKeys::kRow) {
    const F by_row = depths.down(y);
    I e0 = row[0], e1 = row[1], e2 = row[2];
    for (int j = 0; j < kVectors; ++j) {
      std::uint32_t inside = kAllLanes;
      [[maybe_unused]] I any, centre;
      if constexpr (!kFull) {
        any = hn::Or(hn::Or(e0, e1), e2);
        if constexpr (kLooks)
          centre = hn::Or(hn::Or(hn::Sub(e0, beyond_centre[0]), hn::Sub(e1, beyond_centre[1])),
                          hn::Sub(e2, beyond_centre[2]));
        inside &= ~lane_bits(hn::Lt(any, hn::Zero(d)));
        e0 = hn::Add(e0, across[0]);
        e1 = hn::Add(e1, across[1]);
        e2 = hn::Add(e2, across[2]);
      }
      const int beyond = x0 + (j + 1) * kPixels - bin.x1;
      if (beyond > 0) inside = beyond >= kPixels ? 0 : inside & kAllLanes >> (4 * beyond);
      if (inside == 0) continue;
      covered += static_cast<std::uint64_t>(std::popcount(inside));
      const F depth = hn::Add(hn::Load(F32{}, along[j]), by_row);
      std::uint64_t* const at = place + j * kPixels * 4;
      if constexpr (kLooks)
        raise(depth, low, places_of(centre, any, own_place), inside, at);
      else
        raise(depth, low, NoPlaces{}, inside, at);  // with places: 0, the centre
    }
    for (int i = 0; i < 3; ++i) row[i] = hn::Add(row[i], down[i]);
  }
  return covered;
}

template <bool kPlaces>
HWY_NOINLINE std::uint64_t raise_large(const Piece& p, Rect bin, const SampledKeys& keys, int reach,
                                       DepthBounds* bounds) {
  const Rect box = sample_bounds(p.x, p.y, bin, reach);
  HiddenTest hidden(bounds, bin);
  // One pixel more on each side contains all its samples.
  const auto around = [](Rect r) { return Rect{r.x0 - 1, r.y0 - 1, r.x1 + 1, r.y1 + 1}; };
  if (hidden.hides_piece(p, around(box))) return 0;
  const std::uint64_t low = keys.low(p.low, 0);
  std::uint64_t covered = 0;
  for (std::size_t four = 0; four < keys.samples.size(); four += 4) {
    const Lanes lanes(keys.samples.data() + four);
    const SampledEdge edges[3] = {{p, 0, lanes}, {p, 1, lanes}, {p, 2, lanes}};
    const DepthLanes depths(p, lanes);
    const I own_place = own_places(p, lanes);
    for (int y0 = box.y0 / kBlockSize * kBlockSize; y0 < box.y1; y0 += kBlockSize)
      for (int x0 = box.x0 / kBlockSize * kBlockSize; x0 < box.x1; x0 += kBlockSize) {
        bool some = true, full = true;
        for (const SampledEdge& e : edges) {
          const std::int64_t at = e.at(x0, y0);
          const std::int64_t a = 7 * std::int64_t{e.a}, b = 7 * std::int64_t{e.b};
          some = some &&
                 at + std::max<std::int64_t>(a, 0) + std::max<std::int64_t>(b, 0) + e.most >= 0;
          full = full &&
                 at + std::min<std::int64_t>(a, 0) + std::min<std::int64_t>(b, 0) + e.least >= 0;
        }
        if (!some) continue;
        const Rect block{x0 - 1, y0 - 1, x0 + kBlockSize + 1, y0 + kBlockSize + 1};
        float* bound = nullptr;
        if (bounds != nullptr && has_depth_bounds(p)) {
          bound = bounds->block + (y0 - bin.y0) / kBlockSize * kBlocksPerBinRow +
                  (x0 - bin.x0) / kBlockSize;
          if (*bound > 0 && highest_depth(p, block) < *bound) {
            ++bounds->hidden_blocks;
            continue;
          }
        }
        std::uint64_t* const place = keys.at(x0, y0) + four / 4 * SampledKeys::kFour;
        covered += full ? raise_block<true, kPlaces>(edges, depths, lanes, own_place, low, x0, y0,
                                                     bin, place)
                        : raise_block<false, kPlaces>(edges, depths, lanes, own_place, low, x0, y0,
                                                      bin, place);
        // With more than four samples, these four are not all of the block's.
        if (full && bound != nullptr && keys.samples.size() == 4)
          *bound = std::max(*bound, lowest_depth(p, block));
      }
  }
  return covered;
}

HWY_INLINE void find_bin_bound(DepthBounds& bounds) {
  const F32 d;
  F least = hn::Set(d, 1.0F);
  for (std::size_t i = 0; i < kBlocksPerBin; i += kLanes)
    least = hn::Min(least, hn::LoadU(d, bounds.block + i));
  bounds.bin = hn::GetLane(hn::MinOfLanes(d, least));
}

template <bool kPlaces>
HWY_INLINE std::uint64_t raise_list(const PieceList& in, std::size_t begin, std::size_t end,
                                    Rect bin, const SampledKeys& keys, DepthBounds* bounds) {
  const int reach = reach_of(keys.samples);
  const bool hides = bounds != nullptr && knows_depths(*bounds);
  SquareBounds squares;
  if (hides) squares.find(*bounds);
  if (bounds != nullptr) find_bin_bound(*bounds);
  const Lanes lanes[kMaxSamples / 4] = {
      Lanes(keys.samples.data()), Lanes(keys.samples.data() + (keys.samples.size() > 4 ? 4 : 0)),
      Lanes(keys.samples.data() + (keys.samples.size() > 8 ? 8 : 0)),
      Lanes(keys.samples.data() + (keys.samples.size() > 8 ? 12 : 0))};
  std::uint64_t covered = 0;
  for (std::size_t first = begin; first < end; first += kLanes) {
    const Piece* pieces[kLanes];
    const std::size_t count = std::min(kLanes, end - first);
    std::uint32_t wanted = 0;
    for (std::size_t i = 0; i < kLanes; ++i) {
      pieces[i] = in.pieces + in.list[first + (i < count ? i : 0)].piece;
      if (first + kLanes + i < end)
        __builtin_prefetch(in.pieces + in.list[first + kLanes + i].piece);
      wanted |= static_cast<std::uint32_t>(i < count && is_raised_at_once(*pieces[i])) << i;
    }
    if (wanted == 0) continue;
    const Triangles t = load_triangles(pieces, reach);
    if (hides) {
      const std::uint32_t dropped = hidden_lanes(t, bin, squares, reach) & wanted;
      bounds->hidden_pieces += static_cast<std::uint64_t>(std::popcount(dropped));
      wanted &= ~dropped;
      if (wanted == 0) continue;
    }
    const SmallTriangles small(t, bin);
    for (std::uint32_t rest = small.lanes & wanted; rest != 0; rest &= rest - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
      std::uint64_t* const place = keys.at(small.x0[lane], small.y0[lane]);
      const std::uint64_t low = keys.low(pieces[lane]->low, 0);
      for (std::size_t four = 0; four < keys.samples.size() / 4; ++four)
        covered += raise_small<kPlaces>(*pieces[lane], low, small, lane, lanes[four], bin.x1,
                                        place + four * SampledKeys::kFour);
    }
    for (std::uint32_t rest = small.large & wanted; rest != 0; rest &= rest - 1)
      covered += raise_large<kPlaces>(*pieces[std::countr_zero(rest)], bin, keys, reach, bounds);
  }
  return covered;
}

std::uint64_t raise_samples(const PieceList& in, std::size_t begin, std::size_t end, Rect bin,
                            const SampledKeys& keys, DepthBounds* bounds) noexcept {
  return keys.has_places ? raise_list<true>(in, begin, end, bin, keys, bounds)
                         : raise_list<false>(in, begin, end, bin, keys, bounds);
}

void find_sampled_bounds(const SampledKeys& keys, Rect bin, DepthBounds& bounds) noexcept {
  const I64 d;
  for (int i = 0; i < kBlocksPerBin; ++i) {
    const int x0 = bin.x0 + i % kBlocksPerBinRow * kBlockSize;
    const int y0 = bin.y0 + i / kBlocksPerBinRow * kBlockSize;
    if (x0 >= bin.x1 || y0 >= bin.y1 || bounds.block[i] >= 1) continue;
    auto least = hn::Set(d, std::numeric_limits<std::int64_t>::max());
    bool empty = false;
    for (std::size_t four = 0; four < keys.samples.size() / 4; ++four)
      for (int y = 0; y < kBlockSize && !empty; ++y) {
        const auto* const row =
            reinterpret_cast<const std::int64_t*>(keys.at(x0, y0 + y) + four * SampledKeys::kFour);
        for (std::size_t k = 0; k < 4 * kBlockSize; k += kLanes64)
          least = hn::Min(least, hn::Load(d, row + k));
        empty = !hn::AllFalse(d, hn::Eq(least, hn::Zero(d)));
      }
    if (empty) continue;
    HWY_ALIGN std::int64_t lanes[kLanes64];
    hn::Store(least, d, lanes);
    const auto key = static_cast<std::uint64_t>(*std::min_element(lanes, lanes + kLanes64));
    bounds.block[i] = std::max(bounds.block[i], depth_of_key(key));
  }
  find_bin_bound(bounds);
}

void merge(const SampledKeys& keys, int x, int y, std::uint64_t* largest, std::uint64_t* first,
           SeenBySamples& seen) noexcept {
  const hn::RebindToUnsigned<I64> d;
  const I64 ds;
  using V = hn::Vec<hn::RebindToUnsigned<I64>>;
  const V id = hn::Set(d, kIdMask), large_low = hn::Set(d, SampledKeys::kLargeLow);
  const V place_bits = hn::Set(d, SampledKeys::kUnknownPlace);
  // SampledKeys::plain; 0 stays 0.
  const auto plain = [&](V k) HWY_ATTR {
    if (!keys.has_places) return k;
    const V low = hn::ShiftRight<SampledKeys::kPlaceBits>(hn::And(k, id));
    const V made = hn::Or(hn::Or(hn::AndNot(id, k), low), large_low);
    return hn::IfThenZeroElse(hn::Eq(k, hn::Zero(d)), made);
  };
  const std::size_t samples = keys.samples.size();
  constexpr std::uint32_t kAll = (1U << kLanes64) - 1;
  seen.covered = seen.mixed = 0;
  for (std::size_t i = 0; i < 64; i += kLanes64) {
    const std::uint64_t* const place =
        keys.at(x + static_cast<int>(i % kBlockSize), y + static_cast<int>(i / kBlockSize));
    V key[kMaxSamples];
    V most = hn::Zero(d), differs = hn::Zero(d);
    for (std::size_t s = 0; s < samples; s += 4) {
      hn::LoadInterleaved4(d, place + s / 4 * SampledKeys::kFour, key[s], key[s + 1], key[s + 2],
                           key[s + 3]);
      for (std::size_t k = s; k < s + 4; ++k) {
        differs = hn::Or(differs, hn::Xor(key[k], key[0]));
        // Keys stay below 2^63.
        most = hn::BitCast(d, hn::Max(hn::BitCast(ds, most), hn::BitCast(ds, key[k])));
      }
    }
    hn::Store(plain(most), d, largest + i);
    hn::Store(plain(key[0]), d, first + i);
    std::uint8_t empty = 0, same = 0;
    hn::StoreMaskBits(d, hn::Eq(most, hn::Zero(d)), &empty);
    hn::StoreMaskBits(d, hn::Eq(hn::And(differs, id), hn::Zero(d)), &same);
    seen.covered |= static_cast<std::uint64_t>(~empty & kAll) << i;
    const std::uint32_t mixed = ~static_cast<std::uint32_t>(same) & kAll;
    seen.mixed |= static_cast<std::uint64_t>(mixed) << i;
    if (keys.has_places) {
      V places = hn::Zero(d);
      for (std::size_t s = 0; s < 4; ++s)
        places = hn::Or(places, hn::Shl(hn::And(key[s], place_bits), hn::Set(d, 4 * s)));
      hn::Store(places, d, seen.places + i);
    }
    if (mixed == 0) continue;
    V firsts = hn::Zero(d), centred = hn::Zero(d);
    V first_of[kMaxSamples];
    for (std::size_t s = 0; s < samples; ++s) {
      key[s] = hn::And(key[s], id);
      V own = hn::Set(d, s);
      for (std::size_t t = s; t-- > 0;)
        own = hn::IfThenElse(hn::Eq(key[s], key[t]), hn::Set(d, t), own);
      first_of[s] = own;
      firsts = hn::Or(firsts, hn::Shl(own, hn::Set(d, 4 * s)));
      for (std::size_t t = 0; t < s && !keys.has_places; ++t)
        if (are_opposite(keys.samples[t], keys.samples[s]))
          centred = hn::Or(centred,
                           hn::IfThenElseZero(hn::Eq(key[s], key[t]), hn::Shl(hn::Set(d, 1), own)));
    }
    hn::Store(firsts, d, seen.first + i);
    hn::Store(centred, d, seen.centred + i);
  }
}

void fill(Kernels& table) {
  table.raise_samples = raise_samples;
  table.find_sampled_bounds = find_sampled_bounds;
  table.merge = merge;
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::raster {

FillKernels fill_sampled_kernels(Isa isa) noexcept {
  static constexpr FillKernels kFill[] = RASTRUM_BY_ISA(fill, nullptr);
  return kFill[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::raster
#endif
