// SPDX-License-Identifier: BSD-3-Clause
// A frame in progress: what the driver (driver.hpp) has begun and a method draws.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/scratch.hpp>
#include <rastrum/raster/context/frame_context.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/rules/surface_view.hpp>
#include <rastrum/raster/surface/seen_bin.hpp>

namespace rastrum::raster {

inline constexpr std::size_t kBlockCapacity = 512;

/// A thread's shader memory, kept from frame to frame.
struct ShaderOfThread {
  explicit ShaderOfThread(MemoryAccount& memory) : bin(memory) {}

  ShaderScratch scratch;
  ScratchBuffer<SeenBin> bin;  ///< one element, or empty
  std::uint64_t frame = 0;     ///< the frame for which it was zeroed
};

class FrameRun : public FrameContext {
 public:
  parallel::ScratchPool<ShaderOfThread>& shaders;
  const std::uint64_t number;  ///< distinct for each frame of a driver

  /// The keys of the view. Without them the method keeps and shades the keys of its tiles.
  SurfaceView surface{};
  /// Bins in a row where keys lie bin after bin, so that a bin is contiguous; 0: they do not.
  int bin_columns = 0;
  bool fits = true;  ///< else the view was not drawn

  std::atomic<std::uint64_t> fragments = 0, pixels_covered = 0;

  FrameRun(FrameContext context, parallel::ScratchPool<ShaderOfThread>& shaders_of_threads,
           std::uint64_t frame_number)
      : FrameContext(std::move(context)), shaders(shaders_of_threads), number(frame_number) {}

  [[nodiscard]] bool has_surface() const { return surface.keys != nullptr; }
  /// The part of the surface that starts with `rect`. Where keys lie bin after bin it ends with the
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
  /// The context of the calling thread's bin. All threads share the budget.
  [[nodiscard]] BinContext context() const {
    const std::uint64_t share = fragment_bytes / static_cast<std::uint64_t>(concurrency());
    return {&request, &plan, &geometry, &kernel, share, shader_scratch(), clips};
  }

  /// The calling thread's shader memory, zeroed at its first call in a frame.
  [[nodiscard]] void* shader_scratch() const;
  /// Shades and stores the blocks of `rect`. Thread-safe for distinct rectangles.
  void shade(const SurfaceView& from, Rect rect);
  void shade_nothing(Rect rect);
  /// Hands a block's opaque surfaces to the sink. Returns which pixels have one.
  std::uint64_t hand_on(const std::uint64_t* keys, int bx, int by) const;

  /// Finds missing masks (0) of blocks, cut to the view. Returns the blocks that cover something.
  [[nodiscard]] std::span<Block> cover(const Piece* pieces, std::span<Block> blocks) const;
  void count_fragments(std::span<const Block> blocks);
  void count_fragments(Rect bin, std::span<const BinFragment> fragments);
  /// Applies the fragment test and returns the blocks in which it leaves something. `seen`: the
  /// maximum of keys so far, so that hidden fragments are dropped untested; null: unknown. With
  /// several samples nothing is tested here, but once a pixel where samples are resolved.
  [[nodiscard]] std::span<Block> test(const Piece* pieces, std::span<Block> blocks,
                                      const SurfaceView* seen) const;

 private:
  /// Where the triangles of `bin` are set up before its blocks are shaded; null: they are not.
  [[nodiscard]] SeenBin* seen_bin(const BinSurface& bin) const;
};

}  // namespace rastrum::raster
