// SPDX-License-Identifier: BSD-3-Clause
// The reference of layers: every fragment of every pixel in a list, sorted, shaded one by one.
#pragma once

#include <memory>

#include <rastrum/raster/frame/method.hpp>

namespace rastrum::transparency {

/// One thread. Memory: 40 bytes per fragment and sample. Frames throw Error{invalid_argument} for
/// AddedTransparency::filter, whose errors depend on blocks.
[[nodiscard]] std::unique_ptr<raster::Method> make_layered_reference();

}  // namespace rastrum::transparency
