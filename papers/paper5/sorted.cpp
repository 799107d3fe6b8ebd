// SPDX-License-Identifier: BSD-3-Clause
#include <papers/paper5/sorted.hpp>

#include <atomic>
#include <bit>

#include <papers/axes/chunk_counts.hpp>
#include <papers/axes/fragments.hpp>
#include <rastrum/parallel/mask.hpp>
#include <rastrum/parallel/scan.hpp>
#include <rastrum/parallel/scratch.hpp>
#include <rastrum/parallel/sort_by_key.hpp>

namespace rastrum::family {
namespace {

/// Fragments of a slice: 640 KiB with the sort's second half, which fits a core's L2 cache.
constexpr std::size_t kSlice = std::size_t{1} << 15;
/// Below this, the sort's counters cost more than the fragments.
constexpr std::size_t kLeastSlice = 1024;

/// The size of a slice that a thread can sort in `bytes` (0: no limit).
std::size_t slice_for(std::uint64_t bytes) {
  constexpr std::uint64_t kBytes = 2 * (sizeof(std::uint32_t) + sizeof(std::uint64_t));
  if (bytes == 0) return kSlice;
  // An arena's blocks can be a quarter larger than what was asked for.
  return std::clamp<std::uint64_t>(bytes / kBytes * 4 / 5, kLeastSlice, kSlice);
}

/// Bits that tell `n` pixels from each other.
int bits_for(std::size_t n) {
  return std::max(1, static_cast<int>(std::bit_width(n - 1)));
}

/// Sorts fragments by pixel and raises the surface to the maximum of each pixel. No other thread
/// may write these pixels.
template <class SortKey>
void resolve(parallel::Serial& exec, std::span<SortKey> sort_keys, std::span<std::uint64_t> keys,
             int bits, const PixelNumbers& pixels, std::uint32_t first_block) {
  parallel::sort_by_key(exec, sort_keys, keys, bits);
  for (std::size_t i = 0; i < sort_keys.size();) {
    const SortKey sort_key = sort_keys[i];
    std::uint64_t maximum = keys[i];
    for (++i; i < sort_keys.size() && sort_keys[i] == sort_key; ++i)
      maximum = std::max(maximum, keys[i]);
    raise<Sharing::owned>(pixels.keys(first_block + sort_key / 64)[sort_key % 64], maximum);
  }
}

/// Takes fragments as they come and resolves them when a slice is full.
class SliceBySlice {
 public:
  explicit SliceBySlice(MemoryAccount& memory) : sort_keys_(memory), keys_(memory) {}

  void restart(const PixelNumbers& pixels, std::size_t slice) {
    pixels_ = pixels;
    bits_ = bits_for(pixels.pixel_count());
    slice_ = slice;
    sort_keys_.reserve(slice);
    keys_.reserve(slice);
  }
  void add(parallel::Serial& exec, std::uint32_t pixel, std::uint64_t key) {
    sort_keys_[count_] = pixel;
    keys_[count_++] = key;
    if (count_ == slice_) flush(exec);
  }
  void flush(parallel::Serial& exec) {
    if (count_ == 0) return;
    resolve<std::uint32_t>(exec, {sort_keys_.data(), count_}, {keys_.data(), count_}, bits_,
                           pixels_, 0);
    materialized_ += count_;
    ++sorts_;
    count_ = 0;
  }
  void collect(Counters& counters) {
    add_counter(counters, "fragments materialized", std::exchange(materialized_, 0));
    add_counter(counters, "sorts", std::exchange(sorts_, 0));
  }

 private:
  ScratchBuffer<std::uint32_t> sort_keys_;
  ScratchBuffer<std::uint64_t> keys_;
  PixelNumbers pixels_;
  std::size_t slice_ = 0, count_ = 0;
  int bits_ = 0;
  std::uint64_t materialized_ = 0, sorts_ = 0;
};

class OwnedSortedRegion final : public Region {
 public:
  explicit OwnedSortedRegion(MemoryAccount& memory) : exec_(&memory), slices_(memory) {}

  void begin(const RegionContext& context, const SurfaceView& surface, Rect rect,
             std::size_t) override {
    kernel_ = context.kernel;
    pixels_ = {surface, rect};
    slices_.restart(pixels_, slice_for(context.fragment_bytes));
    done_ = false;
  }
  std::optional<Pass> next() override {
    if (!std::exchange(done_, true)) return Pass{0, 1};
    slices_.flush(exec_);
    return std::nullopt;
  }
  void blocks(std::size_t, const Piece* pieces, std::span<const Block> blocks) override {
    for (const Block& b : blocks) {
      const std::uint32_t first = pixels_.block(b.bx, b.by) * 64;
      for_each_fragment(*kernel_, pieces[b.piece], b, [&](std::uint32_t i, std::uint64_t key) {
        slices_.add(exec_, first + i, key);
      });
    }
  }
  void fragments(std::span<const BinFragment> fragments) override {
    for (const BinFragment& f : fragments) slices_.add(exec_, pixels_.pixel(f), f.key);
  }
  void collect(Counters& counters) override { slices_.collect(counters); }

 private:
  parallel::Serial exec_;
  SliceBySlice slices_;
  const Kernels* kernel_ = nullptr;
  PixelNumbers pixels_;
  bool done_ = false;
};

/// The bands of a shared region: runs of blocks, each with a counter per lane. A lane is a run of
/// chunks with counters of its own, so that threads seldom contend for one.
class Bands {
 public:
  explicit Bands(MemoryAccount& memory) : cursors_(memory), begin_(memory) {}

  void restart(const PixelNumbers& pixels, std::size_t lanes) {
    while (block_shift_ < kMostBlockShift && bands_for(pixels, block_shift_) > kBands)
      ++block_shift_;
    while (block_shift_ > 0 && bands_for(pixels, block_shift_ - 1) <= kBands) --block_shift_;
    bands_ = bands_for(pixels, block_shift_);
    lanes_ = lanes;
    cursors_.reserve(bands_ * lanes_);
    begin_.reserve(bands_ + 1);
  }
  [[nodiscard]] std::size_t count() const { return bands_; }
  [[nodiscard]] int pixel_bits() const { return block_shift_ + 6; }
  [[nodiscard]] std::uint32_t first_block(std::size_t band) const {
    return static_cast<std::uint32_t>(band << block_shift_);
  }
  /// The block's first pixel within its band.
  [[nodiscard]] std::uint16_t pixel_in_band(std::uint32_t block) const {
    return static_cast<std::uint16_t>((block & ((1U << block_shift_) - 1)) * 64);
  }
  [[nodiscard]] std::span<const std::uint64_t> begins() const {
    return {begin_.data(), bands_ + 1};
  }

  void clear() { std::fill_n(cursors_.data(), bands_ * lanes_, std::uint64_t{0}); }
  /// Counts `n` fragments of a block or, after `place`, takes places for them. Returns the first.
  std::uint64_t take(std::size_t lane, std::uint32_t block, std::uint64_t n) {
    return std::atomic_ref<std::uint64_t>(cursors_[(block >> block_shift_) * lanes_ + lane])
        .fetch_add(n, std::memory_order_relaxed);
  }
  /// Turns counts into places: the bands in order, within a band the lanes.
  void place(parallel::Threads& exec) {
    const std::span<std::uint64_t> all(cursors_.data(), bands_ * lanes_);
    begin_[bands_] = parallel::exclusive_scan(exec, all, all, std::uint64_t{0});
    for (std::size_t b = 0; b < bands_; ++b) begin_[b] = cursors_[b * lanes_];
  }

 private:
  /// Enough that threads share them evenly and few bits are left to sort.
  static constexpr std::size_t kBands = 1024;
  /// A pixel number in a band has 16 bits.
  static constexpr int kMostBlockShift = 10;

  static std::size_t bands_for(const PixelNumbers& pixels, int shift) {
    return (pixels.block_count() + (std::size_t{1} << shift) - 1) >> shift;
  }

  ScratchBuffer<std::uint64_t> cursors_, begin_;
  std::size_t bands_ = 0, lanes_ = 1;
  int block_shift_ = 0;
};

class SharedSortedRegion final : public Region {
 public:
  explicit SharedSortedRegion(MemoryAccount& memory)
      : bands_(memory),
        chunk_counts_(memory),
        sort_keys_(memory),
        keys_(memory),
        slices_(memory),
        serial_([&memory] { return parallel::Serial(&memory); }) {}

  void begin(const RegionContext& context, const SurfaceView& surface, Rect rect,
             std::size_t chunks) override {
    exec_ = context.exec;
    kernel_ = context.kernel;
    pixels_ = {surface, rect};
    chunks_ = chunks;
    lanes_ = std::clamp<std::size_t>(chunks, 1, static_cast<std::size_t>(exec_->concurrency()) * 4);
    bands_.restart(pixels_, lanes_);
    chunk_counts_.restart(chunks);
    // Half of the budget is for the fragments, half for the threads' sorts of slices.
    most_ = context.fragment_bytes == 0
                ? ~std::uint64_t{0}
                : std::max<std::uint64_t>(
                      context.fragment_bytes / 2 / (sizeof(SortKey) + sizeof(std::uint64_t)), 64);
    slice_ =
        slice_for(context.fragment_bytes / 2 / static_cast<std::uint64_t>(exec_->concurrency()));
    step_ = Step::begun;
  }

  std::optional<Pass> next() override {
    switch (step_) {
      case Step::begun:
        return count({{0, chunks_}, 0}, Step::counting_all);
      case Step::counting_all:
        run_ = chunk_counts_.take(most_);
        if (run_.chunks.first == 0 && run_.chunks.last == chunks_ && run_.fragments <= most_)
          return write();
        return next_run();
      case Step::counting:
        return write();
      case Step::writing:
        resolve_bands();
        break;
      case Step::streaming:
        slices_.flush(serial_.local());
        break;
    }
    run_ = chunk_counts_.take(most_);
    return next_run();
  }

  void blocks(std::size_t chunk, const Piece* pieces, std::span<const Block> blocks) override {
    const std::size_t lane = chunk * lanes_ / chunks_;
    switch (step_) {
      case Step::counting_all:
        chunk_counts_.add(chunk, count_fragments(blocks));
        [[fallthrough]];
      case Step::counting:
        for (const Block& b : blocks)
          bands_.take(lane, pixels_.block(b.bx, b.by),
                      static_cast<std::uint64_t>(parallel::popcount(b.mask)));
        break;
      case Step::writing:
        for (const Block& b : blocks) {
          const std::uint32_t block = pixels_.block(b.bx, b.by);
          const std::uint32_t first = bands_.pixel_in_band(block);
          std::uint64_t to =
              bands_.take(lane, block, static_cast<std::uint64_t>(parallel::popcount(b.mask)));
          for_each_fragment(*kernel_, pieces[b.piece], b, [&](std::uint32_t i, std::uint64_t key) {
            sort_keys_[to] = static_cast<SortKey>(first + i);
            keys_[to++] = key;
          });
        }
        break;
      default:
        parallel::Serial& serial = serial_.local();
        for (const Block& b : blocks) {
          const std::uint32_t first = pixels_.block(b.bx, b.by) * 64;
          for_each_fragment(*kernel_, pieces[b.piece], b, [&](std::uint32_t i, std::uint64_t key) {
            slices_.add(serial, first + i, key);
          });
        }
    }
  }

  void collect(Counters& counters) override {
    add_counter(counters, "fragments materialized", std::exchange(materialized_, 0));
    add_counter(counters, "sorts", sorts_.exchange(0));
    slices_.collect(counters);
  }

 private:
  using SortKey = std::uint16_t;
  enum class Step { begun, counting_all, counting, writing, streaming };

  Pass count(ChunkCounts::Run run, Step step) {
    bands_.clear();
    run_ = run;
    step_ = step;
    return run.chunks;
  }
  Pass write() {
    bands_.place(*exec_);
    sort_keys_.reserve(run_.fragments);
    keys_.reserve(run_.fragments);
    step_ = Step::writing;
    return run_.chunks;
  }
  /// Starts `run_`, which is a part of the chunks.
  std::optional<Pass> next_run() {
    if (run_.fragments == 0) return std::nullopt;
    if (run_.fragments <= most_) return count(run_, Step::counting);
    slices_.restart(pixels_, slice_);
    step_ = Step::streaming;
    return run_.chunks;
  }

  void resolve_bands() {
    const std::span<const std::uint64_t> begins = bands_.begins();
    parallel::for_each_index(*exec_, bands_.count(), [&](std::size_t band) {
      for (std::uint64_t at = begins[band]; at < begins[band + 1];) {
        const std::uint64_t n = std::min<std::uint64_t>(slice_, begins[band + 1] - at);
        resolve<SortKey>(serial_.local(), {sort_keys_.data() + at, n}, {keys_.data() + at, n},
                         bands_.pixel_bits(), pixels_, bands_.first_block(band));
        sorts_.fetch_add(1, std::memory_order_relaxed);
        at += n;
      }
    });
    materialized_ += run_.fragments;
  }

  Bands bands_;
  ChunkCounts chunk_counts_;
  ScratchBuffer<SortKey> sort_keys_;
  ScratchBuffer<std::uint64_t> keys_;
  SliceBySlice slices_;
  parallel::ScratchPool<parallel::Serial> serial_;
  parallel::Threads* exec_ = nullptr;
  const Kernels* kernel_ = nullptr;
  PixelNumbers pixels_;
  std::size_t chunks_ = 0, lanes_ = 1, slice_ = 0;
  std::uint64_t most_ = 0;
  ChunkCounts::Run run_;
  Step step_ = Step::begun;
  std::uint64_t materialized_ = 0;
  std::atomic<std::uint64_t> sorts_ = 0;
};

}  // namespace

std::unique_ptr<Region> make_sorted(Sharing sharing, MemoryAccount& memory) {
  if (sharing == Sharing::owned) return std::make_unique<OwnedSortedRegion>(memory);
  return std::make_unique<SharedSortedRegion>(memory);
}

}  // namespace rastrum::family
