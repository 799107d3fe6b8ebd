// SPDX-License-Identifier: BSD-3-Clause
// The second half of the fast path: a thread owns a bin, covers its pieces, keeps their keys in
// cache and shades them. The type of bin decides how fragments of a pixel are resolved: by the
// maximum (BinKeys) or in exact layers (transparency/layers.hpp).
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/scratch.hpp>
#include <rastrum/raster/bin/groups.hpp>
#include <rastrum/raster/cover/row_lists.hpp>
#include <rastrum/raster/frame/frame_run.hpp>
#include <rastrum/raster/frame/tile_surface.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::raster {

/// A bin that a thread draws, such as BinKeys. kColors: it fills the surface's colours.
template <class B>
concept Bin = std::convertible_to<decltype(B::kColors), bool> &&
    requires(B& bin, const BinContext& context, const SurfaceView& surface, Rect rect,
             const Piece* pieces, std::span<const Block> blocks,
             std::span<const BinFragment> fragments, Counters& counters) {
  bin.begin(context, surface, rect);
  bin.blocks(pieces, blocks);
  bin.fragments(fragments);
  { bin.bounds() } -> std::same_as<DepthBounds*>;
  bin.find_bounds();
  bin.finish();
  bin.collect(counters);
};
/// It has rows of keys for small triangles.
template <class B>
concept BinWithRows = Bin<B> && requires(B& bin) {
  { bin.rows() } -> std::same_as<RowKeys*>;
  { bin.rows_raised() } -> std::same_as<std::uint64_t>;
};
/// It may take what CoverWindows writes.
template <class B>
concept BinWithWindows = Bin<B> && requires(B& bin, const Piece* pieces, std::span<Block> windows) {
  { bin.takes_windows() } -> std::same_as<bool>;
  bin.windows(pieces, windows);
};
/// The keys of its surface hide fragments that would be tested.
template <class B>
concept BinWithSurface = Bin<B> && requires(B& bin) {
  { bin.surface() } -> std::same_as<const SurfaceView&>;
};
/// It draws the quadrics of lists that defer (BinTable).
template <class B>
concept BinWithDeferred = Bin<B> && requires(B& bin, FrameRun& frame, std::span<const Group> groups,
                                             std::size_t number, Rect rect) {
  bin.deferred(frame, groups, number, rect);
};

template <Bin B>
class Bins {
 public:
  template <class... Args>
  explicit Bins(MemoryAccount& memory, Args... args)
      : workers_([&memory, args...] {
          return Worker{memory, args...};
        }) {}

  /// Draws what `groups` have in `bin`, or in its part `rect`, at most `side_px` across.
  /// Thread-safe for distinct rectangles.
  void draw(FrameRun& frame, const BinTable& lists, std::span<const Group> groups, std::size_t bin,
            Rect rect, int side_px) {
    const bool local = !frame.has_surface();
    bool is_empty = true;
    for (const Group& group : groups) is_empty = is_empty && group.is_empty(lists, bin);
    if (is_empty && local) return frame.shade_nothing(rect);
    if (is_empty) return;
    Worker& worker = workers_.local();
    const SurfaceView surface = local ? worker.tile.begin(frame.request, rect, side_px, B::kColors)
                                      : frame.surface_at(rect);
    worker.bin.begin(frame.context(), surface, rect);
    if constexpr (BinWithDeferred<B>)
      if (lists.defers) worker.bin.deferred(frame, groups, bin, rect);
    Sink sink(frame, worker);
    enumerate_bin(frame, lists, groups, bin, rect, sink);
    sink.flush();
    worker.bin.finish();
    if (local) frame.shade(surface, rect);
  }

  void collect(Counters& counters) {
    workers_.for_each([&](Worker& worker) { worker.bin.collect(counters); });
  }

 private:
  struct Worker {
    template <class... Args>
    explicit Worker(MemoryAccount& memory, Args... args) : tile(memory), bin(memory, args...) {}
    alignas(64) Block blocks[kBlockCapacity];
    TileSurface tile;
    B bin;
  };

  /// Collects covered blocks, counts and tests them, and hands them to the bin.
  class Sink {
   public:
    Sink(FrameRun& frame, Worker& worker) : frame_(frame), worker_(worker) {
      // Tests and the overdraw count work on blocks, so they get no windows.
      if constexpr (BinWithWindows<B>)
        if (!frame.plan.tests && frame.plan.hides && worker.bin.takes_windows())
          windows_ = cover_windows(frame.request.isa);
    }

    void use(const Piece* pieces) { pieces_ = pieces; }
    [[nodiscard]] std::span<Block> room() {
      if (kBlockCapacity - count_ < static_cast<std::size_t>(kBlocksPerBin)) flush();
      return {worker_.blocks + count_, kBlockCapacity - count_};
    }
    void written(std::size_t n) { count_ += n; }
    [[nodiscard]] CoverWindows windows() const requires BinWithWindows<B> { return windows_; }
    [[nodiscard]] DepthBounds* bounds() { return worker_.bin.bounds(); }
    void find_bounds() { worker_.bin.find_bounds(); }
    [[nodiscard]] RowKeys* rows() requires BinWithRows<B> { return worker_.bin.rows(); }
    void fragments(Rect bin, std::span<const BinFragment> fragments) {
      frame_.count_fragments(bin, fragments);
      worker_.bin.fragments(fragments);
    }
    void small(Rect bin, Rect rect,
               std::span<const BinTriangle> triangles) requires BinWithRows<B> {
      // In batches, so that one can hide triangles of the next.
      for (; !triangles.empty();
           triangles = triangles.subspan(std::min(triangles.size(), kMostRowPieces))) {
        frame_.kernel.raise_small(triangles.data(), std::min(triangles.size(), kMostRowPieces),
                                  bin.x0, bin.y0, rect, bounds(), *rows());
        flush();
      }
    }
    void flush() {
      if constexpr (BinWithRows<B>)
        if (rows() != nullptr) {
          throw_if_stopped();
          frame_.fragments.fetch_add(worker_.bin.rows_raised(), std::memory_order_relaxed);
        }
      if (count_ == 0) return;
      throw_if_stopped();  // one bin may have most of the scene
      std::span<Block> blocks(worker_.blocks, count_);
      count_ = 0;
      frame_.count_fragments(blocks);
      if constexpr (BinWithWindows<B>)
        if (windows_ != nullptr) return worker_.bin.windows(pieces_, blocks);
      const SurfaceView* seen = nullptr;
      std::size_t most = blocks.size();
      if constexpr (BinWithSurface<B>)
        if (frame_.plan.tests) {
          seen = &worker_.bin.surface();
          most = kTestedAtOnce;
        }
      for (; !blocks.empty(); blocks = blocks.subspan(std::min(blocks.size(), most))) {
        const std::span<Block> some =
            frame_.test(pieces_, blocks.first(std::min(blocks.size(), most)), seen);
        if (!some.empty()) worker_.bin.blocks(pieces_, some);
      }
    }

   private:
    /// Few, so that what they leave hides fragments of the next batch before its tests.
    static constexpr std::size_t kTestedAtOnce = 32;

    FrameRun& frame_;
    Worker& worker_;
    CoverWindows windows_ = nullptr;
    const Piece* pieces_ = nullptr;
    std::size_t count_ = 0;
  };

  parallel::ScratchPool<Worker> workers_;
};

}  // namespace rastrum::raster
