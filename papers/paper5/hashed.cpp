// SPDX-License-Identifier: BSD-3-Clause
#include <papers/paper5/hashed.hpp>

#include <atomic>

#include <papers/axes/chunk_counts.hpp>
#include <papers/axes/fragments.hpp>
#include <papers/paper5/hash_slots.hpp>

namespace rastrum::family {
namespace {

/// The hash table from pixels to keys. Empty between uses.
template <Sharing kSharing>
class Table {
 public:
  explicit Table(MemoryAccount& memory) : pixels_(memory), keys_(memory) {}

  /// The most entries that fit into `bytes`, but at least some blocks' worth.
  static std::uint64_t entries_for(std::uint64_t bytes) {
    return std::max<std::uint64_t>(
               bytes / HashSlots::kBytes * HashSlots::kLoadNumerator / HashSlots::kLoadDenominator,
               512) -
           256;
  }

  /// Makes room for `entries`. `exec` may be null.
  void restart(std::uint64_t entries, parallel::Threads* exec) {
    slots_ = HashSlots::of(entries).count;
    slots_used_ += slots_;
    if (slots_ <= pixels_.capacity()) return;
    pixels_.reserve(slots_);
    keys_.reserve(slots_);
    for_runs(exec, [&](std::size_t begin, std::size_t end) {
      std::fill(pixels_.data() + begin, pixels_.data() + end, kNoPixel);
      std::fill(keys_.data() + begin, keys_.data() + end, std::uint64_t{0});
    });
  }

  [[nodiscard]] std::uint64_t home(std::uint32_t block) const {
    return HashSlots{slots_}.home(block);
  }
  /// Raises the key of a pixel; there must be room. Returns the number of slots probed if the pixel
  /// is new, else 0. The sum does not depend on the order of the pixels.
  std::uint64_t raise(std::uint64_t home, std::uint32_t pixel, std::uint64_t key) {
    std::uint64_t slot = home + pixel % 64;
    std::uint64_t probes = 1;
    Slot found;
    while ((found = take(pixels_[slot], pixel)) == Slot::of_another) {
      slot = HashSlots{slots_}.next(slot);
      ++probes;
    }
    family::raise<kSharing>(keys_[slot], key);
    return found == Slot::taken ? probes : 0;
  }
  [[nodiscard]] std::uint64_t entries() const { return entries_; }

  /// Raises the surface to the keys and empties the table.
  void scatter(const PixelNumbers& surface, parallel::Threads* exec) {
    std::atomic<std::uint64_t> found = 0;
    for_runs(exec, [&](std::size_t begin, std::size_t end) {
      std::uint64_t n = 0;
      for (std::size_t slot = begin; slot < end; ++slot) {
        const std::uint32_t pixel = pixels_[slot];
        if (pixel == kNoPixel) continue;
        family::raise<Sharing::owned>(surface.keys(pixel / 64)[pixel % 64], keys_[slot]);
        pixels_[slot] = kNoPixel;
        keys_[slot] = 0;
        ++n;
      }
      found.fetch_add(n, std::memory_order_relaxed);
    });
    entries_found_ += found;
    entries_ = 0;
  }

  void collect(Counters& counters) {
    add_counter(counters, "table slots", std::exchange(slots_used_, 0));
    add_counter(counters, "table entries", std::exchange(entries_found_, 0));
  }

 private:
  enum class Slot { taken, known, of_another };

  /// Takes the slot for the pixel if it is free.
  Slot take(std::uint32_t& slot, std::uint32_t pixel) {
    if constexpr (kSharing == Sharing::owned) {
      if (slot == pixel) return Slot::known;
      if (slot != kNoPixel) return Slot::of_another;
      slot = pixel;
      ++entries_;
      return Slot::taken;
    } else {
      const std::atomic_ref<std::uint32_t> shared(slot);
      std::uint32_t seen = shared.load(std::memory_order_relaxed);
      if (seen == kNoPixel &&
          shared.compare_exchange_strong(seen, pixel, std::memory_order_relaxed))
        return Slot::taken;
      return seen == pixel ? Slot::known : Slot::of_another;
    }
  }

  template <class F>
  void for_runs(parallel::Threads* exec, const F& f) {
    constexpr std::size_t kRun = 16384;
    if (exec == nullptr) return f(0, slots_);
    parallel::for_each_index(*exec, (slots_ + kRun - 1) / kRun, [&](std::size_t i) {
      f(i * kRun, std::min<std::uint64_t>(slots_, (i + 1) * kRun));
    });
  }

  ScratchBuffer<std::uint32_t> pixels_;
  ScratchBuffer<std::uint64_t> keys_;
  std::uint64_t slots_ = 0;
  std::uint64_t entries_ = 0;  ///< the current number, if a thread owns the table
  std::uint64_t slots_used_ = 0, entries_found_ = 0;
};

/// Fills a table that may be too small for all pixels, and empties it into the surface when it is
/// full. For one thread.
class FillAndEmpty {
 public:
  explicit FillAndEmpty(MemoryAccount& memory) : table_(memory) {}

  void restart(const PixelNumbers& pixels, std::uint64_t most_entries) {
    pixels_ = pixels;
    most_ = std::min<std::uint64_t>(most_entries, pixels.pixel_count());
    table_.restart(most_, nullptr);
  }
  /// At most 64 fragments may come between two calls.
  void make_room() {
    if (most_ < pixels_.pixel_count() && table_.entries() + 64 > most_) flush();
  }
  [[nodiscard]] std::uint64_t home(std::uint32_t block) const { return table_.home(block); }
  void raise(std::uint64_t home, std::uint32_t pixel, std::uint64_t key) {
    probes_ += table_.raise(home, pixel, key);
    ++hashed_;
  }
  void blocks(const Kernels& kernel, const Piece* pieces, std::span<const Block> blocks) {
    for (const Block& b : blocks) {
      make_room();
      const std::uint32_t block = pixels_.block(b.bx, b.by);
      const std::uint64_t home = table_.home(block);
      for_each_fragment(kernel, pieces[b.piece], b, [&](std::uint32_t i, std::uint64_t key) {
        raise(home, block * 64 + i, key);
      });
    }
  }
  void flush() { table_.scatter(pixels_, nullptr); }
  void collect(Counters& counters) {
    add_counter(counters, "fragments hashed", std::exchange(hashed_, 0));
    add_counter(counters, "probes", std::exchange(probes_, 0));
    table_.collect(counters);
  }

 private:
  Table<Sharing::owned> table_;
  PixelNumbers pixels_;
  std::uint64_t most_ = 0, hashed_ = 0, probes_ = 0;
};

/// The pixels of a tile bound its table, so no counting pass is needed.
class OwnedHashedRegion final : public Region {
 public:
  explicit OwnedHashedRegion(MemoryAccount& memory) : table_(memory) {}

  void begin(const RegionContext& context, const SurfaceView& surface, Rect rect,
             std::size_t) override {
    kernel_ = context.kernel;
    pixels_ = {surface, rect};
    table_.restart(pixels_, context.fragment_bytes == 0
                                ? pixels_.pixel_count()
                                : Table<Sharing::owned>::entries_for(context.fragment_bytes));
    done_ = false;
  }
  std::optional<Pass> next() override {
    if (!std::exchange(done_, true)) return Pass{0, 1};
    table_.flush();
    return std::nullopt;
  }
  void blocks(std::size_t, const Piece* pieces, std::span<const Block> blocks) override {
    table_.blocks(*kernel_, pieces, blocks);
  }
  void fragments(std::span<const BinFragment> fragments) override {
    for (const BinFragment& f : fragments) {
      table_.make_room();
      const std::uint32_t pixel = pixels_.pixel(f);
      table_.raise(table_.home(pixel / 64), pixel, f.key);
    }
  }
  void collect(Counters& counters) override { table_.collect(counters); }

 private:
  FillAndEmpty table_;
  const Kernels* kernel_ = nullptr;
  PixelNumbers pixels_;
  bool done_ = false;
};

class SharedHashedRegion final : public Region {
 public:
  explicit SharedHashedRegion(MemoryAccount& memory)
      : chunk_counts_(memory), table_(memory), alone_(memory) {}

  void begin(const RegionContext& context, const SurfaceView& surface, Rect rect,
             std::size_t chunks) override {
    exec_ = context.exec;
    kernel_ = context.kernel;
    pixels_ = {surface, rect};
    chunks_ = chunks;
    chunk_counts_.restart(chunks);
    most_ = context.fragment_bytes == 0
                ? ~std::uint64_t{0}
                : Table<Sharing::shared>::entries_for(context.fragment_bytes);
    // If all pixels have room, fragments are not cut into runs.
    if (most_ >= pixels_.pixel_count()) most_ = ~std::uint64_t{0};
    step_ = Step::begun;
  }

  std::optional<Pass> next() override {
    switch (step_) {
      case Step::begun:
        step_ = Step::counting;
        return Pass{0, chunks_};
      case Step::counting:
        break;
      case Step::hashing:
        table_.scatter(pixels_, exec_);
        break;
      case Step::alone:
        alone_.flush();
        break;
    }
    const ChunkCounts::Run run = chunk_counts_.take(most_);
    if (run.fragments == 0) return std::nullopt;
    if (run.fragments <= most_) {
      table_.restart(std::min<std::uint64_t>(run.fragments, pixels_.pixel_count()), exec_);
      step_ = Step::hashing;
    } else {
      alone_.restart(pixels_, most_);
      step_ = Step::alone;
    }
    return run.chunks;
  }

  void blocks(std::size_t chunk, const Piece* pieces, std::span<const Block> blocks) override {
    if (step_ == Step::counting) return chunk_counts_.add(chunk, count_fragments(blocks));
    if (step_ == Step::alone) return alone_.blocks(*kernel_, pieces, blocks);
    std::uint64_t probes = 0;
    for (const Block& b : blocks) {
      const std::uint32_t block = pixels_.block(b.bx, b.by);
      const std::uint64_t home = table_.home(block);
      for_each_fragment(*kernel_, pieces[b.piece], b, [&](std::uint32_t i, std::uint64_t key) {
        probes += table_.raise(home, block * 64 + i, key);
      });
    }
    probes_.fetch_add(probes, std::memory_order_relaxed);
    hashed_.fetch_add(count_fragments(blocks), std::memory_order_relaxed);
  }

  void collect(Counters& counters) override {
    add_counter(counters, "fragments hashed", hashed_.exchange(0));
    add_counter(counters, "probes", probes_.exchange(0));
    table_.collect(counters);
    alone_.collect(counters);
  }

 private:
  enum class Step { begun, counting, hashing, alone };

  ChunkCounts chunk_counts_;
  Table<Sharing::shared> table_;
  FillAndEmpty alone_;
  parallel::Threads* exec_ = nullptr;
  const Kernels* kernel_ = nullptr;
  PixelNumbers pixels_;
  std::size_t chunks_ = 0;
  std::uint64_t most_ = 0;
  Step step_ = Step::begun;
  std::atomic<std::uint64_t> hashed_ = 0, probes_ = 0;
};

}  // namespace

std::unique_ptr<Region> make_hashed(Sharing sharing, MemoryAccount& memory) {
  if (sharing == Sharing::owned) return std::make_unique<OwnedHashedRegion>(memory);
  return std::make_unique<SharedHashedRegion>(memory);
}

}  // namespace rastrum::family
