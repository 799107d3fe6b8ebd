// A frame under way: the pipeline that every rasterizer shares (project, batches and bands under a
// memory limit, shading) and the two places where the axes meet: draw_shared and draw_tiles.
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

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/parallel/scratch.hpp>
#include <rastrum/raster/bin/tile_grid.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/frame/request.hpp>
#include <rastrum/raster/frame/stopwatch.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/resolve/resolve.hpp>
#include <rastrum/raster/resolve/surface.hpp>
#include <rastrum/raster/visibility/region.hpp>

namespace rastrum::raster {

/// Blocks that are handed to a region at once.
inline constexpr std::size_t kBlockCapacity = 512;

/// What a thread needs for a tile or a chunk. Kept between frames.
struct Worker {
  explicit Worker(MemoryAccount& memory) : keys(memory), colors(memory) {}

  alignas(64) Block blocks[kBlockCapacity];
  ShaderScratch shader;
  std::uint64_t shader_of = 0;  ///< number of the frame for which it was zeroed
  Buffer<std::uint64_t> keys;   ///< of a tile
  Buffer<BlockColors> colors;   ///< of a tile, where visibility shades
  std::unique_ptr<Region> region;
};

class Frame;

/// Collects the blocks of a chunk and hands them to a region: overdraw is counted and the fragment
/// test is applied here, in every pass.
class Emitter {
 public:
  Emitter(Frame& frame, Worker& worker, Region& region, std::size_t chunk, bool first_pass)
      : frame_(frame), worker_(worker), region_(region), chunk_(chunk), first_pass_(first_pass) {}
  Emitter(const Emitter&) = delete;
  Emitter& operator=(const Emitter&) = delete;

  /// The pieces that the blocks which follow refer to.
  void use(const Piece* pieces) {
    if (pieces == pieces_) return;
    flush();
    pieces_ = pieces;
  }
  /// A block with the samples that it covers; an empty mask is left out.
  void add(const Block& block) {
    worker_.blocks[count_] = block;
    count_ += block.mask != 0;
    if (count_ == kBlockCapacity) flush();
  }
  /// A block that touches the view and whose samples are still to be found, many at once.
  void add_uncovered(std::uint32_t piece, int bx, int by) {
    worker_.blocks[count_++] = {piece, static_cast<std::uint16_t>(bx),
                                static_cast<std::uint16_t>(by), 0};
    to_cover_ = true;
    if (count_ == kBlockCapacity) flush();
  }
  /// Room for kBlocksPerBin blocks or more, to be written by a kernel: say with `written` how many.
  [[nodiscard]] std::span<Block> room() {
    if (kBlockCapacity - count_ < static_cast<std::size_t>(kBlocksPerBin)) flush();
    return {worker_.blocks + count_, kBlockCapacity - count_};
  }
  void written(std::size_t n) { count_ += n; }
  /// What the tile hides by now; null where everything is to be enumerated.
  [[nodiscard]] DepthBounds* bounds() { return region_.bounds(); }
  /// Lets it know all that has been drawn so far.
  void find_bounds() {
    flush();
    region_.find_bounds();
  }
  /// Whether the chunk is enumerated for the first time.
  [[nodiscard]] bool first_pass() const { return first_pass_; }
  /// Fragments of micro triangles, whose keys are known (Visibility::takes_fragments).
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

/// What a rasterizer keeps between frames.
struct FrameScratch {
  FrameScratch(MemoryAccount& m, parallel::Threads& e) : memory(m), exec(e) {}

  MemoryAccount& memory;
  parallel::Threads& exec;
  parallel::ScratchPool<Worker> workers{[this] { return Worker(memory); }};
  std::unique_ptr<Region> shared;
  std::uint64_t frames = 0;  ///< drawn or under way
};

class Frame {
 public:
  Frame(FrameRequest& r, const FrameGeometry& g, const Visibility& v, FrameScratch& s,
        FrameStats& st, Stopwatch& w)
      : request(r),
        geometry(g),
        kernel(kernels(r.isa)),
        visibility(v),
        scratch(s),
        exec(s.exec),
        stats(st),
        watch(w),
        number(++s.frames) {}

  FrameRequest& request;
  FrameGeometry geometry;
  const Kernels& kernel;
  const Visibility& visibility;
  FrameScratch& scratch;
  parallel::Threads& exec;
  FrameStats& stats;
  Stopwatch& watch;
  const std::uint64_t number;  ///< tells the frames of a rasterizer apart

  Rect view;               ///< what is being drawn: the image or a band of it
  bool first_band = true;  ///< triangles are counted once
  /// Of the view. Without keys tiles keep their own and are shaded at once.
  SurfaceView surface;
  std::uint64_t fragment_bytes = 0;  ///< see RegionContext
  /// Most that a coverage may expand triangles to (rows, bins, pairs) at once; 0: no limit.
  std::uint64_t expansion_bytes = 0;
  /// Most that the pieces of a view, and what they are expanded to, may take at once where all have
  /// to be there (Visibility::keeps_layers); 0: no limit.
  std::uint64_t view_bytes = 0;
  bool fits = true;  ///< else the view was not drawn

  std::atomic<std::uint64_t> fragments = 0, pixels_covered = 0;
  Counters counters;

  [[nodiscard]] bool has_surface() const { return surface.keys != nullptr; }
  /// `threads`: null for a region that one thread owns; all of those share the budget.
  [[nodiscard]] RegionContext context(parallel::Threads* threads) const {
    const auto owners = threads != nullptr ? 1 : static_cast<std::uint64_t>(exec.concurrency());
    return {&request, &geometry, &kernel, threads, fragment_bytes / owners, nullptr};
  }
  void count(std::string_view name, std::uint64_t value) { add_counter(counters, name, value); }

  /// What the shader keeps in this frame, zeroed when the worker first asks.
  [[nodiscard]] void* shader_scratch(Worker& worker) const;
  /// Shades and stores the blocks of `rect`. Thread-safe for distinct rectangles.
  void shade(const SurfaceView& from, Rect rect, Worker& worker);
  /// The same for a rectangle without any surface.
  void shade_nothing(Rect rect);
};

/// Enumerates into the region that all threads share, the view, as often as the visibility asks.
/// `enumerate(chunk, emitter)` is called concurrently for chunks [0, chunks) and does the same each
/// time.
///
/// `first_pass(visit)` runs the first pass, which is over all chunks, in an order of its own: it
/// calls visit(chunk, part), from any thread, until the parts of each chunk in order,
/// part(emitter), have done what enumerate(chunk, emitter) will do.
template <class FirstPass, class Enumerate>
void draw_shared(Frame& frame, std::size_t chunks, const FirstPass& first_pass,
                 const Enumerate& enumerate) {
  FrameScratch& scratch = frame.scratch;
  if (!scratch.shared) scratch.shared = frame.visibility.make(Sharing::shared, scratch.memory);
  Region& region = *scratch.shared;
  region.begin(frame.context(&frame.exec), frame.surface, frame.view, chunks);
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
  region.collect(frame.counters);
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
/// `enumerate(emitter)` as above. It is shaded at once unless the frame has a surface.
template <class Enumerate>
void draw_tile(Frame& frame, Rect rect, int tile_px, bool is_empty, const Enumerate& enumerate) {
  FrameScratch& scratch = frame.scratch;
  const bool local = !frame.has_surface();
  if (is_empty) {
    if (local) frame.shade_nothing(rect);
    return;
  }
  Worker& worker = scratch.workers.local();
  if (!worker.region) worker.region = frame.visibility.make(Sharing::owned, scratch.memory);
  Region& region = *worker.region;
  SurfaceView surface;
  if (local) {
    // Rows of a whole tile, also at the image's edge: kernels like one stride.
    surface = {rect.x0 / kBlockSize, rect.y0 / kBlockSize, (tile_px + kBlockSize - 1) / kBlockSize,
               nullptr, nullptr};
    const std::size_t blocks =
        static_cast<std::size_t>(surface.columns) * static_cast<std::size_t>(block_rows(rect));
    worker.keys.reserve(blocks * 64);
    surface.keys = worker.keys.data();
    load_keys(frame.request.targets, rect, surface);
    if (frame.visibility.shades) {
      worker.colors.reserve(blocks);
      surface.colors = worker.colors.data();
    }
  } else {
    surface = frame.surface.part(rect.x0 / kBlockSize, rect.y0 / kBlockSize);
  }
  RegionContext context = frame.context(nullptr);
  context.shader_scratch = frame.shader_scratch(worker);
  region.begin(context, surface, rect, 1);
  bool first_pass = true;
  while (region.next()) {
    Emitter emitter(frame, worker, region, 0, first_pass);
    enumerate(emitter);
    emitter.flush();
    first_pass = false;
  }
  if (local) frame.shade(surface, rect, worker);
}

/// Adds the counters of the tiles that were drawn.
inline void collect_tiles(Frame& frame) {
  frame.scratch.workers.for_each([&](Worker& worker) {
    if (worker.region) worker.region->collect(frame.counters);
  });
}

/// Lets threads own the tiles of `grid` one by one. `is_empty(tile)` says that nothing would be
/// enumerated; `enumerate(tile, emitter)` as above.
template <class IsEmpty, class Enumerate>
void draw_tiles(Frame& frame, const TileGrid& grid, const IsEmpty& is_empty,
                const Enumerate& enumerate) {
  parallel::for_each_index(frame.exec, grid.count(), [&](std::size_t position) {
    const std::size_t tile = grid.tile_at(position);
    draw_tile(frame, grid.rect(tile), grid.tile_px, is_empty(tile),
              [&](Emitter& emitter) { enumerate(tile, emitter); });
  });
  collect_tiles(frame);
}

}  // namespace rastrum::raster
