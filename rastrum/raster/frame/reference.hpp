// The reference rasterizer: every triangle in order, every row by its exact interval, the maximum
// of the keys in a full-frame visibility buffer. Written for plainness; the others must equal it.
#pragma once

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/frame/request.hpp>

namespace rastrum::raster {

/// One frame on one thread. Throws Error{invalid_argument} where an index is out of range.
[[nodiscard]] FrameStats render_reference(FrameRequest& request, MemoryAccount& memory);

}  // namespace rastrum::raster
