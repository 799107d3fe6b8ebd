// SPDX-License-Identifier: BSD-3-Clause
// The keys and colours of a thread's tile. They stay in its cache from the first piece to the last
// pixel.
#pragma once

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/resolve/resolve.hpp>

namespace rastrum::raster {

class TileSurface {
 public:
  explicit TileSurface(MemoryAccount& memory) : keys_(memory), colors_(memory) {}

  /// A surface for `rect`, of whole blocks and at most `tile_px` across. It begins with what
  /// earlier passes left (load_keys) and is valid until the next call.
  [[nodiscard]] SurfaceView begin(const FrameRequest& request, Rect rect, int tile_px,
                                  bool colors) {
    // Rows of a whole tile, also at the image's edge: kernels are faster with one stride.
    SurfaceView surface{rect.x0 / kBlockSize, rect.y0 / kBlockSize,
                        (tile_px + kBlockSize - 1) / kBlockSize, nullptr, nullptr};
    const std::size_t blocks =
        static_cast<std::size_t>(surface.columns) * static_cast<std::size_t>(block_rows(rect));
    keys_.reserve(blocks * 64);
    surface.keys = keys_.data();
    load_keys(request, rect, surface);
    if (colors) {
      colors_.reserve(blocks);
      surface.colors = colors_.data();
    }
    return surface;
  }

 private:
  ScratchBuffer<std::uint64_t> keys_;
  ScratchBuffer<BlockColors> colors_;
};

}  // namespace rastrum::raster
