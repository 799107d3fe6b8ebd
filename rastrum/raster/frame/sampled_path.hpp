// SPDX-License-Identifier: BSD-3-Clause
// Several samples a pixel of opaque surfaces: the fast path (fast_path.hpp) with keys for each
// sample of a bin, side by side in the thread's cache. A triangle is set up, binned and tested
// against what hides once, and raises the keys of all samples at once (Kernels::raise_samples,
// decision 0063). Other primitives, and fragments that are tested, go sample by sample, moved by
// the sample's offset (rules/samples.hpp). A pixel's colour is found from all its keys
// (resolve/sampled_colors.hpp).
#pragma once

#include <memory>

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/frame/method.hpp>

namespace rastrum::raster {

/// Work O(triangles + (bin, piece) pairs + samples · samples in boxes); memory that of the fast
/// path, and a thread's 34 KB for each sample. All triangles of a view are kept at once.
[[nodiscard]] std::unique_ptr<Method> make_sampled_path(MemoryAccount& memory);

}  // namespace rastrum::raster
