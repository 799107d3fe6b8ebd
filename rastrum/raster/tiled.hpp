// The tiled rasterizer (paper 1, section 3.3; sort-middle after Molnar et al., 1994): triangles are
// set up once, (bin, piece) pairs are sorted by bin, and a thread that owns a bin resolves and
// shades it while its words are in cache.
//
// Deviations from the paper. The sort is a counting sort inside each group of triangles, and a bin
// walks the groups: no global sort, no barrier beyond one. Bins are 64² px of 8² blocks with 64-bit
// masks. Shading happens in the bin, as the paper suggests but does not do.
#pragma once

#include <memory>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/geometry.hpp>

namespace rastrum::raster {

/// Keeps its scratch between frames. One frame at a time.
class TiledRasterizer {
 public:
  explicit TiledRasterizer(MemoryAccount& memory);
  ~TiledRasterizer();

  /// One frame. Work O(vertices + triangles + (bin, piece) pairs + blocks); memory 16 bytes a
  /// vertex, 48 a drawn triangle and 4 a pair. Throws Error{invalid_argument} where an index is out
  /// of range.
  [[nodiscard]] FrameStats render(FrameRequest& request, parallel::Threads& exec);

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace rastrum::raster
