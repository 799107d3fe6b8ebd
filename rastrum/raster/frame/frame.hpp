// A frame under way: what the driver (driver.hpp) has begun and a method draws.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/parallel/scratch.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/frame/counters.hpp>
#include <rastrum/raster/frame/request.hpp>
#include <rastrum/raster/frame/stopwatch.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/resolve/surface.hpp>
#include <rastrum/raster/shade/seen_bin.hpp>

namespace rastrum::raster {

/// Blocks that are collected before they are handed on.
inline constexpr std::size_t kBlockCapacity = 512;

/// The shader's memory that a thread keeps from frame to frame.
struct ShaderOfThread {
  explicit ShaderOfThread(MemoryAccount& memory) : bin(memory) {}

  ShaderScratch scratch;
  ScratchBuffer<SeenBin> bin;  ///< one element, or empty
  std::uint64_t frame = 0;     ///< number of the frame for which it was zeroed
};

/// The parts of a frame for code that draws and blends the blocks of a bin. All outlive its use.
struct BinContext {
  const FrameRequest* request = nullptr;
  const FrameGeometry* frame = nullptr;
  const Kernels* kernel = nullptr;
  std::uint64_t fragment_bytes = 0;  ///< most that fragments may take at once; 0: no limit
  void* shader_scratch = nullptr;    ///< VisibleBlock::scratch
  bool clips = true;                 ///< some triangle of the view may have been clipped
};

class Frame {
 public:
  FrameRequest& request;
  FrameGeometry geometry;
  /// The memory that `geometry` reads, writable: vertices of clusters are projected into it later.
  ProjectedVertex* projected = nullptr;
  const Kernels& kernel;
  parallel::Threads* const threads;  ///< null: the serial reference
  parallel::ScratchPool<ShaderOfThread>& shaders;
  FrameStats& stats;
  Stopwatch& watch;
  const std::uint64_t number;  ///< tells the frames of a driver apart

  Rect view{};             ///< what is being drawn: the image or a part of it
  bool first_band = true;  ///< triangles are counted once
  /// The keys of the view. Without them the method keeps the keys of its tiles and shades them
  /// itself.
  SurfaceView surface{};
  /// The number of bins in a row where keys lie bin after bin, so that a bin is one run of memory;
  /// 0: they do not.
  int bin_columns = 0;
  /// Most that fragments may take at once, over all threads; 0: no limit.
  std::uint64_t fragment_bytes = 0;
  /// Most that triangles may be expanded to (rows, bins, pairs) at once; 0: no limit.
  std::uint64_t expansion_bytes = 0;
  /// Most that the pieces of a view, and what they are expanded to, may take at once where all have
  /// to be there (Needs::whole_view); 0: no limit.
  std::uint64_t view_bytes = 0;
  bool fits = true;   ///< else the view was not drawn
  bool clips = true;  ///< some triangle of the view may have been clipped

  std::atomic<std::uint64_t> fragments = 0, pixels_covered = 0;
  Counters counters{};

  /// Whether there is a limit on the pieces of a view or on what triangles are expanded to.
  [[nodiscard]] bool plans_memory() const { return view_bytes != 0 || expansion_bytes != 0; }
  [[nodiscard]] bool has_surface() const { return surface.keys != nullptr; }
  /// The part of the surface that begins with `rect`. Where keys lie bin after bin it ends with the
  /// bin.
  [[nodiscard]] SurfaceView surface_at(Rect rect) const {
    const int bx = rect.x0 / kBlockSize, by = rect.y0 / kBlockSize;
    if (bin_columns == 0) return surface.part(bx, by);
    const int bin = (rect.y0 - view.y0) / kBinSize * bin_columns + (rect.x0 - view.x0) / kBinSize;
    const SurfaceView whole{bx / kBlocksPerBinRow * kBlocksPerBinRow,
                            by / kBlocksPerBinRow * kBlocksPerBinRow, kBlocksPerBinRow,
                            surface.keys + static_cast<std::size_t>(bin) * kBlocksPerBin * 64,
                            nullptr};
    return whole.part(bx, by);
  }
  [[nodiscard]] int concurrency() const { return threads == nullptr ? 1 : threads->concurrency(); }
  /// f(i) for i in [0, n), by all threads.
  template <class F>
  void for_each_index(std::size_t n, F&& f) const {
    if (threads != nullptr) return parallel::for_each_index(*threads, n, f);
    for (std::size_t i = 0; i < n; ++i) f(i);
  }
  /// The same, begun in increasing order: the largest first.
  template <class F>
  void for_each_in_order(std::size_t n, F&& f) const {
    if (threads != nullptr) return parallel::for_each_in_order(*threads, n, f);
    for (std::size_t i = 0; i < n; ++i) f(i);
  }
  /// The context of a bin that the calling thread owns; all threads share the budget.
  [[nodiscard]] BinContext context() const {
    return {&request,         &geometry,
            &kernel,          fragment_bytes / static_cast<std::uint64_t>(concurrency()),
            shader_scratch(), clips};
  }
  void count(std::string_view name, std::uint64_t value) { add_counter(counters, name, value); }

  /// Projects all vertices of a draw to their places (Draw::first_vertex).
  void project(Draw& draw) const;

  /// The shader's memory in this frame for the calling thread, zeroed when the thread first asks.
  [[nodiscard]] void* shader_scratch() const;
  /// Shades and stores the blocks of `rect`. Thread-safe for distinct rectangles.
  void shade(const SurfaceView& from, Rect rect);
  /// The same for a rectangle without any surface.
  void shade_nothing(Rect rect);
  /// Hands the opaque surfaces of a block to the sink. Returns which pixels have one.
  std::uint64_t hand_on(const std::uint64_t* keys, int bx, int by) const;

  /// Finds the masks of blocks that have none yet (0), as far as they lie in the view. Returns
  /// those that cover something.
  [[nodiscard]] std::span<Block> cover(const Piece* pieces, std::span<Block> blocks) const;
  /// Counts fragments and overdraw.
  void count_fragments(std::span<const Block> blocks);
  void count_fragments(Rect bin, std::span<const BinFragment> fragments);
  /// Applies the fragment test and returns the blocks in which it leaves something. `seen`: the
  /// maximum of keys so far, so that hidden fragments are dropped untested; null: not known. With
  /// several samples nothing is tested here: a triangle is tested once a pixel, where samples are
  /// resolved.
  [[nodiscard]] std::span<Block> test(const Piece* pieces, std::span<Block> blocks,
                                      const SurfaceView* seen) const;

 private:
  /// The place where the triangles of `bin` are set up before its blocks are shaded; null: they are
  /// not.
  [[nodiscard]] SeenBin* seen_bin(const BinSurface& bin) const;
};

}  // namespace rastrum::raster
