// SPDX-License-Identifier: BSD-3-Clause
// A frame that a row of the family draws. draw_shared and draw_tiles join the two axes of the
// table.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <papers/axes/order.hpp>
#include <papers/axes/region.hpp>
#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/parallel/scratch.hpp>
#include <rastrum/raster/bin/tile_grid.hpp>
#include <rastrum/raster/context/stopwatch.hpp>
#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/frame/frame_run.hpp>
#include <rastrum/raster/frame/tile_surface.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/rules/surface_view.hpp>

namespace rastrum::family {

/// The memory that a thread needs for a tile or a chunk, kept between frames.
struct Worker {
  explicit Worker(MemoryAccount& memory) : tile(memory) {}

  alignas(64) Block blocks[kBlockCapacity];
  TileSurface tile;
  std::unique_ptr<Region> region;
};

class Frame;

/// Collects the blocks of a chunk and hands them to a region. It also counts overdraw and applies
/// the fragment test, in every pass.
class Emitter {
 public:
  Emitter(Frame& frame, Worker& worker, Region& region, std::size_t chunk, bool first_pass)
      : frame_(frame), worker_(worker), region_(region), chunk_(chunk), first_pass_(first_pass) {}
  Emitter(const Emitter&) = delete;
  Emitter& operator=(const Emitter&) = delete;

  /// Sets the pieces that the following blocks refer to.
  void use(const Piece* pieces) {
    if (pieces == pieces_) return;
    flush();
    pieces_ = pieces;
  }
  /// Adds a block with the samples that it covers. An empty mask is left out.
  void add(const Block& block) {
    worker_.blocks[count_] = block;
    count_ += block.mask != 0;
    if (count_ == kBlockCapacity) flush();
  }
  /// Adds a block that touches the view. Its samples are found later, for many blocks at once.
  void add_uncovered(std::uint32_t piece, int bx, int by) {
    worker_.blocks[count_++] = {piece, static_cast<std::uint16_t>(bx),
                                static_cast<std::uint16_t>(by), 0};
    to_cover_ = true;
    if (count_ == kBlockCapacity) flush();
  }
  /// Room for kBlocksPerBin blocks or more, for a kernel to write. Call `written` with their
  /// number.
  [[nodiscard]] std::span<Block> room() {
    if (kBlockCapacity - count_ < static_cast<std::size_t>(kBlocksPerBin)) flush();
    return {worker_.blocks + count_, kBlockCapacity - count_};
  }
  void written(std::size_t n) { count_ += n; }
  /// Bounds of the depths that the tile hides by now; null if nothing may be left out.
  [[nodiscard]] DepthBounds* bounds() { return region_.bounds(); }
  /// Updates bounds() for all that has been drawn so far.
  void find_bounds() {
    flush();
    region_.find_bounds();
  }
  [[nodiscard]] bool first_pass() const { return first_pass_; }
  /// Adds fragments of micro triangles, whose keys are known (Visibility::takes_fragments).
  void fragments(Rect bin, std::span<const BinFragment> fragments);

  void flush();

 private:
  Frame& frame_;
  Worker& worker_;
  Region& region_;
  const Piece* pieces_ = nullptr;
  std::size_t chunk_;
  std::size_t count_ = 0;
  bool first_pass_;
  bool to_cover_ = false;
};

/// Memory that a row keeps between frames.
struct FrameScratch {
  explicit FrameScratch(MemoryAccount& m) : memory(m) {}

  MemoryAccount& memory;
  parallel::ScratchPool<Worker> workers{[this] { return Worker(memory); }};
  std::unique_ptr<Region> shared;
};

/// A frame that a row of the family draws.
class Frame {
 public:
  Frame(raster::FrameRun& frame, const Tuning& t, bool hierarchical_z, const Visibility& v,
        FrameScratch& s)
      : base(frame),
        request(frame.request),
        geometry(frame.geometry),
        kernel(frame.kernel),
        exec(*frame.threads),
        stats(frame.stats),
        watch(frame.watch),
        tuning(t),
        hides(hierarchical_z && frame.plan.hides),
        visibility(v),
        scratch(s),
        view(frame.view),
        surface(frame.surface),
        expansion_bytes(frame.expansion_bytes) {}

  raster::FrameRun& base;
  const FrameRequest& request;
  const FrameGeometry& geometry;
  const Kernels& kernel;
  parallel::Threads& exec;
  FrameStats& stats;
  Stopwatch& watch;
  const Tuning& tuning;
  /// Whether owned regions keep bounds of what they hide. False where overdraw is counted, since
  /// hidden fragments count too.
  const bool hides;
  const Visibility& visibility;
  FrameScratch& scratch;
  const Rect view;            ///< the image, or the part of it that is drawn
  const SurfaceView surface;  ///< of the view; if it has no keys, each tile keeps its own
  const std::uint64_t expansion_bytes;

  [[nodiscard]] bool has_surface() const { return base.has_surface(); }
  [[nodiscard]] RegionContext shared_context() const {
    return {{&request, &base.plan, &geometry, &kernel, base.fragment_bytes, nullptr}, &exec, false};
  }
  /// For a region that the calling thread owns. All such regions share one budget.
  [[nodiscard]] RegionContext owned_context() const { return {base.context(), nullptr, hides}; }
  void count(std::string_view name, std::uint64_t value) { base.count(name, value); }
};

/// Enumerates into the region that all threads share, the whole view, as often as the visibility
/// asks. `enumerate(chunk, emitter)` is called concurrently for chunks [0, chunks) and must do the
/// same each time.
///
/// `first_pass(visit)` runs the first pass over all chunks in any order. It calls visit(chunk,
/// part), from any thread. The calls part(emitter) of a chunk, in order, do together what
/// enumerate(chunk, emitter) does later.
template <class FirstPass, class Enumerate>
void draw_shared(Frame& frame, std::size_t chunks, const FirstPass& first_pass,
                 const Enumerate& enumerate) {
  FrameScratch& scratch = frame.scratch;
  if (!scratch.shared) scratch.shared = frame.visibility.make(Sharing::shared, scratch.memory);
  Region& region = *scratch.shared;
  region.begin(frame.shared_context(), frame.surface, frame.view, chunks);
  const auto visit_in = [&](bool first, std::size_t chunk, const auto& part) {
    Emitter emitter(frame, scratch.workers.local(), region, chunk, first);
    part(emitter);
    emitter.flush();
  };
  if (region.next())
    first_pass([&](std::size_t chunk, const auto& part) { visit_in(true, chunk, part); });
  while (const auto pass = region.next())
    parallel::for_each_index(frame.exec, pass->last - pass->first, [&](std::size_t i) {
      const std::size_t chunk = pass->first + i;
      visit_in(false, chunk, [&](Emitter& emitter) { enumerate(chunk, emitter); });
    });
  region.collect(frame.base.counters);
}

/// The same with a first pass like the others.
template <class Enumerate>
void draw_shared(Frame& frame, std::size_t chunks, const Enumerate& enumerate) {
  draw_shared(
      frame, chunks,
      [&](const auto& visit) {
        parallel::for_each_index(frame.exec, chunks, [&](std::size_t chunk) {
          visit(chunk, [&](Emitter& emitter) { enumerate(chunk, emitter); });
        });
      },
      enumerate);
}

/// Draws a tile (whole blocks, at most `tile_px` across) that the calling thread owns.
/// `enumerate(emitter)` must do the same each time. The tile is shaded at once unless the frame has
/// a surface.
template <class Enumerate>
void draw_tile(Frame& frame, Rect rect, int tile_px, bool is_empty, const Enumerate& enumerate) {
  FrameScratch& scratch = frame.scratch;
  const bool local = !frame.has_surface();
  if (is_empty) {
    if (local) frame.base.shade_nothing(rect);
    return;
  }
  Worker& worker = scratch.workers.local();
  if (!worker.region) worker.region = frame.visibility.make(Sharing::owned, scratch.memory);
  Region& region = *worker.region;
  const SurfaceView surface =
      local ? worker.tile.begin(frame.request, rect, tile_px, frame.visibility.shades)
            : frame.surface.part(rect.x0 / kBlockSize, rect.y0 / kBlockSize);
  region.begin(frame.owned_context(), surface, rect, 1);
  bool first_pass = true;
  while (region.next()) {
    Emitter emitter(frame, worker, region, 0, first_pass);
    enumerate(emitter);
    emitter.flush();
    first_pass = false;
  }
  if (local) frame.base.shade(surface, rect);
}

/// Adds the counters of the tiles that were drawn.
inline void collect_tiles(Frame& frame) {
  frame.scratch.workers.for_each([&](Worker& worker) {
    if (worker.region) worker.region->collect(frame.base.counters);
  });
}

/// Draws the tiles of `grid`; a thread owns each tile that it draws. `is_empty(tile)` is true if
/// nothing would be enumerated; `enumerate(tile, emitter)` must do the same each time.
template <class IsEmpty, class Enumerate>
void draw_tiles(Frame& frame, const TileGrid& grid, const IsEmpty& is_empty,
                const Enumerate& enumerate) {
  parallel::for_each_index(frame.exec, grid.count(), [&](std::size_t position) {
    const std::size_t tile = tile_at(frame.tuning.order, position, grid);
    draw_tile(frame, grid.rect(tile), grid.tile_px, is_empty(tile),
              [&](Emitter& emitter) { enumerate(tile, emitter); });
  });
  collect_tiles(frame);
}

}  // namespace rastrum::family
