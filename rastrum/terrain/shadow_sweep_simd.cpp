// SPDX-License-Identifier: BSD-3-Clause
// The sweep of shadow_sweep.hpp with Highway, compiled once per instruction set; each lane is a
// band.
#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/terrain/shadow_sweep_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <memory>
#include <utility>
#include <vector>

#include <rastrum/terrain/shadow_kernels.hpp>
#include <rastrum/terrain/shadow_panel-inl.hpp>
#include <rastrum/terrain/shadow_sweep.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::terrain::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using V = hn::Vec<I16>;
using U8 = hn::Rebind<std::uint8_t, I16>;
constexpr std::size_t kGroupBands = 4 * kBands;
constexpr std::int16_t kLeast = SweepUnits::least;

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
  /// Converts to the frame of the block before, in which bounds are lower by `climb`.
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
        panels_{Panel(sweep, static_cast<int>(padded_)), Panel(sweep, static_cast<int>(padded_))},
        lower_(kSubBands * padded_, kLeast),
        blocks_(*std::max_element(sweep.reach.begin() + first / kReachBands,
                                  sweep.reach.begin() + (last - 1) / kReachBands + 1)),
        upper_in_(new std::int16_t[static_cast<std::size_t>(blocks_) * kSubBands * padded_]),
        upper_from_(new std::int16_t[static_cast<std::size_t>(blocks_ + 1) * kSubBands * padded_]),
        dark_(padded_ * Panel::kColumns),
        stride_(panels_[0].stride()) {
    std::fill_n(&upper_from(blocks_, 0, 0), kSubBands * padded_, kLeast);
    for (const SweepRayStep& s : sweep.near)
      near_.push_back({s.ahead * static_cast<std::ptrdiff_t>(stride_) + s.across,
                       static_cast<std::int16_t>(s.climb)});
  }

  void run() {
    for (int last = blocks_; last > 0; last = first_block_) {
      first_block_ = (last - 1) / Panel::kBlocks * Panel::kBlocks;
      std::swap(current_, previous_);
      current_->load(first_block_, last, first_);
      for (int block = last - 1; block >= first_block_; --block) {
        for (int part = 0; part < kSubBands; ++part) sweep_part(block, part);
        for (int c = 0; c < kSweepBlock && block * kSweepBlock + c < sweep_.columns; ++c)
          decide_column(block, c);
      }
      const int own = std::min(last * kSweepBlock, sweep_.columns) - first_block_ * kSweepBlock;
      if (own > 0) store(own);
    }
  }

 private:
  /// The state of a cell; lit is 0.
  enum State : std::uint8_t { kDark = 1, kUndecided = 2 };

  struct Step {
    SweepStep::Kind kind;
    std::int16_t upper, lower;
    const std::int16_t* cells;
    std::uint8_t* dark;
  };

  /// The band loop is outside, so a group's bounds stay in registers.
  HWY_NOINLINE void sweep_part(int block, int part) {
    const SweepBlock& b = sweep_.blocks[static_cast<std::size_t>(block)];
    const auto p = static_cast<std::size_t>(part);
    if (b.first[p] == b.first[p + 1]) return;
    steps_.clear();
    for (std::uint32_t k = b.first[p]; k < b.first[p + 1]; ++k) {
      const SweepStep& s = sweep_.steps[k];
      const int c = in_panel(block, s.column);
      steps_.push_back({s.kind, s.upper, s.lower, current_->cell(c, s.row), dark_of(c)});
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

  /// Counted from the current panel's first column.
  [[nodiscard]] int in_panel(int block, int c) const {
    return (block - first_block_) * kSweepBlock + c;
  }
  [[nodiscard]] std::uint8_t* dark_of(int c) {
    return dark_.data() + static_cast<std::size_t>(c) * padded_;
  }
  [[nodiscard]] std::int16_t& upper_in(int block, int part, std::size_t i) {
    return upper_in_[static_cast<std::size_t>(block * kSubBands + part) * padded_ + i];
  }
  [[nodiscard]] std::int16_t& upper_from(int block, int part, std::size_t i) {
    return upper_from_[static_cast<std::size_t>(block * kSubBands + part) * padded_ + i];
  }

  /// A row outside [0, rows) has no cell.
  [[nodiscard]] std::int64_t row_of(int x, std::size_t i) const {
    const std::int64_t row = std::int64_t{first_} + static_cast<std::int64_t>(i) +
                             sweep_.column[static_cast<std::size_t>(x)].begin_row;
    return sweep_.cyclic ? tiled(row, sweep_.rows, Tiling::repeat) : row;
  }
  [[nodiscard]] std::pair<int, int> cell_of(int x, std::int64_t row) const {
    const int along = sweep_.flipped ? sweep_.columns - 1 - x : x;
    return sweep_.along_x ? std::pair(along, static_cast<int>(row))
                          : std::pair(static_cast<int>(row), along);
  }

  /// The climb of column x's rays, in units, up to a block.
  [[nodiscard]] std::int64_t climb_to(int block, int x) const {
    return sweep_.blocks[static_cast<std::size_t>(block)].frame -
           sweep_.column[static_cast<std::size_t>(x)].begin;
  }

  /// The next columns, still in memory, which decide a column's open cells first.
  struct Outlook {
    int x, end_block;              ///< the cells' column; the first block that is not read
    const std::int16_t* own;       ///< the cell of band 0
    const std::int16_t* before;    ///< the same cell if the panel before went on in this one's
                                   ///< columns
    std::size_t own_steps, steps;  ///< ends of this panel's steps and of all, in near_
    const std::int16_t* upper;     ///< bounds from end_block on; null if there is no block
    std::int16_t climb;            ///< of a ray until end_block, less the rounding
  };
  [[nodiscard]] Outlook outlook_of(int block, int c) {
    Outlook o{};
    o.x = block * kSweepBlock + c;
    // To the end of this block, or of the next if that is near: bounds are known there.
    o.end_block = std::min(kSweepBlock - c > 4 ? block + 1 : block + 2, blocks_);
    const SweepColumn& column = sweep_.column[static_cast<std::size_t>(o.x)];
    const int left = Panel::kColumns - in_panel(block, c);
    o.own = current_->cell(in_panel(block, c), column.begin_row);
    o.steps = sweep_.step_at(o.end_block * kSweepBlock - o.x);
    o.own_steps = std::min(o.steps, sweep_.step_at(left));
    if (o.own_steps < o.steps)
      o.before = previous_->cell(0, column.begin_row) - left * static_cast<std::ptrdiff_t>(stride_);
    if (o.end_block < blocks_) {
      o.upper = &upper_from(o.end_block, column.part, 0);
      o.climb = static_cast<std::int16_t>(climb_to(o.end_block, o.x) - 3);
    }
    return o;
  }

  HWY_NOINLINE void decide_column(int block, int c) {
    const U8 d8;
    std::uint8_t* const dark = dark_of(in_panel(block, c));
    const auto undecided = [&](std::size_t i) HWY_ATTR {
      return !hn::AllFalse(d8, hn::TestBit(hn::LoadU(d8, dark + i), hn::Set(d8, kUndecided)));
    };
    std::size_t i = 0;
    while (i < padded_ && !undecided(i)) i += kBands;
    if (i == padded_) return;
    const Outlook outlook = outlook_of(block, c);
    for (; i < padded_; i += kBands)
      if (undecided(i)) decide(outlook, i, dark);
  }

  /// The next columns decide most open cells, in vectors. The definition decides the rest.
  HWY_INLINE void decide(const Outlook& o, std::size_t i, std::uint8_t* dark) {
    const I16 d;
    const V own = hn::LoadU(d, o.own + i);
    V highest = hn::Set(d, kLeast), others = highest;
    const auto seen = [&](const std::int16_t* from, const Near& step) HWY_ATTR {
      return hn::SaturatedSub(hn::LoadU(d, from + step.cell), hn::Set(d, step.climb));
    };
    const auto walk = [&](const std::int16_t* from, std::size_t k, std::size_t last) HWY_ATTR {
      for (; k + 2 <= last; k += 2) {
        highest = hn::Max(highest, seen(from, near_[k]));
        others = hn::Max(others, seen(from, near_[k + 1]));
      }
      if (k < last) highest = hn::Max(highest, seen(from, near_[k]));
    };
    walk(o.own + i, 0, o.own_steps);
    if (o.own_steps < o.steps) walk(o.before + i, o.own_steps, o.steps);
    highest = hn::Max(highest, others);
    // Both heights and the climb are off by less than 2.1 together.
    const auto hidden = hn::Gt(highest, hn::SaturatedAdd(own, hn::Set(d, 2)));
    const auto near_open = hn::Gt(highest, hn::SaturatedSub(own, hn::Set(d, 2)));
    auto open = near_open;
    if (o.upper != nullptr)
      open = hn::Or(open,
                    hn::Gt(hn::LoadU(d, o.upper + i), hn::SaturatedAdd(own, hn::Set(d, o.climb))));
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
    decide_open(o, i, open_bits, near_bits, dark);
  }

  HWY_NOINLINE void decide_open(const Outlook& o, std::size_t i, const std::uint8_t* open,
                                const std::uint8_t* near, std::uint8_t* dark) {
    for (std::size_t byte = 0; byte < (kBands + 7) / 8; ++byte)
      for (unsigned m = open[byte]; m != 0; m &= m - 1) {
        const auto bit = static_cast<unsigned>(std::countr_zero(m));
        const std::size_t k = i + byte * 8 + bit;
        if (k >= static_cast<std::size_t>(bands_)) continue;
        const std::int64_t of_map = row_of(o.x, k);
        if (of_map < 0 || of_map >= sweep_.rows) continue;
        const bool from_own = (near[byte] >> bit & 1) != 0;
        dark[k] = traverse(o.x, of_map, k, from_own ? o.x / kSweepBlock : o.end_block) ? kDark : 0;
      }
  }

  /// The definition, but skips blocks whose upper bound is not above the ray. Blocks before `block`
  /// cast no shadow here.
  [[nodiscard]] HWY_NOINLINE bool traverse(int x, std::int64_t row, std::size_t i, int block) {
    const auto [cx, cy] = cell_of(x, row);
    const auto own = static_cast<double>(sweep_.map.heights(cx, cy));
    const int part = sweep_.column[static_cast<std::size_t>(x)].part;
    const int own_block = x / kSweepBlock;
    const std::int64_t units = *current_->cell(
        x - first_block_ * kSweepBlock,
        static_cast<std::int64_t>(i) + sweep_.column[static_cast<std::size_t>(x)].begin_row);
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

  /// Where columns lie side by side in the map's rows, 16 × 16 cells at a time are transposed in
  /// registers; the ends are stored cell by cell.
  HWY_NOINLINE void store(int n) {
    const int x0 = first_block_ * kSweepBlock;
    if (!sweep_.along_x) {
      for (int c = 0; c < n; ++c) store_column(x0, c, 0, bands_);
      return;
    }
    std::int32_t begin[Panel::kColumns];
    for (int c = 0; c < n; ++c)
      begin[c] = sweep_.column[static_cast<std::size_t>(x0 + c)].begin_row;
    const auto [low, high] = std::minmax_element(begin, begin + n);
    for (std::int32_t at = *low; at < *high + bands_; at += kSweepBlock) {
      const std::int64_t from = std::int64_t{first_} + at;
      const std::int64_t row = sweep_.cyclic ? tiled(from, sweep_.rows, Tiling::repeat) : from;
      const bool whole = row >= 0 && row + kSweepBlock <= sweep_.rows;
      for (int c0 = 0; c0 < n; c0 += kSweepBlock) {
        const int end = std::min(c0 + kSweepBlock, n);
        const auto has_all = [&](std::int32_t b) {
          return at >= b && at + kSweepBlock <= b + bands_;
        };
        // Rows shift in one direction, so the first and the last column suffice.
        if (whole && end == c0 + kSweepBlock && has_all(begin[c0]) && has_all(begin[end - 1])) {
          const std::uint8_t* columns[kSweepBlock];
          for (int c = c0; c < end; ++c)
            columns[sweep_.flipped ? end - 1 - c : c - c0] = dark_of(c) + (at - begin[c]);
          const int left = cell_of(x0 + (sweep_.flipped ? end - 1 : c0), 0).first;
          turn_16(columns, &shadow_(left, static_cast<int>(row)));
        } else {
          for (int c = c0; c < end; ++c)
            store_column(x0, c, at - begin[c], at - begin[c] + kSweepBlock);
        }
      }
    }
  }

  /// Bands [begin, end) of a column, as far as they exist.
  void store_column(int x0, int c, int begin, int end) {
    const std::uint8_t* const dark = dark_of(c);
    end = std::min(end, bands_);
    for (int i = std::max(begin, 0); i < end;) {
      const std::int64_t row = row_of(x0 + c, static_cast<std::size_t>(i));
      if (row < 0) {
        i += static_cast<int>(-row);
        continue;
      }
      if (row >= sweep_.rows) break;
      const int n = static_cast<int>(std::min(std::int64_t{end} - i, sweep_.rows - row));
      const auto [cx, cy] = cell_of(x0 + c, row);
      std::uint8_t* to = &shadow_(cx, cy);
      if (sweep_.along_x) {
        for (int k = 0; k < n; ++k, to += shadow_.stride) *to = dark[i + k];
      } else {
        std::copy_n(dark + i, n, to);
      }
      i += n;
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
  Panel panels_[2];
  Panel* current_ = &panels_[0];
  Panel* previous_ = &panels_[1];    ///< nearer to the sun
  int first_block_ = 0;              ///< of the current panel
  std::vector<std::int16_t> lower_;  ///< of each part, in the frame of the block before
  int blocks_;
  std::unique_ptr<std::int16_t[]> upper_in_, upper_from_;  ///< in their block's frame
  std::vector<std::uint8_t> dark_;                         ///< of the panel's cells, by column
  /// Steps on the next two blocks, as distances in a Panel.
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

}  // namespace
}  // namespace rastrum::terrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::terrain {

SweepKernel sweep_kernel(Isa isa) noexcept {
  static constexpr SweepKernel kSweeps[] = RASTRUM_BY_ISA(sweep, nullptr);
  return kSweeps[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::terrain
#endif
