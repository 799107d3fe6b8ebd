// SPDX-License-Identifier: BSD-3-Clause
#include <papers/paper2/binned.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <deque>
#include <numeric>
#include <thread>
#include <vector>

#include <papers/axes/boxes.hpp>
#include <papers/axes/order.hpp>
#include <papers/axes/piece_array.hpp>
#include <papers/paper1/tiles.hpp>
#include <papers/paper2/tile_mask.hpp>
#include <rastrum/error.hpp>
#include <rastrum/parallel/expand_each.hpp>
#include <rastrum/parallel/mask.hpp>
#include <rastrum/parallel/work_queue.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::family {
namespace {

constexpr std::size_t kBatch = 32;

/// Entries of a round unless a memory limit asks for fewer: 24 MiB at the paper's sizes, or 2,000
/// triangles that fill 1920 × 1080.
constexpr std::size_t kQueueEntries = std::size_t{1} << 20;

/// The most tiles of a chunk, some tens of microseconds. Chunks are smaller if there would be fewer
/// than kWorkers of them.
constexpr std::size_t kTilesPerChunk = 256;

/// Counters report the load of this many workers, whatever the number of threads.
constexpr std::size_t kWorkers = 64;

/// The work of each of kWorkers between two barriers.
class Load {
 public:
  void add(std::size_t turn, std::uint64_t work) { of_[turn % kWorkers] += work; }
  [[nodiscard]] std::uint64_t most() const { return *std::max_element(of_.begin(), of_.end()); }
  [[nodiscard]] std::uint64_t total() const {
    return std::accumulate(of_.begin(), of_.end(), std::uint64_t{0});
  }

 private:
  std::array<std::uint64_t, kWorkers> of_{};
};

struct Work {
  std::uint64_t batches = 0, small = 0, large = 0, bins = 0, tile_pairs = 0;
  std::uint64_t most_loaded = 0, total = 0;

  void add(const Load& load) {
    most_loaded += load.most();
    total += load.total();
  }
  void count(Frame& frame) const {
    frame.count("batches", batches);
    frame.count("small", small);
    frame.count("large", large);
    frame.count("bins", bins);
    frame.count("tile pairs", tile_pairs);
    frame.count("most loaded of 64 workers", most_loaded);
    frame.count("work of 64 workers", total);
  }
};

struct Batch {
  std::uint32_t small = 0, large = 0;
  std::uint32_t blocks = 0;  ///< touched by the boxes of the small ones
  std::uint32_t bins = 0;    ///< touched by the boxes of the large ones
};

/// The mask of up to 64 tiles of a bin, which has as many masks as it needs.
using TileMask = parallel::Mask<64>;
constexpr int kMaxMasks = kMaxTilesAcross * kMaxTilesAcross / TileMask::size();

class CountAtEnd {
 public:
  explicit CountAtEnd(std::atomic<std::size_t>& count) : count_(count) {}
  ~CountAtEnd() { count_.fetch_add(1, std::memory_order_release); }
  CountAtEnd(const CountAtEnd&) = delete;
  CountAtEnd& operator=(const CountAtEnd&) = delete;

 private:
  std::atomic<std::size_t>& count_;
};

/// A bin that a persistent worker owns.
struct OwnedBin {
  explicit OwnedBin(const std::shared_ptr<parallel::Arena>& memory)
      : waiting(kBatch, memory), drawn(parallel::ArenaAllocator<std::uint32_t>(memory)) {}

  parallel::WorkQueue<std::uint32_t> waiting;  ///< pieces
  parallel::Buffer<std::uint32_t> drawn;       ///< in the order of the first pass, for later passes
  std::uint64_t tiles = 0;
};

class Binned final : public Coverage {
 public:
  Binned(const Tuning& tuning, MemoryAccount& memory)
      : large_px_(tuning.large_px == 0 ? kLargePx : tuning.large_px),
        persistent_(tuning.schedule == Schedule::persistent),
        sizes_(checked_sizes("binned", tuning, kPaper2Sizes, kBlockSize)),
        masks_per_entry_((static_cast<std::size_t>(sizes_.tiles_per_bin()) + TileMask::size() - 1) /
                         TileMask::size()),
        setup_(memory) {}

  void draw(Frame& frame, std::uint64_t first, std::uint64_t last) override {
    frame_ = &frame;
    grid_ = {frame.view, sizes_.bin_px()};
    order_ = frame.tuning.order;
    pieces_ = setup_.fill(frame, first, last);
    frame.watch.lap(frame.stats, "set up");
    const std::size_t count = (pieces_.size() + kBatch - 1) / kBatch;
    batches_.resize(count);
    parallel::for_each_index(
        frame.exec, count, [&](std::size_t b) { batches_[b] = look_at(b); }, kBatch);
    work_ = {};
    work_.batches = count;
    for (const Batch& b : batches_) {
      work_.small += b.small;
      work_.large += b.large;
    }

    // Finds each batch's place in the queue. A round has the entries of a run of whole batches. A
    // single batch has at most 32 entries a bin, less memory than the view's keys.
    const std::size_t entry_bytes =
        sizeof(BinPair) + masks_per_entry_ * (sizeof(TileMask) + sizeof(std::size_t));
    const std::size_t most =
        frame.expansion_bytes == 0
            ? kQueueEntries
            : std::min<std::size_t>(kQueueEntries, frame.expansion_bytes / entry_bytes);
    const parallel::Expansion queue(frame.exec, batches_, [](const Batch& b) { return b.bins; });
    work_.bins = queue.size();
    for (std::size_t begin = 0; begin < count;) {
      std::size_t end = begin + 1;
      while (end < count && queue.segment_end(end) - queue.first(begin) <= most) ++end;
      if (persistent_)
        draw_persistent(begin, end);
      else
        draw_two_stage(queue, begin, end);
      begin = end;
    }
    work_.count(frame);
  }

 private:
  /// Calls small(piece, box) or large(piece, box) for each piece of the batch whose box holds
  /// samples of the view.
  template <class Small, class Large>
  void each_piece(std::size_t batch, const Small& small, const Large& large) const {
    const std::size_t end = std::min((batch + 1) * kBatch, pieces_.size());
    for (std::size_t i = batch * kBatch; i < end; ++i) {
      const Rect box = piece_bounds(pieces_[i], frame_->view);
      if (box.empty()) continue;
      const auto piece = static_cast<std::uint32_t>(i);
      if (std::int64_t{box.x1 - box.x0} * (box.y1 - box.y0) < large_px_)
        small(piece, box);
      else
        large(piece, box);
    }
  }

  /// Bins or blocks: columns and rows of cells of `size` px.
  struct Cells {
    int x, y, columns, rows;
    [[nodiscard]] std::uint32_t count() const {
      return static_cast<std::uint32_t>(columns) * static_cast<std::uint32_t>(rows);
    }
  };
  static Cells touched(Rect box, int size) {
    const int x = box.x0 / size, y = box.y0 / size;
    return {x, y, (box.x1 - 1) / size + 1 - x, (box.y1 - 1) / size + 1 - y};
  }
  /// Calls f(x, y) in the order of the tuning.
  template <class F>
  void each_cell(const Cells& cells, const F& f) const {
    for (std::uint32_t i = 0; i < cells.count(); ++i) {
      const Cell cell = cell_at(order_, i, cells.columns, cells.rows);
      f(cells.x + cell.column, cells.y + cell.row);
    }
  }
  /// Bins start at the view's corner, not at the image's.
  [[nodiscard]] Cells bins_of(Rect box) const {
    const int x0 = frame_->view.x0, y0 = frame_->view.y0;
    return touched({box.x0 - x0, box.y0 - y0, box.x1 - x0, box.y1 - y0}, sizes_.bin_px());
  }

  [[nodiscard]] Batch look_at(std::size_t batch) const {
    Batch b;
    each_piece(
        batch,
        [&](std::uint32_t, Rect box) {
          ++b.small;
          b.blocks += touched(box, kBlockSize).count();
        },
        [&](std::uint32_t, Rect box) {
          ++b.large;
          b.bins += bins_of(box).count();
        });
    return b;
  }

  /// Draws the small pieces of a batch and calls store(piece, bin) for the bins of the large ones.
  template <class Store>
  void draw_batch(std::size_t batch, Emitter& emitter, const Store& store) const {
    emitter.use(pieces_.data());
    each_piece(
        batch,
        [&](std::uint32_t piece, Rect box) {
          each_cell(touched(box, kBlockSize),
                    [&](int bx, int by) { emitter.add_uncovered(piece, bx, by); });
        },
        [&](std::uint32_t piece, Rect box) {
          each_cell(bins_of(box), [&](int x, int y) {
            store(piece, static_cast<std::uint32_t>(y * grid_.columns() + x));
          });
        });
  }

  void draw_tile(std::uint32_t piece, Rect bin, int tile, Emitter& emitter) const {
    const Rect r = tile_of_bin(sizes_, bin, tile), view = frame_->view;
    for (int y = r.y0; y < std::min(r.y1, view.y1); y += kBlockSize)
      for (int x = r.x0; x < std::min(r.x1, view.x1); x += kBlockSize)
        emitter.add_uncovered(piece, x / kBlockSize, y / kBlockSize);
  }

  void draw_two_stage(const parallel::Expansion& places, std::size_t begin, std::size_t end) {
    Frame& frame = *frame_;
    const std::size_t first = places.first(begin);
    auto queue = parallel::make_buffer<BinPair>(frame.exec, places.segment_end(end - 1) - first);
    draw_shared(frame, end - begin, [&](std::size_t chunk, Emitter& emitter) {
      const bool store = emitter.first_pass();
      std::size_t tail = places.first(begin + chunk) - first;
      draw_batch(begin + chunk, emitter, [&](std::uint32_t piece, std::uint32_t bin) {
        if (store) queue[tail++] = {piece, bin};
      });
    });
    Load stored;
    for (std::size_t b = begin; b < end; ++b) stored.add(b - begin, batches_[b].blocks);
    work_.add(stored);
    frame.watch.lap(frame.stats, "store bins");

    if (queue.empty()) return;
    std::atomic<std::size_t> count = 0;
    auto masks = parallel::make_buffer<TileMask>(frame.exec, queue.size() * masks_per_entry_);
    parallel::for_each_index(
        frame.exec, queue.size(),
        [&](std::size_t i) {
          std::array<TileMask, kMaxMasks> covered{};
          std::size_t found = 0;
          cover_tiles(sizes_, pieces_[queue[i].piece], grid_.rect(queue[i].bin), [&](int tile) {
            covered[static_cast<std::size_t>(tile / TileMask::size())].set(tile % TileMask::size());
            ++found;
          });
          std::copy_n(covered.begin(), masks_per_entry_, &masks[i * masks_per_entry_]);
          count.fetch_add(found, std::memory_order_relaxed);
        },
        kBatch);
    // Each worker gets the same number of chunks, all of equal size.
    const std::size_t most = kWorkers * kTilesPerChunk, turns = (count + most - 1) / most;
    const std::size_t share = std::max<std::size_t>(turns * kWorkers, 1);
    const auto each_mask = parallel::counting(masks.size());
    const parallel::Expansion tiles(
        frame.exec, each_mask, [&](std::size_t m) { return masks[m].rank(); },
        std::max<std::size_t>((count + share - 1) / share, 1));
    draw_shared(frame, tiles.chunks(), [&](std::size_t chunk, Emitter& emitter) {
      emitter.use(pieces_.data());
      parallel::ExpansionChunk(tiles, each_mask, chunk).each([&](std::size_t m, std::size_t k) {
        const BinPair& entry = queue[m / masks_per_entry_];
        const int before = static_cast<int>(m % masks_per_entry_) * TileMask::size();
        draw_tile(entry.piece, grid_.rect(entry.bin), before + masks[m].select(static_cast<int>(k)),
                  emitter);
      });
    });
    Load load;
    for (std::size_t c = 0; c < tiles.chunks(); ++c)
      load.add(c, tiles.chunk_end(c) - tiles.chunk_begin(c));
    work_.add(load);
    work_.tile_pairs += count;
    frame.watch.lap(frame.stats, "rasterize bins");
  }

  void draw_persistent(std::size_t begin, std::size_t end) {
    Frame& frame = *frame_;
    const std::size_t batches = end - begin, bins = grid_.count();
    const auto workers = static_cast<std::size_t>(frame.exec.concurrency());
    std::deque<OwnedBin> queues;
    while (queues.size() < bins) queues.emplace_back(frame.exec.memory());
    // The number of entries in the queues of each worker's bins. At 0 the worker skips them.
    std::vector<std::atomic<std::size_t>> waiting(workers);
    std::atomic<std::size_t> next = 0, stored = 0;

    const auto draw_bin = [&](std::size_t bin, std::span<const std::uint32_t> list,
                              Emitter& emitter) {
      const Rect rect = grid_.rect(bin);
      emitter.use(pieces_.data());
      std::uint64_t count = 0;
      for (const std::uint32_t piece : list) {
        cover_tiles(sizes_, pieces_[piece], rect, [&](int tile) {
          draw_tile(piece, rect, tile, emitter);
          ++count;
        });
      }
      if (emitter.first_pass()) queues[bin].tiles += count;
    };
    const auto work = [&](std::size_t worker, const auto& visit) {
      std::vector<std::uint32_t> list;
      for (;;) {
        throw_if_stopped();
        // Read before the queues, so that later entries are not missed.
        const bool all_stored = stored.load(std::memory_order_acquire) == batches;
        if (waiting[worker].load(std::memory_order_acquire) > 0) {
          for (std::size_t bin = worker; bin < bins; bin += workers) {
            OwnedBin& owned = queues[bin];
            if (!owned.waiting.try_pop(list)) continue;
            waiting[worker].fetch_sub(list.size(), std::memory_order_relaxed);
            owned.drawn.insert(owned.drawn.end(), list.begin(), list.end());
            visit(bin + batches, [&](Emitter& emitter) { draw_bin(bin, list, emitter); });
          }
          continue;
        }
        if (all_stored) return;
        const std::size_t batch = next.fetch_add(1, std::memory_order_relaxed);
        if (batch >= batches) {
          std::this_thread::yield();
          continue;
        }
        // Counts the batch even if it throws, because other workers wait for it.
        const CountAtEnd count(stored);
        visit(batch, [&](Emitter& emitter) {
          draw_batch(begin + batch, emitter, [&](std::uint32_t piece, std::uint32_t bin) {
            queues[bin].waiting.push(piece);
            waiting[bin % workers].fetch_add(1, std::memory_order_release);
          });
        });
      }
    };
    // A bin is a chunk with all its entries. Their order in the first pass is kept, so later passes
    // find the same chunks whichever worker drew what.
    draw_shared(
        frame, batches + bins,
        [&](const auto& visit) {
          parallel::for_each_index(frame.exec, workers,
                                   [&](std::size_t worker) { work(worker, visit); });
        },
        [&](std::size_t chunk, Emitter& emitter) {
          if (chunk >= batches)
            draw_bin(chunk - batches, queues[chunk - batches].drawn, emitter);
          else
            draw_batch(begin + chunk, emitter, [](std::uint32_t, std::uint32_t) {});
        });
    Load load;
    for (std::size_t b = 0; b < batches; ++b) load.add(b, batches_[begin + b].blocks);
    for (std::size_t bin = 0; bin < bins; ++bin) {
      load.add(bin, queues[bin].tiles);
      work_.tile_pairs += queues[bin].tiles;
    }
    work_.add(load);
    frame.watch.lap(frame.stats, "draw");
  }

  std::int64_t large_px_;
  bool persistent_;
  BinSizes sizes_;
  std::size_t masks_per_entry_;
  PieceArray setup_;

  // State of the current draw.
  Frame* frame_ = nullptr;
  TileGrid grid_;
  BlockOrder order_ = BlockOrder::row_major;
  std::span<const Piece> pieces_;
  Work work_;
  parallel::Buffer<Batch> batches_;
};

}  // namespace

std::unique_ptr<Coverage> make_binned(const Tuning& tuning, MemoryAccount& memory) {
  if (tuning.large_px < 0) throw Error(Errc::invalid_argument, "large_px must not be negative");
  return std::make_unique<Binned>(tuning, memory);
}

}  // namespace rastrum::family
