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

/// A block of columns, turned so that the rows of a column lie side by side.
class Block {
 public:
  Block(const Sweep& sweep, int bands)
      : sweep_(sweep),
        // |s| ≤ 1: over a block rows shift by its width, and a column's lie within 4.
        stride_((static_cast<std::size_t>(bands) + kSweepBlock + 8 + 2 * kLanes) / kLanes * kLanes),
        cells_(stride_ * kSweepBlock) {}

  [[nodiscard]] std::size_t stride() const { return stride_; }
  /// The row of band 0's first cell.
  [[nodiscard]] int low() const { return low_; }
  [[nodiscard]] const float* column(int c) const {
    return cells_.data() + static_cast<std::size_t>(c) * stride_;
  }
  /// Columns x0 …, `n` of them; row `low` of band 0, which is the map's `first_band`, and on.
  void load(int x0, int n, int first_band, int low) {
    low_ = low;
    const std::int64_t row0 = std::int64_t{first_band} + low;
    const ShadowCaster& map = sweep_.map;
    std::int64_t source[kSweepBlock];
    bool up = n == kSweepBlock, down = up;
    for (int c = 0; c < n; ++c) {
      const std::int64_t x = sweep_.flipped ? std::int64_t{sweep_.columns} - 1 - (x0 + c) : x0 + c;
      source[c] = tiled(x, sweep_.columns, map.tiling);
      up = up && source[c] == source[0] + c;
      down = down && source[c] == source[0] - c;
    }
    for_each_run(
        row0, static_cast<std::int64_t>(stride_), sweep_.rows, map.tiling,
        [&](std::int64_t i, std::int64_t from, std::int64_t length, std::int64_t step) HWY_ATTR {
          if (!sweep_.along_x) {
            for (int c = 0; c < n; ++c)
              copy_run(map.heights.row(static_cast<int>(source[c])) + from, length, step, at(c, i));
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
  int low_ = 0;
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
        blocks_at_hand_{Block(sweep, static_cast<int>(padded_)),
                        Block(sweep, static_cast<int>(padded_))},
        lower_(kSubBands * padded_, -kInfinity),
        blocks_((sweep.column.size() + kSweepBlock - 1) / kSweepBlock),
        upper_in_(blocks_ * kSubBands * padded_),
        upper_from_((blocks_ + 1) * kSubBands * padded_, -kInfinity),
        dark_(padded_ * kSweepBlock),
        stride_(blocks_at_hand_[0].stride()) {
    const std::size_t reach = sweep.step_at(2 * kSweepBlock);
    for (std::size_t k = 0; k < reach; ++k) {
      const SweepStep& s = sweep.along[k];
      near_.push_back({s.ahead * static_cast<std::ptrdiff_t>(stride_) + s.across, s.climb});
    }
  }

  void run() {
    const int all = static_cast<int>(sweep_.column.size());
    for (int x0 = (all - 1) / kSweepBlock * kSweepBlock; x0 >= 0; x0 -= kSweepBlock) {
      const int n = std::min(kSweepBlock, all - x0);
      int low = sweep_.column[static_cast<std::size_t>(x0)].row;
      for (int c = 0; c < n; ++c) {
        const SweepColumn& column = sweep_.column[static_cast<std::size_t>(x0 + c)];
        low = std::min({low, column.row, column.begin_row});
      }
      std::swap(current_, previous_);
      current_->load(x0, n, first_, low);
      sweep_block(x0, n);
      if (sweep_.along_x && x0 + kSweepBlock <= sweep_.columns) {
        store_turned(x0);
        continue;
      }
      for (int c = 0; c < n && x0 + c < sweep_.columns; ++c) store_column(x0 + c, c, 0, bands_);
    }
  }

 private:
  static_assert(kSubBands == 2);

  /// Columns outside, bands inside: what a column is to all bands stays in registers.
  void sweep_block(int x0, int n) {
    const F32 d;
    const int block = x0 / kSweepBlock;
    std::fill_n(&upper_in(block, 0, 0), kSubBands * padded_, -kInfinity);
    for (int c = n - 1; c >= 0; --c) {
      const int x = x0 + c;
      const SweepColumn& column = sweep_.column[static_cast<std::size_t>(x)];
      if (x < sweep_.columns) test_column(column, x, c, block);
      const float* const cells = current_->column(c) + (column.row - current_->low());
      for (int part = 0; part < kSubBands; ++part) {
        const SweepEntry* const e = column.entries[static_cast<std::size_t>(part)].data();
        float* const upper = &upper_in(block, part, 0);
        float* const lower = lower_.data() + static_cast<std::size_t>(part) * padded_;
        switch (column.count[static_cast<std::size_t>(part)]) {
          case 0:
            break;
          case 1:
            raise<1>(e, cells, upper, lower);
            break;
          case 2:
            raise<2>(e, cells, upper, lower);
            break;
          case 3:
            raise<3>(e, cells, upper, lower);
            break;
          default:
            raise<4>(e, cells, upper, lower);
        }
      }
    }
    for (int part = 0; part < kSubBands; ++part)
      for (std::size_t i = 0; i < padded_; i += kLanes)
        hn::StoreU(hn::Max(hn::LoadU(d, &upper_in(block, part, i)),
                           hn::LoadU(d, &upper_from(block + 1, part, i))),
                   d, &upper_from(block, part, i));
  }

  /// Lifts the bounds of a part of all bands by the cells that its rays may enter in a column.
  template <int kEntries>
  HWY_INLINE void raise(const SweepEntry* entries, const float* cells, float* upper,
                        float* lower) const {
    const F32 d;
    for (std::size_t i = 0; i < padded_; i += kLanes) {
      F up = hn::LoadU(d, upper + i), low = hn::LoadU(d, lower + i);
      for (int k = 0; k < kEntries; ++k) {
        const F h = hn::LoadU(d, cells + i + entries[k].row);
        up = hn::Max(up, hn::Sub(h, hn::Set(d, entries[k].upper)));
        low = hn::Max(low, hn::Sub(h, hn::Set(d, entries[k].lower)));
      }
      hn::StoreU(up, d, upper + i);
      hn::StoreU(low, d, lower + i);
    }
  }

  void test_column(const SweepColumn& column, int x, int c, int block) {
    const F32 d;
    const U32 du;
    const hn::Rebind<std::uint8_t, U32> d8;
    const float* const cells = current_->column(c) + (column.begin_row - current_->low());
    const float* const upper = &upper_in(block, column.part, 0);
    const float* const far = &upper_from(block + 1, column.part, 0);
    const float* const lower = lower_.data() + static_cast<std::size_t>(column.part) * padded_;
    std::uint8_t* const to = dark_.data() + static_cast<std::size_t>(c) * padded_;
    const F surely = hn::Set(d, column.begin - sweep_.slack);
    const F perhaps = hn::Set(d, column.begin + sweep_.slack);
    for (std::size_t i = 0; i < padded_; i += kLanes) {
      const F own = hn::LoadU(d, cells + i), ray = hn::Sub(own, perhaps);
      const F most = hn::Max(hn::LoadU(d, upper + i), hn::LoadU(d, far + i));
      const auto dark = hn::Gt(hn::LoadU(d, lower + i), hn::Sub(own, surely));
      hn::StoreU(hn::TruncateTo(
                     d8, hn::And(hn::VecFromMask(du, hn::RebindMask(du, dark)), hn::Set(du, 1))),
                 d8, to + i);
      const auto undecided = hn::AndNot(dark, hn::Gt(most, ray));
      if (!hn::AllFalse(d, undecided)) decide(undecided, own, ray, x, i, to + i);
    }
  }

  /// The upper bound of a block alone, and of all columns from it on.
  [[nodiscard]] float& upper_in(int block, int part, std::size_t i) {
    return upper_in_[static_cast<std::size_t>(block * kSubBands + part) * padded_ + i];
  }
  [[nodiscard]] float& upper_from(int block, int part, std::size_t i) {
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

  /// Vectors first: the cells of the next few columns, which are still at hand, decide most of what
  /// the bounds do not. Where they leave it open, or float32 might, the definition decides.
  HWY_NOINLINE void decide(hn::Mask<F32> undecided, F own, F ray, int x, std::size_t i,
                           std::uint8_t* dark) {
    const F32 d;
    const int block = static_cast<int>(static_cast<unsigned>(x) / kSweepBlock);
    // To the end of a block, whose bounds are known: this one, or the next where that is near.
    const int end_block = (block + 1) * kSweepBlock - x > 4 ? block + 1 : block + 2;
    const std::size_t end = sweep_.step_at(end_block * kSweepBlock - x);
    const F above = hn::Add(own, hn::Set(d, sweep_.slack));
    const F below = hn::Sub(own, hn::Set(d, sweep_.slack));
    const int begin_row = sweep_.column[static_cast<std::size_t>(x)].begin_row;
    F highest = hn::Set(d, -kInfinity);
    const auto walk = [&](const float* from, std::size_t k, std::size_t last) HWY_ATTR {
      for (; k < last; ++k) {
        const F h = hn::LoadU(d, from + near_[k].cell);
        highest = hn::Max(highest, hn::Sub(h, hn::Set(d, near_[k].climb)));
      }
    };
    const int c = x - block * kSweepBlock;
    const auto row = static_cast<std::ptrdiff_t>(i) + begin_row;
    const std::size_t own_end = std::min(end, sweep_.step_at(kSweepBlock - c));
    walk(current_->column(c) + (row - current_->low()), 0, own_end);
    // Those of the block before, as if its columns went on from this one's.
    if (own_end < end)
      walk(previous_->column(0) +
               ((c - kSweepBlock) * static_cast<std::ptrdiff_t>(stride_) + row - previous_->low()),
           own_end, end);
    const auto hidden = hn::Gt(highest, above);
    const auto near_open = hn::Gt(highest, below);
    auto open = near_open;
    if (end_block < static_cast<int>(blocks_)) {
      const int part = sweep_.column[static_cast<std::size_t>(x)].part;
      open = hn::Or(open, hn::Gt(hn::LoadU(d, &upper_from(end_block, part, i)), ray));
    }
    open = hn::And(hn::AndNot(hidden, open), undecided);
    std::uint8_t hidden_bits[8] = {}, open_bits[8] = {}, near_bits[8] = {};
    hn::StoreMaskBits(d, hn::And(hidden, undecided), hidden_bits);
    hn::StoreMaskBits(d, open, open_bits);
    hn::StoreMaskBits(d, near_open, near_bits);
    for (std::size_t byte = 0; byte < (kLanes + 7) / 8; ++byte) {
      for (unsigned m = hidden_bits[byte]; m != 0; m &= m - 1)
        dark[byte * 8 + static_cast<unsigned>(std::countr_zero(m))] = 1;
      for (unsigned m = open_bits[byte]; m != 0; m &= m - 1) {
        const auto bit = static_cast<unsigned>(std::countr_zero(m));
        const std::size_t k = byte * 8 + bit;
        if (i + k >= static_cast<std::size_t>(bands_)) continue;
        const std::int64_t row = row_of(x, i + k);
        if (row < 0 || row >= sweep_.rows) continue;
        const bool near = (near_bits[byte] >> bit & 1) != 0;
        dark[k] = traverse(x, row, i + k, near ? block : end_block) ? 1 : 0;
      }
    }
  }

  /// The definition, without the blocks whose upper bound is not above the cell's ray; those before
  /// `block` are known to cast no shadow here.
  [[nodiscard]] HWY_NOINLINE bool traverse(int x, std::int64_t row, std::size_t i, int block) {
    const auto [cx, cy] = cell_of(x, row);
    const float height = sweep_.map.heights(cx, cy);
    const auto own = static_cast<double>(height);
    const SweepColumn& column = sweep_.column[static_cast<std::size_t>(x)];
    const float ray = height - (column.begin + sweep_.slack);
    const int own_block = x / kSweepBlock;
    for (const int last = static_cast<int>(blocks_); block < last; ++block) {
      if (block > own_block) {
        if (upper_from(block, column.part, i) <= ray) return false;
        if (upper_in(block, column.part, i) <= ray) continue;
      }
      const std::size_t end = sweep_.step_at((block + 1) * kSweepBlock - x);
      for (std::size_t k = sweep_.step_at(block * kSweepBlock - x); k < end; ++k) {
        const RayStep& s = sweep_.steps[k];
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
  std::vector<float> lower_;               ///< of each part
  std::size_t blocks_;
  std::vector<float> upper_in_, upper_from_;
  std::vector<std::uint8_t> dark_;  ///< of the block, column by column
  /// The steps of two blocks, as distances in a Block.
  struct Near {
    std::ptrdiff_t cell;
    float climb;
  };
  std::size_t stride_;
  std::vector<Near> near_;
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
