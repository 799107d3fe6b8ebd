// SPDX-License-Identifier: BSD-3-Clause
// Several samples a pixel of opaque surfaces: the fast path (fast_path.hpp) with keys for each
// sample of a bin, side by side in the thread's cache. A triangle is set up, binned and tested
// against what hides once, and raises the keys of all samples at once (Kernels::raise_samples,
// decision 0063). Other primitives and tested fragments go sample by sample (rules/samples.hpp). A
// pixel's colour comes from all its keys (resolve/sampled_colors.hpp).
#pragma once

#include <memory>

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/frame/method.hpp>

namespace rastrum::raster {

/// Work O(triangles + (bin, piece) pairs + samples · samples in boxes). Memory: the fast path's,
/// and 34 KB a sample for each thread. Keeps all triangles of a view at once.
[[nodiscard]] std::unique_ptr<Method> make_sampled_path(MemoryAccount& memory);

}  // namespace rastrum::raster
