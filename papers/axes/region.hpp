// SPDX-License-Identifier: BSD-3-Clause
// The second axis of the family (papers/README.md): a visibility method resolves the many fragments
// of a pixel to one. A coverage hands it 8 × 8 blocks of pieces with their masks, a few hundred a
// call. It sees a region of the screen. One thread owns a tile (plain maxima, keys that stay in
// cache); all threads share a frame (atomics and locks).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <papers/axes/names.hpp>
#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/frame/frame_run.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/rules/surface_view.hpp>

namespace rastrum::family {

/// The parts of the frame that a method may use. All of them outlive the region's use.
struct RegionContext : BinContext {
  parallel::Threads* exec = nullptr;  ///< null where one thread owns the region
  bool hides = true;                  ///< owned regions keep bounds()
};

/// Resolves the fragments of a rectangle into a surface. A use runs from `begin` to the `next` that
/// returns nothing. The region keeps its scratch between uses.
///
/// The caller enumerates the same blocks in the same chunks each time `next` asks for a pass. It
/// calls `blocks` with each chunk's blocks in order. For a shared region, different threads call it
/// with different chunks.
class Region {
 public:
  virtual ~Region() = default;

  /// `surface` holds what was drawn before: keys, and colours if the method shades. The region
  /// raises them.
  virtual void begin(const RegionContext& context, const SurfaceView& surface, Rect rect,
                     std::size_t chunks) = 0;

  /// Chunks [first, last) that the method wants to see. The first pass is over all of them.
  struct Pass {
    std::size_t first = 0, last = 0;
  };
  /// Ends a pass and returns the next one; nothing once the surface is resolved.
  virtual std::optional<Pass> next() = 0;

  /// No mask is empty, and none reaches outside of the image.
  virtual void blocks(std::size_t chunk, const Piece* pieces, std::span<const Block> blocks) = 0;

  /// Bounds of what the bin of an owned region hides, for coverages that test before they
  /// enumerate; null if the method does not know them.
  virtual DepthBounds* bounds() { return nullptr; }
  /// Updates bounds(). Reads all keys, so it pays only where much may be hidden.
  virtual void find_bounds() {}

  /// Takes fragments with known keys, of the bin that the region is. Only for methods with
  /// `takes_fragments`.
  virtual void fragments(std::span<const BinFragment>) {}

  /// Adds the work of all frames since the last call to `counters`.
  virtual void collect(Counters&) {}
};

enum class Sharing : std::uint8_t {
  owned,  ///< one thread at a time
  shared  ///< `blocks` is called by many threads at once
};

/// A row of the table: a visibility method.
struct Visibility {
  std::string_view name, description;
  bool shades = false;           ///< fills SurfaceView::colors
  bool takes_fragments = false;  ///< takes finished keys of micro triangles
  /// Bytes of surface per pixel: keys, and what the method keeps beside them for a shared region. 0
  /// if only tiles have surfaces.
  int surface_bytes = 8;
  std::unique_ptr<Region> (*make)(Sharing, MemoryAccount&) = nullptr;
  /// Needs all fragments of a tile at once, from a coverage whose threads own tiles. Triangles
  /// cannot be drawn in batches or turns.
  bool whole_view = false;
  bool hides = false;  ///< owned regions have bounds(), and pieces may come in any order
};

/// All methods; the first is the default.
[[nodiscard]] std::span<const Visibility> visibilities() noexcept;

}  // namespace rastrum::family
