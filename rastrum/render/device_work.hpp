// SPDX-License-Identifier: BSD-3-Clause
// The estimated cost of a frame of triangles, for Device::automatic (parallel/device_estimate.hpp).
#pragma once

#include <rastrum/parallel/device_estimate.hpp>
#include <rastrum/raster/context/request.hpp>

namespace rastrum {

/// Estimates from primitives, pixels, the arrays that go over and the targets that come back. How
/// many samples primitives cover is not known before: layers count as one surface.
[[nodiscard]] FrameWork device_work(const raster::FrameRequest& request);

}  // namespace rastrum
