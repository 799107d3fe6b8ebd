// Several samples a pixel of opaque surfaces: the fast path (fast_path.hpp) for each sample, since
// what a sample sees is what the pixels' centres see of moved triangles (draws/samples.hpp). Every
// sample has its own lists of pieces and its own keys of a bin, which stay in the thread's cache;
// a pixel's colour is found from them at once (resolve/sampled_colors.hpp).
#pragma once

#include <memory>

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/frame/method.hpp>

namespace rastrum::raster {

/// Whether the frame is for make_sampled_path: several samples of triangles, points and lines that
/// are not drawn over a picture. That nothing blends is for the caller to know.
[[nodiscard]] bool is_sampled(const FrameRequest& request);

/// Work O(samples · (triangles + (bin, piece) pairs + blocks)); memory that of the fast path times
/// the samples. All triangles of a view are kept at once.
[[nodiscard]] std::unique_ptr<Method> make_sampled_path(MemoryAccount& memory);

}  // namespace rastrum::raster
