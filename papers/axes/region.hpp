// SPDX-License-Identifier: BSD-3-Clause
// The second axis of the family (papers/README.md): how the many fragments of a pixel become
// one. A visibility method resolves what a coverage enumerates: 8 × 8 blocks of pieces with their
// masks, a few hundred a call. It sees a region of the screen, which one thread owns (a tile: plain
// maxima, keys that stay in cache) or all share (a frame: atomics and locks).
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

/// Resolves the fragments of a rectangle into a surface. Used from `begin` to the `next` that
/// returns nothing, again and again; keeps its scratch.
///
/// The caller enumerates the same blocks, cut into the same chunks, as often as `next` asks for
/// it, and calls `blocks` with each chunk's blocks in order, different chunks from different
/// threads where the region is shared.
class Region {
 public:
  virtual ~Region() = default;

  /// `surface` holds what was drawn before and is raised: keys, and colours if the method shades.
  virtual void begin(const RegionContext& context, const SurfaceView& surface, Rect rect,
                     std::size_t chunks) = 0;

  /// Chunks [first, last) that the method wants to see now. The first pass is over all of them.
  struct Pass {
    std::size_t first = 0, last = 0;
  };
  /// Ends a pass and says what the next one is; nothing: the surface is resolved.
  virtual std::optional<Pass> next() = 0;

  /// No mask is empty and none reaches outside of the image.
  virtual void blocks(std::size_t chunk, const Piece* pieces, std::span<const Block> blocks) = 0;

  /// Bounds of what the bin of an owned region hides, for coverages that ask before they enumerate;
  /// null where the method does not know them.
  virtual DepthBounds* bounds() { return nullptr; }
  /// Updates bounds(). Costs a look at all keys, so it pays where much may be hidden.
  virtual void find_bounds() {}

  /// Fragments whose key is known already, of a bin that the region is; only for methods that
  /// `takes_fragments`.
  virtual void fragments(std::span<const BinFragment>) {}

  /// Adds the work of all frames since the last call to `counters`.
  virtual void collect(Counters&) {}
};

enum class Sharing : std::uint8_t {
  owned,  ///< one thread at a time
  shared  ///< `blocks` is called by many threads at once
};

/// A row of the table: a method of visibility.
struct Visibility {
  std::string_view name, description;
  bool shades = false;           ///< fills SurfaceView::colors
  bool takes_fragments = false;  ///< can be handed finished keys of micro triangles
  /// Bytes of surface a pixel: keys, and what the method keeps beside them for a shared region; 0
  /// where only tiles have surfaces.
  int surface_bytes = 8;
  std::unique_ptr<Region> (*make)(Sharing, MemoryAccount&) = nullptr;
  /// Needs every fragment of a tile at once, from a coverage whose threads own tiles: triangles
  /// cannot be drawn in batches or turns.
  bool whole_view = false;
  bool hides = false;  ///< owned regions have bounds(), and pieces may come in any order
};

/// All methods; the first is the default.
[[nodiscard]] std::span<const Visibility> visibilities() noexcept;

}  // namespace rastrum::family
