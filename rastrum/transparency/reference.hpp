// The reference of layers: every fragment of every pixel in a list, sorted, shaded one by one.
// Written for plainness; the layers row must equal it.
#pragma once

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/frame/request.hpp>

namespace rastrum::transparency {

/// One frame on one thread, with transparency and several samples a pixel.
/// Memory: 40 bytes a fragment and sample. Throws Error{invalid_argument} where an index is out of
/// range, and for Transparency::filter, whose errors are those of blocks, which it does not have.
[[nodiscard]] FrameStats render_reference(raster::FrameRequest& request, MemoryAccount& memory);

}  // namespace rastrum::transparency
