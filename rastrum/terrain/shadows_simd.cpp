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
#include <bit>
#include <limits>
#include <memory>
#include <utility>
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

// --- The sweep ----------------------------------------------------------------------------------

using I16 = hn::CappedTag<std::int16_t, 32>;
using V = hn::Vec<I16>;
using U8 = hn::Rebind<std::uint8_t, I16>;
constexpr std::size_t kBands = hn::MaxLanes(I16{});
/// Bands whose bounds are in registers together.
constexpr std::size_t kGroupBands = 4 * kBands;
constexpr std::int16_t kLeast = SweepUnits::least;

/// Heights as units, 8 at a time.
class Quantizer {
 public:
  using D = hn::Full128<std::int16_t>;
  static constexpr std::int64_t kCells = 8;

  explicit Quantizer(const SweepUnits& units)
      : lowest_(hn::Set(F8{}, units.lowest)),
        scale_(hn::Set(F8{}, units.scale)),
        zero_(hn::Set(F8{}, static_cast<float>(units.zero))) {}

  [[nodiscard]] HWY_INLINE hn::Vec<D> operator()(const float* from) const { return of(F8{}, from); }

 private:
  using F8 = hn::CappedTag<float, kCells>;
  static_assert(hn::MaxLanes(F8{}) >= kCells / 2);
  template <class DF>
  [[nodiscard]] HWY_INLINE hn::Vec<D> of(DF df, const float* from) const {
    const hn::Rebind<std::int16_t, DF> d;
    if constexpr (hn::MaxLanes(df) == kCells)
      return hn::DemoteTo(d, units(df, from));
    else
      return hn::Combine(D{}, hn::DemoteTo(d, units(df, from + kCells / 2)),
                         hn::DemoteTo(d, units(df, from)));
  }
  template <class DF>
  [[nodiscard]] HWY_INLINE auto units(DF df, const float* from) const {
    const auto above = hn::Sub(hn::LoadU(df, from), lowest_);
    return hn::NearestInt(hn::Max(hn::MulAdd(above, scale_, zero_), zero_));
  }
  hn::Vec<F8> lowest_, scale_, zero_;
};

/// A block of columns in units, turned so that the rows of a column lie side by side.
class Block {
 public:
  Block(const Sweep& sweep, int bands)
      : sweep_(sweep),
        // |s| ≤ 1: over a block rows shift by its width, and a column's lie within 4.
        rows_(bands + kSweepBlock + 8),
        stride_((static_cast<std::size_t>(rows_ + Quantizer::kCells) + kBands) / kBands * kBands),
        cells_(stride_ * kSweepBlock) {}

  [[nodiscard]] std::size_t stride() const { return stride_; }
  /// Column c's cell in `row` of the sweep's, for the first band.
  [[nodiscard]] const std::int16_t* cell(int c, std::int64_t row) const {
    return cells_.data() + static_cast<std::size_t>(c) * stride_ + (row - low_);
  }
  /// Columns x0 … from row `low` of the band `first_band` on.
  void load(int x0, int first_band, int low) {
    low_ = low;
    const std::int64_t row0 = std::int64_t{first_band} + low;
    const ShadowCaster& map = sweep_.map;
    std::int64_t source[kSweepBlock];
    bool up = true, down = true;
    for (int c = 0; c < kSweepBlock; ++c) {
      const std::int64_t x = sweep_.flipped ? std::int64_t{sweep_.columns} - 1 - (x0 + c) : x0 + c;
      source[c] = tiled(x, sweep_.columns, map.tiling);
      up = up && source[c] == source[0] + c;
      down = down && source[c] == source[0] - c;
    }
    const Quantizer quantize(sweep_.units);
    for_each_run(row0, rows_, sweep_.rows, map.tiling,
                 [&](std::int64_t i, std::int64_t from, std::int64_t length, std::int64_t step)
                     HWY_ATTR {
                       if (!sweep_.along_x) {
                         for (int c = 0; c < kSweepBlock; ++c)
                           take(quantize, map.heights.row(static_cast<int>(source[c])) + from,
                                length, step, at(c, i));
                       } else {
                         for (std::int64_t k = 0; k < length; k += Quantizer::kCells)
                           turn(quantize, source, up, down, i + k, from + k * step, step,
                                std::min(Quantizer::kCells, length - k));
                       }
                     });
  }

 private:
  [[nodiscard]] std::int16_t* at(int c, std::int64_t i) {
    return cells_.data() + static_cast<std::size_t>(c) * stride_ + i;
  }
  /// Whole vectors are stored: what is beyond the end is overwritten by the next run, or never
  /// read.
  static HWY_INLINE void take(const Quantizer& quantize, const float* from, std::int64_t n,
                              std::int64_t step, std::int16_t* to) {
    std::int64_t k = 0;
    if (step == 1)
      for (; k + Quantizer::kCells <= n; k += Quantizer::kCells)
        hn::StoreU(quantize(from + k), Quantizer::D{}, to + k);
    for (; k < n; k += Quantizer::kCells) {
      float beside[Quantizer::kCells] = {};
      copy_run(from + k * step, std::min(Quantizer::kCells, n - k), step, beside);
      hn::StoreU(quantize(beside), Quantizer::D{}, to + k);
    }
  }
  /// 8 rows of the map, `length` of which count.
  HWY_INLINE void turn(const Quantizer& quantize, const std::int64_t* source, bool up, bool down,
                       std::int64_t i, std::int64_t from, std::int64_t step, std::int64_t length) {
    const Quantizer::D d;
    float beside[8][kSweepBlock];
    const float* rows[8];
    for (std::int64_t r = 0; r < 8; ++r) {
      const float* const row =
          sweep_.map.heights.row(static_cast<int>(from + std::min(r, length - 1) * step));
      rows[r] = row + std::min(source[0], source[kSweepBlock - 1]);
      if (up || down) continue;
      for (int c = 0; c < kSweepBlock; ++c) beside[r][c] = row[source[c]];
      rows[r] = beside[r];
    }
    for (int half = 0; half < kSweepBlock; half += 8) {
      hn::Vec<Quantizer::D> a[8], b[8];
      for (int r = 0; r < 8; ++r) a[r] = quantize(rows[r] + half);
      for (int round = 0; round < 3; ++round) {
        for (int r = 0; r < 4; ++r) {
          b[2 * r] = hn::InterleaveLower(d, a[r], a[r + 4]);
          b[2 * r + 1] = hn::InterleaveUpper(d, a[r], a[r + 4]);
        }
        for (int r = 0; r < 8; ++r) a[r] = b[r];
      }
      for (int c = 0; c < 8; ++c)
        hn::StoreU(a[c], d, at(down ? kSweepBlock - 1 - (half + c) : half + c, i));
    }
  }

  const Sweep& sweep_;
  int low_ = 0;
  std::int64_t rows_;
  std::size_t stride_;
  std::vector<std::int16_t> cells_;
};

/// One of the bounds of a group of bands.
struct Bound {
  V v0, v1, v2, v3;

  static HWY_INLINE Bound load(const std::int16_t* from) {
    const I16 d;
    return {hn::LoadU(d, from), hn::LoadU(d, from + kBands), hn::LoadU(d, from + 2 * kBands),
            hn::LoadU(d, from + 3 * kBands)};
  }
  static HWY_INLINE Bound set(std::int16_t value) {
    const V v = hn::Set(I16{}, value);
    return {v, v, v, v};
  }
  HWY_INLINE void store(std::int16_t* to) const {
    const I16 d;
    hn::StoreU(v0, d, to);
    hn::StoreU(v1, d, to + kBands);
    hn::StoreU(v2, d, to + 2 * kBands);
    hn::StoreU(v3, d, to + 3 * kBands);
  }
  HWY_INLINE void raise(const Bound& cells, std::int16_t by) {
    const V less = hn::Set(I16{}, by);
    v0 = hn::Max(v0, hn::Sub(cells.v0, less));
    v1 = hn::Max(v1, hn::Sub(cells.v1, less));
    v2 = hn::Max(v2, hn::Sub(cells.v2, less));
    v3 = hn::Max(v3, hn::Sub(cells.v3, less));
  }
  HWY_INLINE void raise(const Bound& other) {
    v0 = hn::Max(v0, other.v0);
    v1 = hn::Max(v1, other.v1);
    v2 = hn::Max(v2, other.v2);
    v3 = hn::Max(v3, other.v3);
  }
  /// In the frame of a block that lies `climb` before its own.
  HWY_INLINE void sink(std::int16_t climb) {
    const V less = hn::Set(I16{}, climb);
    v0 = hn::SaturatedSub(v0, less);
    v1 = hn::SaturatedSub(v1, less);
    v2 = hn::SaturatedSub(v2, less);
    v3 = hn::SaturatedSub(v3, less);
  }
};

class Sweeper {
 public:
  Sweeper(const Sweep& sweep, int first, int last, ImageView<std::uint8_t> shadow)
      : sweep_(sweep),
        first_(sweep.first_band + first),
        bands_(last - first),
        padded_((static_cast<std::size_t>(bands_) + kGroupBands - 1) / kGroupBands * kGroupBands),
        shadow_(shadow),
        blocks_at_hand_{Block(sweep, static_cast<int>(padded_)),
                        Block(sweep, static_cast<int>(padded_))},
        lower_(kSubBands * padded_, kLeast),
        blocks_(static_cast<int>(sweep.blocks.size())),
        upper_in_(new std::int16_t[sweep.blocks.size() * kSubBands * padded_]),
        upper_from_(new std::int16_t[(sweep.blocks.size() + 1) * kSubBands * padded_]),
        dark_(padded_ * kSweepBlock),
        stride_(blocks_at_hand_[0].stride()) {
    std::fill_n(&upper_from(blocks_, 0, 0), kSubBands * padded_, kLeast);
    for (const SweepRayStep& s : sweep.near)
      near_.push_back({s.ahead * static_cast<std::ptrdiff_t>(stride_) + s.across,
                       static_cast<std::int16_t>(s.climb)});
  }

  void run() {
    for (int block = blocks_ - 1; block >= 0; --block) {
      std::swap(current_, previous_);
      current_->load(block * kSweepBlock, first_,
                     sweep_.blocks[static_cast<std::size_t>(block)].low);
      for (int part = 0; part < kSubBands; ++part) sweep_part(block, part);
      const int x0 = block * kSweepBlock;
      const int own = std::min(kSweepBlock, sweep_.columns - x0);
      for (int c = 0; c < own; ++c) decide_column(block, c);
      if (sweep_.along_x && own == kSweepBlock) {
        store_turned(x0);
        continue;
      }
      for (int c = 0; c < own; ++c) store_column(x0 + c, c, 0, bands_);
    }
  }

 private:
  /// What is known of a cell: lit is 0.
  enum State : std::uint8_t { kDark = 1, kUndecided = 2 };

  /// A SweepStep where its cells are.
  struct Step {
    SweepStep::Kind kind;
    std::int16_t upper, lower;
    const std::int16_t* cells;
    std::uint8_t* dark;
  };

  /// Bands outside, columns inside: the bounds of a group stay in registers.
  void sweep_part(int block, int part) {
    const SweepBlock& b = sweep_.blocks[static_cast<std::size_t>(block)];
    const auto p = static_cast<std::size_t>(part);
    if (b.first[p] == b.first[p + 1]) return;
    steps_.clear();
    for (std::uint32_t k = b.first[p]; k < b.first[p + 1]; ++k) {
      const SweepStep& s = sweep_.steps[k];
      steps_.push_back({s.kind, s.upper, s.lower, current_->cell(s.column, s.row),
                        dark_.data() + s.column * padded_});
    }
    const bool last = block + 1 == blocks_;
    const auto climb = static_cast<std::int16_t>(
        last ? 0 : sweep_.blocks[static_cast<std::size_t>(block) + 1].frame - b.frame);
    for (std::size_t i = 0; i < padded_; i += kGroupBands) sweep_group(block, part, i, climb);
  }

  HWY_INLINE void sweep_group(int block, int part, std::size_t i, std::int16_t climb) {
    std::int16_t* const lower_at = lower_.data() + static_cast<std::size_t>(part) * padded_ + i;
    Bound upper = Bound::set(kLeast), lower = Bound::load(lower_at);
    Bound far = Bound::load(&upper_from(block + 1, part, i));
    lower.sink(climb);
    far.sink(climb);
    for (const Step& s : steps_) {
      const Bound cells = Bound::load(s.cells + i);
      switch (s.kind) {
        case SweepStep::Kind::all_enter:
          lower.raise(cells, s.lower);
          [[fallthrough]];
        case SweepStep::Kind::may_enter:
          upper.raise(cells, s.upper);
          break;
        case SweepStep::Kind::cells_begin: {
          std::uint8_t* const to = s.dark + i;
          judge(s, cells.v0, upper.v0, far.v0, lower.v0, to);
          judge(s, cells.v1, upper.v1, far.v1, lower.v1, to + kBands);
          judge(s, cells.v2, upper.v2, far.v2, lower.v2, to + 2 * kBands);
          judge(s, cells.v3, upper.v3, far.v3, lower.v3, to + 3 * kBands);
        }
      }
    }
    lower.store(lower_at);
    upper.store(&upper_in(block, part, i));
    upper.raise(far);
    upper.store(&upper_from(block, part, i));
  }

  static HWY_INLINE void judge(const Step& s, V own, V upper, V far, V lower, std::uint8_t* to) {
    const I16 d;
    const auto dark = hn::Gt(lower, hn::Sub(own, hn::Set(d, s.lower)));
    const auto perhaps = hn::Gt(hn::Max(upper, far), hn::Sub(own, hn::Set(d, s.upper)));
    const V state = hn::And(hn::VecFromMask(d, perhaps), hn::Set(d, kUndecided));
    hn::StoreU(hn::DemoteTo(U8{}, hn::IfThenElse(dark, hn::Set(d, kDark), state)), U8{}, to);
  }

  /// The upper bound of a block alone, and of all columns from it on.
  [[nodiscard]] std::int16_t& upper_in(int block, int part, std::size_t i) {
    return upper_in_[static_cast<std::size_t>(block * kSubBands + part) * padded_ + i];
  }
  [[nodiscard]] std::int16_t& upper_from(int block, int part, std::size_t i) {
    return upper_from_[static_cast<std::size_t>(block * kSubBands + part) * padded_ + i];
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

  void decide_column(int block, int c) {
    const U8 d8;
    std::uint8_t* const dark = dark_.data() + static_cast<std::size_t>(c) * padded_;
    for (std::size_t i = 0; i < padded_; i += kBands) {
      const auto state = hn::LoadU(d8, dark + i);
      if (!hn::AllFalse(d8, hn::TestBit(state, hn::Set(d8, kUndecided)))) decide(block, c, i, dark);
    }
  }

  /// The frame of a block, seen from where the rays of column x begin.
  [[nodiscard]] std::int64_t climb_to(int block, int x) const {
    return sweep_.blocks[static_cast<std::size_t>(block)].frame -
           sweep_.column[static_cast<std::size_t>(x)].begin;
  }

  /// Vectors first: the cells of the next few columns, which are still at hand, decide most of what
  /// the bounds do not. Where they leave it open, the definition decides.
  HWY_NOINLINE void decide(int block, int c, std::size_t i, std::uint8_t* dark) {
    const I16 d;
    const int x = block * kSweepBlock + c;
    // To the end of a block, whose bounds are known: this one, or the next where that is near.
    const int end_block = kSweepBlock - c > 4 ? block + 1 : block + 2;
    const std::size_t end = sweep_.step_at(end_block * kSweepBlock - x);
    const SweepColumn& column = sweep_.column[static_cast<std::size_t>(x)];
    const auto row = static_cast<std::int64_t>(i) + column.begin_row;
    const V own = hn::LoadU(d, current_->cell(c, row));
    V highest = hn::Set(d, kLeast);
    const auto walk = [&](const std::int16_t* from, std::size_t k, std::size_t last) HWY_ATTR {
      for (; k < last; ++k)
        highest = hn::Max(highest, hn::SaturatedSub(hn::LoadU(d, from + near_[k].cell),
                                                    hn::Set(d, near_[k].climb)));
    };
    const std::size_t own_end = std::min(end, sweep_.step_at(kSweepBlock - c));
    walk(current_->cell(c, row), 0, own_end);
    // Those of the block before, as if its columns went on from this one's.
    if (own_end < end)
      walk(previous_->cell(0, row) + (c - kSweepBlock) * static_cast<std::ptrdiff_t>(stride_),
           own_end, end);
    // Both heights and the climb are off by less than 2.1 together.
    const auto hidden = hn::Gt(highest, hn::SaturatedAdd(own, hn::Set(d, 2)));
    const auto near_open = hn::Gt(highest, hn::SaturatedSub(own, hn::Set(d, 2)));
    auto open = near_open;
    if (end_block < blocks_) {
      const auto climb = static_cast<std::int16_t>(climb_to(end_block, x) - 3);
      open = hn::Or(open, hn::Gt(hn::LoadU(d, &upper_from(end_block, column.part, i)),
                                 hn::SaturatedAdd(own, hn::Set(d, climb))));
    }
    const V state = hn::PromoteTo(d, hn::LoadU(U8{}, dark + i));
    const auto undecided = hn::Eq(state, hn::Set(d, kUndecided));
    open = hn::And(hn::AndNot(hidden, open), undecided);
    const V decided =
        hn::IfThenElse(undecided, hn::And(hn::VecFromMask(d, hidden), hn::Set(d, kDark)), state);
    hn::StoreU(hn::DemoteTo(U8{}, decided), U8{}, dark + i);
    if (hn::AllFalse(d, open)) return;
    std::uint8_t open_bits[8] = {}, near_bits[8] = {};
    hn::StoreMaskBits(d, open, open_bits);
    hn::StoreMaskBits(d, near_open, near_bits);
    for (std::size_t byte = 0; byte < (kBands + 7) / 8; ++byte)
      for (unsigned m = open_bits[byte]; m != 0; m &= m - 1) {
        const auto bit = static_cast<unsigned>(std::countr_zero(m));
        const std::size_t k = i + byte * 8 + bit;
        if (k >= static_cast<std::size_t>(bands_)) continue;
        const std::int64_t at = row_of(x, k);
        if (at < 0 || at >= sweep_.rows) continue;
        const bool near = (near_bits[byte] >> bit & 1) != 0;
        dark[k] = traverse(x, at, k, near ? block : end_block) ? kDark : 0;
      }
  }

  /// The definition, without the blocks whose upper bound is not above the cell's ray; those before
  /// `block` are known to cast no shadow here.
  [[nodiscard]] HWY_NOINLINE bool traverse(int x, std::int64_t row, std::size_t i, int block) {
    const auto [cx, cy] = cell_of(x, row);
    const auto own = static_cast<double>(sweep_.map.heights(cx, cy));
    const int part = sweep_.column[static_cast<std::size_t>(x)].part;
    const int own_block = x / kSweepBlock;
    const std::int64_t units =
        *current_->cell(x % kSweepBlock, static_cast<std::int64_t>(i) +
                                             sweep_.column[static_cast<std::size_t>(x)].begin_row);
    for (; block < blocks_; ++block) {
      if (block > own_block) {
        const std::int64_t ray = units + climb_to(block, x) - 3;
        if (upper_from(block, part, i) <= ray) return false;
        if (upper_in(block, part, i) <= ray) continue;
      }
      const std::size_t end = sweep_.step_at((block + 1) * kSweepBlock - x);
      for (std::size_t k = sweep_.step_at(block * kSweepBlock - x); k < end; ++k) {
        const RayStep& s = sweep_.ray[k];
        if (static_cast<double>(sweep_.map.at(cx + s.dx, cy + s.dy)) > own + s.climb) return true;
      }
    }
    return false;
  }

  /// Bands [begin, end) of a column.
  void store_column(int x, int c, int begin, int end) {
    const std::uint8_t* const dark = dark_.data() + static_cast<std::size_t>(c) * padded_;
    for (int i = begin; i < end;) {
      const std::int64_t row = row_of(x, static_cast<std::size_t>(i));
      if (row < 0) {
        i += static_cast<int>(-row);
        continue;
      }
      if (row >= sweep_.rows) break;
      const int n = static_cast<int>(std::min(std::int64_t{end} - i, sweep_.rows - row));
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

  /// A whole block of columns that lie side by side in each row of the map: 16 × 16 cells at a time
  /// are turned in registers, what is left at the ends is stored cell by cell.
  void store_turned(int x0) {
    std::int32_t begin[kSweepBlock];
    std::int32_t low = 0, high = 0;
    for (int c = 0; c < kSweepBlock; ++c) {
      begin[c] = sweep_.column[static_cast<std::size_t>(x0 + c)].begin_row;
      low = c == 0 ? begin[c] : std::max(low, begin[c]);
      high = c == 0 ? begin[c] : std::min(high, begin[c]);
    }
    const int left = cell_of(sweep_.flipped ? x0 + kSweepBlock - 1 : x0, 0).first;
    std::int32_t at = low;  // rows, from the first band's
    for (; at + kSweepBlock <= high + bands_; at += kSweepBlock) {
      const std::int64_t from = std::int64_t{first_} + at;
      const std::int64_t row = sweep_.cyclic ? tiled(from, sweep_.rows, Tiling::repeat) : from;
      if (row < 0 || row + kSweepBlock > sweep_.rows) {
        for (int c = 0; c < kSweepBlock; ++c)
          store_column(x0 + c, c, at - begin[c], at - begin[c] + kSweepBlock);
        continue;
      }
      const std::uint8_t* from_columns[kSweepBlock];
      for (int c = 0; c < kSweepBlock; ++c)
        from_columns[sweep_.flipped ? kSweepBlock - 1 - c : c] =
            dark_.data() + static_cast<std::size_t>(c) * padded_ + (at - begin[c]);
      turn_16(from_columns, &shadow_(left, static_cast<int>(row)));
    }
    for (int c = 0; c < kSweepBlock; ++c) {
      store_column(x0 + c, c, 0, std::min(bands_, low - begin[c]));
      store_column(x0 + c, c, std::max(0, at - begin[c]), bands_);
    }
  }

  HWY_INLINE void turn_16(const std::uint8_t* const* columns, std::uint8_t* to) {
    static_assert(kSweepBlock == 16);
    const hn::Full128<std::uint8_t> d;
    hn::Vec<hn::Full128<std::uint8_t>> a[16], b[16];
    for (int c = 0; c < 16; ++c) a[c] = hn::LoadU(d, columns[c]);
    for (int round = 0; round < 4; ++round) {
      for (int c = 0; c < 8; ++c) {
        b[2 * c] = hn::InterleaveLower(d, a[c], a[c + 8]);
        b[2 * c + 1] = hn::InterleaveUpper(d, a[c], a[c + 8]);
      }
      for (int c = 0; c < 16; ++c) a[c] = b[c];
    }
    for (int r = 0; r < 16; ++r) hn::StoreU(a[r], d, to + r * shadow_.stride);
  }

  const Sweep& sweep_;
  int first_, bands_;
  std::size_t padded_;
  ImageView<std::uint8_t> shadow_;
  Block blocks_at_hand_[2];
  Block* current_ = &blocks_at_hand_[0];
  Block* previous_ = &blocks_at_hand_[1];  ///< the one before, nearer to the sun
  std::vector<std::int16_t> lower_;        ///< of each part, in the frame of the block before
  int blocks_;
  std::unique_ptr<std::int16_t[]> upper_in_, upper_from_;  ///< in their block's frame
  std::vector<std::uint8_t> dark_;                         ///< of the block, column by column
  /// The steps of two blocks, as distances in a Block.
  struct Near {
    std::ptrdiff_t cell;
    std::int16_t climb;
  };
  std::size_t stride_;
  std::vector<Near> near_;
  std::vector<Step> steps_;
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
