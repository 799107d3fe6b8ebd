// SPDX-License-Identifier: BSD-3-Clause
// Columns of a map for the sweep of shadow_sweep.hpp: in 16-bit units, rows of a column side by
// side. The includer compiles it once per instruction set.
#if defined(RASTRUM_TERRAIN_SHADOW_PANEL_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_TERRAIN_SHADOW_PANEL_INL_HPP
#undef RASTRUM_TERRAIN_SHADOW_PANEL_INL_HPP
#else
#define RASTRUM_TERRAIN_SHADOW_PANEL_INL_HPP
#endif

#include <algorithm>
#include <cstdint>
#include <vector>

#include <hwy/highway.h>

#include <rastrum/terrain/shadow_runs-inl.hpp>
#include <rastrum/terrain/shadow_sweep.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::terrain::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using I16 = hn::CappedTag<std::int16_t, 32>;
constexpr std::size_t kBands = hn::MaxLanes(I16{});

/// Adding 1.5 · 2²³ makes float32 round to whole numbers, in the lower half of its 32 bits.
/// (Conversions that check for overflow take three operations more.)
class Quantizer {
 public:
  using D = hn::CappedTag<float, 8>;
  using Wide = hn::Vec<hn::RebindToSigned<D>>;
  static constexpr std::int64_t kCells = hn::MaxLanes(D{});
  static_assert(kCells >= 4);

  explicit Quantizer(const SweepUnits& units)
      : lowest_(hn::Set(D{}, units.lowest)),
        scale_(hn::Set(D{}, units.scale)),
        zero_(hn::Set(D{}, 0x1.8p23F + static_cast<float>(units.zero))) {}

  [[nodiscard]] HWY_INLINE Wide operator()(const float* from) const {
    const auto above = hn::Sub(hn::LoadU(D{}, from), lowest_);
    return hn::BitCast(hn::RebindToSigned<D>{}, hn::Max(hn::MulAdd(above, scale_, zero_), zero_));
  }

 private:
  hn::Vec<D> lowest_, scale_, zero_;
};

/// Blocks of columns, transposed so that a column's rows lie side by side. Several at once, because
/// a map's rows are pages apart and a cache line is longer than a block's row.
class Panel {
 public:
  static constexpr int kBlocks = 4;
  static constexpr int kColumns = kBlocks * kSweepBlock;

  Panel(const Sweep& sweep, int bands)
      : sweep_(sweep),
        bands_(bands),
        // |s| ≤ 1: rows shift by at most a panel's width, and a column's rows lie within 4.
        stride_((static_cast<std::size_t>(bands + kColumns + 8 + kBeyond) + kBands) / kBands *
                kBands),
        cells_(stride_ * kColumns) {}

  [[nodiscard]] std::size_t stride() const { return stride_; }
  /// The cell of column c in a row of the sweep, for the first band.
  [[nodiscard]] const std::int16_t* cell(int c, std::int64_t row) const {
    return cells_.data() + static_cast<std::size_t>(c) * stride_ + (row - low_);
  }
  /// Blocks [first, last) of the sweep, from the least row that `first_band` needs.
  HWY_NOINLINE void load(int first, int last, int first_band) {
    low_ = sweep_.blocks[static_cast<std::size_t>(first)].low;
    std::int32_t high = low_;
    for (int b = first; b < last; ++b) {
      low_ = std::min(low_, sweep_.blocks[static_cast<std::size_t>(b)].low);
      high = std::max(high, sweep_.blocks[static_cast<std::size_t>(b)].high);
    }
    const std::int64_t row0 = std::int64_t{first_band} + low_;
    const ShadowCaster& map = sweep_.map;
    const int n = last - first;
    Source sources[kBlocks];
    for (int b = 0; b < n; ++b) sources[b] = source_of((first + b) * kSweepBlock);
    const Quantizer quantize(sweep_.units);
    for_each_run(
        row0, bands_ + high - low_ + 1, sweep_.rows, map.tiling,
        [&](std::int64_t i, std::int64_t from, std::int64_t length, std::int64_t step) HWY_ATTR {
          if (!sweep_.along_x) {
            for (int c = 0; c < n * kSweepBlock; ++c) {
              const std::int64_t row = sources[c / kSweepBlock].columns[c % kSweepBlock];
              take(quantize, map.heights.row(static_cast<int>(row)) + from, length, step, at(c, i));
            }
          } else {
            for (std::int64_t k = 0; k < length; k += kTurned) {
              const float* rows[kTurned];
              for (std::int64_t r = 0; r < kTurned; ++r)
                rows[r] =
                    map.heights.row(static_cast<int>(from + std::min(k + r, length - 1) * step));
              const std::int64_t next = from + (k + kAhead) * step;
              for (int b = 0; k + kAhead + kTurned <= length && b < n; ++b)
                for (std::int64_t r = 0; r < kTurned; ++r)
                  __builtin_prefetch(map.heights.row(static_cast<int>(next + r * step)) +
                                     sources[b].least);
              for (int b = 0; b < n; ++b) turn(quantize, sources[b], rows, b * kSweepBlock, i + k);
            }
          }
        });
  }

 private:
  using D32 = hn::RebindToSigned<Quantizer::D>;
  using D16 = hn::Repartition<std::int16_t, D32>;
  /// Rows that are transposed together. Vectors stored beyond the end are overwritten or not read.
  static constexpr std::int64_t kTurned = 8;
  /// Rows that are prefetched: they are pages apart, so the hardware does not do it.
  static constexpr std::int64_t kAhead = 32;
  static constexpr std::int64_t kBeyond = 2 * Quantizer::kCells;

  [[nodiscard]] std::int16_t* at(int c, std::int64_t i) {
    return cells_.data() + static_cast<std::size_t>(c) * stride_ + i;
  }
  static HWY_INLINE void take(const Quantizer& quantize, const float* from, std::int64_t n,
                              std::int64_t step, std::int16_t* to) {
    constexpr std::int64_t kTaken = 2 * Quantizer::kCells;
    const auto put = [&](const float* cells, std::int16_t* at) HWY_ATTR {
      const D16 d;
      const auto low = hn::BitCast(d, quantize(cells));
      const auto high = hn::BitCast(d, quantize(cells + Quantizer::kCells));
      hn::StoreU(hn::ConcatEven(d, high, low), d, at);
    };
    std::int64_t k = 0;
    if (step == 1)
      for (; k + kTaken <= n; k += kTaken) put(from + k, to + k);
    for (; k < n; k += kTaken) {
      float beside[kTaken] = {};
      copy_run(from + k * step, std::min(kTaken, n - k), step, beside);
      put(beside, to + k);
    }
  }
  struct Source {
    std::int64_t columns[kSweepBlock];
    std::int64_t least;  ///< of the columns
    bool up, down;       ///< whether columns are consecutive, rising or falling
  };
  [[nodiscard]] Source source_of(int x0) const {
    Source s{{}, 0, true, true};
    for (int c = 0; c < kSweepBlock; ++c) {
      const std::int64_t x = sweep_.flipped ? std::int64_t{sweep_.columns} - 1 - (x0 + c) : x0 + c;
      s.columns[c] = tiled(x, sweep_.columns, sweep_.map.tiling);
      s.up = s.up && s.columns[c] == s.columns[0] + c;
      s.down = s.down && s.columns[c] == s.columns[0] - c;
    }
    s.least = std::min(s.columns[0], s.columns[kSweepBlock - 1]);
    return s;
  }
  HWY_INLINE void turn(const Quantizer& quantize, const Source& source, const float* const* of_map,
                       int c0, std::int64_t i) {
    float beside[kTurned][kSweepBlock];
    const float* rows[kTurned];
    for (int r = 0; r < kTurned; ++r) {
      rows[r] = of_map[r] + source.least;
      if (source.up || source.down) continue;
      for (int c = 0; c < kSweepBlock; ++c) beside[r][c] = of_map[r][source.columns[c]];
      rows[r] = beside[r];
    }
    const auto stride = static_cast<std::ptrdiff_t>(stride_);
    std::int16_t* const column = at(c0 + (source.down ? kSweepBlock - 1 : 0), i);
    const std::ptrdiff_t next = source.down ? -stride : stride;
    const D32 d;
    const hn::Repartition<std::int64_t, D32> d64;
    for (int q = 0; q < kSweepBlock; q += static_cast<int>(Quantizer::kCells)) {
      // Two rows in each, then four, then all eight.
      const auto pair = [&](int r) HWY_ATTR {
        return hn::BitCast(
            d, hn::OddEven(hn::BitCast(D16{}, hn::ShiftLeft<16>(quantize(rows[r + 1] + q))),
                           hn::BitCast(D16{}, quantize(rows[r] + q))));
      };
      const auto a = pair(0), b = pair(2), e = pair(4), f = pair(6);
      const auto ab = hn::BitCast(d64, hn::InterleaveLower(d, a, b));
      const auto ef = hn::BitCast(d64, hn::InterleaveLower(d, e, f));
      const auto ab2 = hn::BitCast(d64, hn::InterleaveUpper(d, a, b));
      const auto ef2 = hn::BitCast(d64, hn::InterleaveUpper(d, e, f));
      put_columns(hn::InterleaveLower(d64, ab, ef), column + q * next, next);
      put_columns(hn::InterleaveUpper(d64, ab, ef), column + (q + 1) * next, next);
      put_columns(hn::InterleaveLower(d64, ab2, ef2), column + (q + 2) * next, next);
      put_columns(hn::InterleaveUpper(d64, ab2, ef2), column + (q + 3) * next, next);
    }
  }

  /// Each 128 bits are eight rows of a column, the upper half those of the fourth column from
  /// there.
  template <class V64>
  static HWY_INLINE void put_columns(V64 v, std::int16_t* to, std::ptrdiff_t next) {
    const hn::Full128<std::int16_t> d;
    const hn::DFromV<V64> d64;
    if constexpr (hn::MaxLanes(d64) == 2) {
      hn::StoreU(hn::BitCast(d, v), d, to);
    } else {
      const hn::Half<decltype(d64)> half;
      hn::StoreU(hn::BitCast(d, hn::LowerHalf(half, v)), d, to);
      hn::StoreU(hn::BitCast(d, hn::UpperHalf(half, v)), d, to + 4 * next);
    }
  }

  const Sweep& sweep_;
  int low_ = 0;
  std::int64_t bands_;
  std::size_t stride_;
  std::vector<std::int16_t> cells_;
};

}  // namespace
}  // namespace rastrum::terrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#endif  // RASTRUM_TERRAIN_SHADOW_PANEL_INL_HPP
