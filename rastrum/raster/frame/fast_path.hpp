// SPDX-License-Identifier: BSD-3-Clause
// The one fast path of opaque surfaces (called `grouped` and `atomic`, after the axes of the
// family's table). Groups of triangles are set up and sorted into bins (bin/groups.hpp). A thread
// owns a bin, raises its keys, leaves out what is hidden, and shades in cache (bins.hpp).
#pragma once

#include <memory>

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/frame/method.hpp>

namespace rastrum::raster {

/// Work O(triangles + (bin, piece) pairs + blocks); memory 48 bytes a drawn triangle, 8 a pair, 16
/// a fragment of a micro triangle. Counters: "bins" (pairs), "micro fragments", "hidden pieces",
/// "hidden blocks".
[[nodiscard]] std::unique_ptr<Method> make_fast_path(MemoryAccount& memory);

}  // namespace rastrum::raster
