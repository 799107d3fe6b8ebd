// SPDX-License-Identifier: BSD-3-Clause
// The march of paper 3 with Highway, compiled once per instruction set, 4 vectors of a row at a
// time, and the ranges of heights in the tiles of a map.
#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/terrain/shadows_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <limits>
#include <vector>

#include <rastrum/terrain/shadow_kernels.hpp>
#include <rastrum/terrain/shadow_runs-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::terrain::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using F32 = hn::CappedTag<float, 16>;
using I32 = hn::RebindToSigned<F32>;
using F = hn::Vec<F32>;
constexpr std::size_t kLanes = hn::MaxLanes(F32{});
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t kGroup = 4 * kLanes;

struct Counts {
  hn::Vec<I32> c0, c1, c2, c3;
};

HWY_INLINE hn::Vec<I32> hidden(hn::Vec<I32> count, F own, F climb, const float* test) {
  const I32 di;
  const auto mask = hn::Lt(hn::Add(own, climb), hn::LoadU(F32{}, test));
  return hn::Sub(count, hn::VecFromMask(di, hn::RebindMask(di, mask)));
}

void march_row(const ShadowCaster& map, const std::vector<MarchSample>& samples, int y,
               std::uint16_t* counts) noexcept {
  const F32 d;
  const I32 di;
  const std::int64_t width = map.heights.width;
  const float* const own_row = map.heights.row(y);
  float own[kGroup], beside[kGroup];
  std::int32_t sums[kGroup];
  for (std::int64_t x = 0; x < width; x += static_cast<std::int64_t>(kGroup)) {
    const std::int64_t n = std::min(static_cast<std::int64_t>(kGroup), width - x);
    std::fill_n(own, kGroup, 0.0F);
    std::copy_n(own_row + x, n, own);
    const F h0 = hn::LoadU(d, own), h1 = hn::LoadU(d, own + kLanes);
    const F h2 = hn::LoadU(d, own + 2 * kLanes), h3 = hn::LoadU(d, own + 3 * kLanes);
    Counts c{hn::Zero(di), hn::Zero(di), hn::Zero(di), hn::Zero(di)};
    for (const MarchSample& s : samples) {
      const std::int64_t row = y + s.dy;
      const float* const line = map.heights.row(static_cast<int>(
          row >= 0 && row < map.heights.height ? row : tiled(row, map.heights.height, map.tiling)));
      std::int64_t at = x + s.dx;
      if (map.tiling == Tiling::repeat && (at < 0 || at >= width))
        at = tiled(at, width, Tiling::repeat);
      const float* test = line + at;
      if (at < 0 || at + static_cast<std::int64_t>(kGroup) > width) {
        for_each_run(
            at, static_cast<std::int64_t>(kGroup), width, map.tiling,
            [&](std::int64_t i, std::int64_t source, std::int64_t length, std::int64_t step)
                HWY_ATTR { copy_run(line + source, length, step, beside + i); });
        test = beside;
      }
      const F climb = hn::Set(d, s.climb);
      c.c0 = hidden(c.c0, h0, climb, test);
      c.c1 = hidden(c.c1, h1, climb, test + kLanes);
      c.c2 = hidden(c.c2, h2, climb, test + 2 * kLanes);
      c.c3 = hidden(c.c3, h3, climb, test + 3 * kLanes);
    }
    hn::StoreU(c.c0, di, sums);
    hn::StoreU(c.c1, di, sums + kLanes);
    hn::StoreU(c.c2, di, sums + 2 * kLanes);
    hn::StoreU(c.c3, di, sums + 3 * kLanes);
    for (std::int64_t i = 0; i < n; ++i)
      counts[x + i] = own[i] == -kInfinity ? std::uint16_t{0} : static_cast<std::uint16_t>(sums[i]);
  }
}

/// Columns whose ranges stay in the first-level cache.
constexpr std::size_t kStrip = 1024;

/// Reduces rows first, four at a time, then columns to tiles.
bool tile_ranges(const float* heights, std::ptrdiff_t stride, int rows, std::size_t width,
                 float* lowest, float* highest) noexcept {
  static_assert(kStrip % HeightTiles::kEdge == 0 && HeightTiles::kEdge % kLanes == 0);
  constexpr std::size_t kEdge = HeightTiles::kEdge;
  const F32 d;
  float lows[kStrip], highs[kStrip];
  // x − x is NaN for what is not finite, else 0.
  F odd = hn::Zero(d);
  bool finite = true;
  for (std::size_t begin = 0; begin < width; begin += kStrip) {
    const std::size_t n = std::min(kStrip, width - begin), padded = (n + kEdge - 1) / kEdge * kEdge;
    std::fill_n(lows, padded, kInfinity);
    std::fill_n(highs, padded, -kInfinity);
    for (int r = 0; r < rows; r += 4) {
      const auto row = [&](int k) { return heights + std::min(r + k, rows - 1) * stride + begin; };
      const float *const a = row(0), *const b = row(1), *const e = row(2), *const f = row(3);
      std::size_t i = 0;
      for (; i + kLanes <= n; i += kLanes) {
        const F u = hn::LoadU(d, a + i), v = hn::LoadU(d, b + i);
        const F w = hn::LoadU(d, e + i), z = hn::LoadU(d, f + i);
        const F low = hn::Min(hn::Min(u, v), hn::Min(w, z));
        const F high = hn::Max(hn::Max(u, v), hn::Max(w, z));
        odd = hn::Or(odd, hn::Or(hn::Or(hn::Sub(u, u), hn::Sub(v, v)),
                                 hn::Or(hn::Sub(w, w), hn::Sub(z, z))));
        hn::StoreU(hn::Min(hn::LoadU(d, lows + i), low), d, lows + i);
        hn::StoreU(hn::Max(hn::LoadU(d, highs + i), high), d, highs + i);
      }
      for (; i < n; ++i)
        for (const float* const from : {a, b, e, f}) {
          finite = finite && from[i] - from[i] == 0;
          lows[i] = std::min(lows[i], from[i]);
          highs[i] = std::max(highs[i], from[i]);
        }
    }
    for (std::size_t i = 0; i < padded; i += kEdge) {
      F low = hn::LoadU(d, lows + i), high = hn::LoadU(d, highs + i);
      for (std::size_t k = kLanes; k < kEdge; k += kLanes) {
        low = hn::Min(low, hn::LoadU(d, lows + i + k));
        high = hn::Max(high, hn::LoadU(d, highs + i + k));
      }
      lowest[(begin + i) / kEdge] = hn::GetLane(hn::MinOfLanes(d, low));
      highest[(begin + i) / kEdge] = hn::GetLane(hn::MaxOfLanes(d, high));
    }
  }
  return finite && hn::AllTrue(d, hn::Eq(odd, odd));
}

constexpr ShadowKernels kTable{march_row, tile_ranges};

}  // namespace
}  // namespace rastrum::terrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::terrain {

const ShadowKernels& shadow_kernels(Isa isa) noexcept {
  static constexpr ShadowKernels kScalar{};
  static constexpr const ShadowKernels* kTables[] = RASTRUM_BY_ISA(kTable, &kScalar);
  return *kTables[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::terrain
#endif
