// SPDX-License-Identifier: BSD-3-Clause
// The estimated cost of a frame of triangles, for Device::automatic (parallel/device_estimate.hpp).
#pragma once

#include <rastrum/parallel/device_estimate.hpp>
#include <rastrum/raster/context/request.hpp>

namespace rastrum {

/// Estimates from primitives, pixels, arrays to copy and targets to fetch. Layers count as one
/// surface, because covered samples are not known beforehand.
[[nodiscard]] FrameWork device_work(const raster::FrameRequest& request);

}  // namespace rastrum
