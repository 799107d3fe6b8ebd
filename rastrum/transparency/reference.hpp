// SPDX-License-Identifier: BSD-3-Clause
// The reference of layers: every fragment of every pixel in a list, sorted, shaded one by one.
// Written for plainness; the layered path must equal it.
#pragma once

#include <memory>

#include <rastrum/raster/frame/method.hpp>

namespace rastrum::transparency {

/// Transparency and several samples a pixel on one thread. Memory: 40 bytes a fragment and sample.
/// Frames throw Error{invalid_argument} for AddedTransparency::filter, whose errors are those of
/// blocks, which it does not have.
[[nodiscard]] std::unique_ptr<raster::Method> make_layered_reference();

}  // namespace rastrum::transparency
