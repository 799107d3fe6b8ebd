// Shadows with Highway, compiled once per instruction set: the march of paper 3 over 4 vectors of a
// row at a time, and the sweep of shadow_sweep.hpp over vectors of bands. The march repeats the
// scalar operations and gives the same counts; the sweep gives the definition's bits whatever it is
// compiled for.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/terrain/shadows_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <limits>
#include <vector>

#include <rastrum/terrain/shadow_kernels.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::terrain {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using F32 = hn::CappedTag<float, 16>;
using I32 = hn::RebindToSigned<F32>;
using U32 = hn::RebindToUnsigned<F32>;
using F = hn::Vec<F32>;
constexpr std::size_t kLanes = hn::MaxLanes(F32{});
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Calls f(i, source, n, step) for runs that make up coordinates [begin, begin + n): run i … is
/// source, source + step, … of an axis that is `size` long.
template <class Run>
HWY_INLINE void for_each_run(std::int64_t begin, std::int64_t n, std::int64_t size, Tiling tiling,
                             const Run& f) {
  for (std::int64_t i = 0; i < n;) {
    const std::int64_t at = begin + i;
    const std::int64_t source = tiled(at, size, tiling);
    std::int64_t length = n - i, step = 1;
    if (tiling == Tiling::clamp && (at < 0 || at >= size)) {
      step = 0;
      if (at < 0) length = std::min(length, -at);
    } else if (tiling == Tiling::mirror && tiled(at, 2 * size, Tiling::repeat) >= size) {
      step = -1;
      length = std::min(length, source + 1);
    } else {
      length = std::min(length, size - source);
    }
    f(i, source, length, step);
    i += length;
  }
}

HWY_INLINE void copy_run(const float* from, std::int64_t n, std::int64_t step, float* to) {
  if (step == 1) {
    std::copy_n(from, n, to);
  } else {
    for (std::int64_t k = 0; k < n; ++k) to[k] = from[k * step];
  }
}

// --- The march ----------------------------------------------------------------------------------

constexpr std::size_t kGroup = 4 * kLanes;

/// Which samples of a group hide the sun, added to its counts.
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
          row >= 0 && row < map.heights.height ? row
                                               : tiled(row, map.heights.height, map.tiling)));
      std::int64_t at = x + s.dx;
      if (map.tiling == Tiling::repeat && (at < 0 || at >= width))
        at = tiled(at, width, Tiling::repeat);
      const float* test = line + at;
      if (at < 0 || at + static_cast<std::int64_t>(kGroup) > width) {
        for_each_run(at, static_cast<std::int64_t>(kGroup), width, map.tiling,
                     [&](std::int64_t i, std::int64_t source, std::int64_t length,
                         std::int64_t step) HWY_ATTR {
                       copy_run(line + source, length, step, beside + i);
                     });
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

// --- The sweep ----------------------------------------------------------------------------------

/// A block of columns, turned so that the rows of a column lie side by side.
class Block {
 public:
  Block(const Sweep& sweep, int bands)
      : sweep_(sweep),
        // |s| ≤ 1: over a block rows shift by its width, and a column's lie within 4.
        stride_((static_cast<std::size_t>(bands) + kSweepBlock + 8 + 2 * kLanes) / kLanes * kLanes),
        cells_(stride_ * kSweepBlock) {}

  [[nodiscard]] std::size_t stride() const { return stride_; }
  [[nodiscard]] const float* column(int c) const {
    return cells_.data() + static_cast<std::size_t>(c) * stride_;
  }
  /// Columns x0 …, `n` of them, rows from `row0`.
  void load(int x0, int n, std::int64_t row0) {
    const ShadowCaster& map = sweep_.map;
    std::int64_t source[kSweepBlock];
    bool up = n == kSweepBlock, down = up;
    for (int c = 0; c < n; ++c) {
      const std::int64_t x = sweep_.flipped ? std::int64_t{sweep_.columns} - 1 - (x0 + c) : x0 + c;
      source[c] = tiled(x, sweep_.columns, map.tiling);
      up = up && source[c] == source[0] + c;
      down = down && source[c] == source[0] - c;
    }
    for_each_run(row0, static_cast<std::int64_t>(stride_), sweep_.rows, map.tiling,
                 [&](std::int64_t i, std::int64_t from, std::int64_t length,
                     std::int64_t step) HWY_ATTR {
                   if (!sweep_.along_x) {
                     for (int c = 0; c < n; ++c)
                       copy_run(map.heights.row(static_cast<int>(source[c])) + from, length, step,
                                at(c, i));
                   } else if (up || down) {
                     turn(std::min(source[0], source[kSweepBlock - 1]), down, i, from, length, step);
                   } else {
                     turn_by_cells(source, n, i, from, length, step);
                   }
                 });
  }

 private:
  [[nodiscard]] float* at(int c, std::int64_t i) {
    return cells_.data() + static_cast<std::size_t>(c) * stride_ + i;
  }
  void turn_by_cells(const std::int64_t* source, int n, std::int64_t i, std::int64_t from,
                     std::int64_t length, std::int64_t step) {
    for (std::int64_t k = 0; k < length; ++k) {
      const float* const row = sweep_.map.heights.row(static_cast<int>(from + k * step));
      for (int c = 0; c < n; ++c) *at(c, i + k) = row[source[c]];
    }
  }
  /// 4 rows and 4 columns at a time.
  HWY_INLINE void turn(std::int64_t left, bool reversed, std::int64_t i, std::int64_t from,
                       std::int64_t length, std::int64_t step) {
    const hn::Full128<float> d;
    const auto& heights = sweep_.map.heights;
    std::int64_t k = 0;
    for (; k + 4 <= length; k += 4) {
      const float* rows[4];
      for (int r = 0; r < 4; ++r)
        rows[r] = heights.row(static_cast<int>(from + (k + r) * step)) + left;
      for (int q = 0; q < kSweepBlock; q += 4) {
        const auto r0 = hn::LoadU(d, rows[0] + q), r1 = hn::LoadU(d, rows[1] + q);
        const auto r2 = hn::LoadU(d, rows[2] + q), r3 = hn::LoadU(d, rows[3] + q);
        const auto a = hn::InterleaveLower(d, r0, r1), b = hn::InterleaveLower(d, r2, r3);
        const auto e = hn::InterleaveUpper(d, r0, r1), f = hn::InterleaveUpper(d, r2, r3);
        const auto to = [&](int c) HWY_ATTR {
          return at(reversed ? kSweepBlock - 1 - (q + c) : q + c, i + k);
        };
        hn::StoreU(hn::ConcatLowerLower(d, b, a), d, to(0));
        hn::StoreU(hn::ConcatUpperUpper(d, b, a), d, to(1));
        hn::StoreU(hn::ConcatLowerLower(d, f, e), d, to(2));
        hn::StoreU(hn::ConcatUpperUpper(d, f, e), d, to(3));
      }
    }
    for (; k < length; ++k) {
      const float* const row = heights.row(static_cast<int>(from + k * step)) + left;
      for (int c = 0; c < kSweepBlock; ++c) *at(reversed ? kSweepBlock - 1 - c : c, i + k) = row[c];
    }
  }

  const Sweep& sweep_;
  std::size_t stride_;
  std::vector<float> cells_;
};

class Sweeper {
 public:
  Sweeper(const Sweep& sweep, int first, int last, ImageView<std::uint8_t> shadow)
      : sweep_(sweep),
        first_(sweep.first_band + first),
        bands_(last - first),
        padded_((static_cast<std::size_t>(bands_) + kLanes - 1) / kLanes * kLanes),
        shadow_(shadow),
        block_(sweep, static_cast<int>(padded_)),
        bounds_(4 * padded_, -kInfinity),
        dark_(padded_ * kSweepBlock) {}

  void run() {
    const int all = static_cast<int>(sweep_.column.size());
    for (int x0 = (all - 1) / kSweepBlock * kSweepBlock; x0 >= 0; x0 -= kSweepBlock) {
      const int n = std::min(kSweepBlock, all - x0);
      int low = sweep_.column[static_cast<std::size_t>(x0)].row;
      for (int c = 0; c < n; ++c) {
        const SweepColumn& column = sweep_.column[static_cast<std::size_t>(x0 + c)];
        low = std::min({low, column.row, column.begin_row});
      }
      block_.load(x0, n, std::int64_t{first_} + low);
      for (std::size_t i = 0; i < padded_; i += kLanes) sweep_vector(x0, n, low, i);
      for (int c = 0; c < n && x0 + c < sweep_.columns; ++c) store_column(x0 + c, c);
    }
  }

 private:
  static_assert(kSubBands == 2);

  HWY_INLINE void sweep_vector(int x0, int n, int low, std::size_t i) {
    const F32 d;
    float* const bounds = bounds_.data() + 4 * i;
    F upper0 = hn::LoadU(d, bounds), upper1 = hn::LoadU(d, bounds + kLanes);
    F lower0 = hn::LoadU(d, bounds + 2 * kLanes), lower1 = hn::LoadU(d, bounds + 3 * kLanes);
    for (int c = n - 1; c >= 0; --c) {
      const SweepColumn& column = sweep_.column[static_cast<std::size_t>(x0 + c)];
      const float* const cells = block_.column(c) + i;
      if (x0 + c < sweep_.columns) {
        const F own = hn::LoadU(d, cells + (column.begin_row - low));
        const F upper = column.part == 0 ? upper0 : upper1;
        const F lower = column.part == 0 ? lower0 : lower1;
        const auto dark =
            hn::Gt(lower, hn::Sub(own, hn::Set(d, column.begin - sweep_.slack)));
        const auto open = hn::Gt(upper, hn::Sub(own, hn::Set(d, column.begin + sweep_.slack)));
        std::uint8_t* const to = dark_.data() + static_cast<std::size_t>(c) * padded_ + i;
        const U32 du;
        const hn::Rebind<std::uint8_t, U32> d8;
        hn::StoreU(hn::TruncateTo(d8, hn::And(hn::VecFromMask(du, hn::RebindMask(du, dark)),
                                              hn::Set(du, 1))),
                   d8, to);
        const auto undecided = hn::AndNot(dark, open);
        if (!hn::AllFalse(d, undecided)) decide(undecided, x0 + c, i, to);
      }
      const SweepEntry* e = column.entries[0].data();
      for (int k = column.count[0]; k > 0; --k, ++e) {
        const F h = hn::LoadU(d, cells + (column.row - low + e->row));
        upper0 = hn::Max(upper0, hn::Sub(h, hn::Set(d, e->upper)));
        lower0 = hn::Max(lower0, hn::Sub(h, hn::Set(d, e->lower)));
      }
      e = column.entries[1].data();
      for (int k = column.count[1]; k > 0; --k, ++e) {
        const F h = hn::LoadU(d, cells + (column.row - low + e->row));
        upper1 = hn::Max(upper1, hn::Sub(h, hn::Set(d, e->upper)));
        lower1 = hn::Max(lower1, hn::Sub(h, hn::Set(d, e->lower)));
      }
    }
    hn::StoreU(upper0, d, bounds);
    hn::StoreU(upper1, d, bounds + kLanes);
    hn::StoreU(lower0, d, bounds + 2 * kLanes);
    hn::StoreU(lower1, d, bounds + 3 * kLanes);
  }

  /// The row of the map of a band's cell in a column; outside of [0, rows) there is none.
  [[nodiscard]] std::int64_t row_of(int x, std::size_t i) const {
    const std::int64_t row = std::int64_t{first_} + static_cast<std::int64_t>(i) +
                             sweep_.column[static_cast<std::size_t>(x)].begin_row;
    return sweep_.cyclic ? tiled(row, sweep_.rows, Tiling::repeat) : row;
  }
  /// Where the map has what the sweep calls (x, row).
  [[nodiscard]] std::pair<int, int> cell_of(int x, std::int64_t row) const {
    const int along = sweep_.flipped ? sweep_.columns - 1 - x : x;
    return sweep_.along_x ? std::pair(along, static_cast<int>(row))
                          : std::pair(static_cast<int>(row), along);
  }

  template <class Mask>
  HWY_NOINLINE void decide(Mask undecided, int x, std::size_t i, std::uint8_t* dark) {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(F32{}, undecided, bits);
    for (std::size_t k = 0; k < kLanes && i + k < static_cast<std::size_t>(bands_); ++k) {
      if ((bits[k / 8] >> k % 8 & 1) == 0) continue;
      const std::int64_t row = row_of(x, i + k);
      if (row < 0 || row >= sweep_.rows) continue;
      const auto [cx, cy] = cell_of(x, row);
      dark[k] = in_shadow(sweep_.map, sweep_.steps, cx, cy) ? 1 : 0;
    }
  }

  void store_column(int x, int c) {
    const std::uint8_t* const dark = dark_.data() + static_cast<std::size_t>(c) * padded_;
    for (int i = 0; i < bands_;) {
      const std::int64_t row = row_of(x, static_cast<std::size_t>(i));
      if (row < 0) {
        i += static_cast<int>(-row);
        continue;
      }
      if (row >= sweep_.rows) break;
      const int n = static_cast<int>(std::min(std::int64_t{bands_} - i, sweep_.rows - row));
      const auto [cx, cy] = cell_of(x, row);
      std::uint8_t* to = &shadow_(cx, cy);
      if (sweep_.along_x) {
        for (int k = 0; k < n; ++k, to += shadow_.stride) *to = dark[i + k];
      } else {
        std::copy_n(dark + i, n, to);
      }
      i += n;
    }
  }

  const Sweep& sweep_;
  int first_, bands_;
  std::size_t padded_;
  ImageView<std::uint8_t> shadow_;
  Block block_;
  std::vector<float> bounds_;       ///< 2 upper and 2 lower vectors for each vector of bands
  std::vector<std::uint8_t> dark_;  ///< of the block, column by column
};

void sweep(const Sweep& plan, int first, int last, ImageView<std::uint8_t> shadow) {
  Sweeper(plan, first, last, shadow).run();
}

bool range(const float* row, std::size_t n, float& lowest, float& highest) noexcept {
  const F32 d;
  F low = hn::Set(d, kInfinity), high = hn::Set(d, -kInfinity);
  // The difference to itself is NaN for what is not finite, and 0 for all else.
  F odd = hn::Zero(d);
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    const F v = hn::LoadU(d, row + i);
    odd = hn::Or(odd, hn::Sub(v, v));
    low = hn::Min(low, v);
    high = hn::Max(high, v);
  }
  float lows[kLanes], highs[kLanes];
  hn::StoreU(low, d, lows);
  hn::StoreU(high, d, highs);
  bool finite = hn::AllTrue(d, hn::Eq(odd, odd));
  for (; i < n; ++i) {
    finite = finite && row[i] - row[i] == 0;
    lowest = std::min(lowest, row[i]);
    highest = std::max(highest, row[i]);
  }
  lowest = std::min(lowest, *std::min_element(lows, lows + kLanes));
  highest = std::max(highest, *std::max_element(highs, highs + kLanes));
  return finite;
}

constexpr ShadowKernels kTable{march_row, sweep, range};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace rastrum::terrain
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
namespace rastrum::terrain {

const ShadowKernels& shadow_kernels(Isa isa) noexcept {
  static constexpr ShadowKernels kScalar{};
  switch (isa) {
#if HWY_TARGETS & HWY_SSE4
    case Isa::sse4:
      return N_SSE4::kTable;
#endif
#if HWY_TARGETS & HWY_AVX2
    case Isa::avx2:
      return N_AVX2::kTable;
#endif
#if HWY_TARGETS & HWY_AVX3
    case Isa::avx512:
      return N_AVX3::kTable;
#endif
#if HWY_TARGETS & HWY_NEON
    case Isa::neon:
      return N_NEON::kTable;
#endif
    default:
      return kScalar;
  }
}

}  // namespace rastrum::terrain
#endif
