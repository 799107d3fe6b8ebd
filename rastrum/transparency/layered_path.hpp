// SPDX-License-Identifier: BSD-3-Clause
// The fast path for translucent surfaces or several samples per pixel (called `grouped` and
// `layers`): bins as in raster/frame/bins.hpp, in which every fragment is kept and blended in
// order.
#pragma once

#include <memory>

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/frame/method.hpp>

namespace rastrum::transparency {

/// Work O(triangles + fragments · log layers); memory as the opaque path and LayeredBin.
[[nodiscard]] std::unique_ptr<raster::Method> make_layered_path(MemoryAccount& memory);

}  // namespace rastrum::transparency
